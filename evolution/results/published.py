"""What the paper prints, in numbers (section VII; spec section 10)."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

import numpy as np

from arm2d import Condition

AGENTS: Final = 100_000  # of each condition
RUNS: Final = 10  # of each condition
PLATEAU: Final = 2.57  # best fitness at which all runs of both conditions end (Fig. 3)
RUNS_WITH_GENERALISERS: Final = 6  # of ten; With-Indicate

# Table II: agents by category (rows 0 to 10) and sub-task (columns I to IV).
TABLE_II: Final = MappingProxyType(
    {
        Condition.WITH_INDICATE: np.array(
            [
                [9408, 75200, 70787, 90263],
                [1545, 3962, 5840, 3313],
                [578, 1252, 2477, 1092],
                [823, 1314, 2174, 889],
                [1458, 1703, 2016, 939],
                [3558, 2161, 8217, 2430],
                [2483, 2004, 1493, 346],
                [2780, 2061, 922, 197],
                [5020, 1668, 957, 174],
                [12116, 1906, 995, 135],
                [60231, 6769, 4122, 222],
            ]
        ),
        Condition.WITH_IGNORE: np.array(
            [
                [8127, 87238, 92457, 98516],
                [15, 3502, 2439, 643],
                [26, 1220, 1069, 218],
                [102, 989, 1021, 220],
                [275, 890, 928, 160],
                [15733, 3836, 1363, 178],
                [451, 382, 208, 15],
                [822, 215, 145, 6],
                [2049, 231, 141, 10],
                [6107, 302, 121, 8],
                [66293, 1195, 108, 26],
            ]
        ),
    }
)
