"""Seeds as a user names them: 7, "1-8", or a list of both."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any, Final

from evolution.search.config import SEED_LIMIT

MOST_SEEDS: Final = 10_000
RANGE: Final = re.compile(r"\s*(\d{1,19})\s*(?:-\s*(\d{1,19})\s*)?")
EXAMPLES: Final = "7, '1-8' or [1, 2, '5-8']"


def read_seeds(value: Any) -> tuple[int, ...]:
    """The seeds that are meant, in their order.

    Raises:
        ValueError: If there are none, too many, one of them twice, or anything else than numbers and ranges.
    """
    given = value if isinstance(value, list) else [value]
    if not given:
        raise ValueError(f"seeds = [] names none; give {EXAMPLES}")
    seeds: list[int] = []
    for each in given:
        seeds += _range_of(each, value)
        if len(seeds) > MOST_SEEDS:
            raise _too_many(value)
    twice = [seed for seed, times in Counter(seeds).items() if times > 1]
    if twice:
        raise ValueError(f"seeds has {twice[0]} twice; leave one out")
    return tuple(seeds)


def _range_of(each: Any, whole: Any) -> range:
    """The numbers of one entry."""
    if isinstance(each, int) and not isinstance(each, bool):
        first = last = each
    elif isinstance(each, str) and (found := RANGE.fullmatch(each)):
        first, last = int(found[1]), int(found[2] or found[1])
    else:
        raise ValueError(f"seeds = {whole!r} is not understood; give {EXAMPLES}")
    if not 0 <= first <= last < SEED_LIMIT:
        raise ValueError(f"seeds = {whole!r}: {each!r} must rise within 0 to 2**63 - 1; give {EXAMPLES}")
    if last - first >= MOST_SEEDS:
        raise _too_many(whole)
    return range(first, last + 1)


def _too_many(value: Any) -> ValueError:
    return ValueError(f"seeds = {value!r} are too many; an experiment has at most {MOST_SEEDS:,}")
