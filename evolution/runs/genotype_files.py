"""Files of genotypes that anyone may have written: read with care, or refused."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

from numpy.typing import NDArray

from arm2d.files import NoFileError, read_file
from evolution.runs.arrays import LARGEST_CONTENT, UnreadableError, unpack_archive, unpack_array


def read_genotype_file(path: Path) -> Mapping[str, NDArray]:
    """The named arrays of an .npz, or the only one of an .npy as "genotypes"; not yet held against anything.

    Raises:
        ValueError: If it is neither, or too large.
        OSError: If it cannot be read.
    """
    refusal = f"{path} is not a genotype file: give an .npz with an array genotypes [P, 84], or an .npy"
    try:
        data = read_file(path, LARGEST_CONTENT)
        if zipfile.is_zipfile(io.BytesIO(data)):
            return unpack_archive(data)
        return {"genotypes": unpack_array(data)}
    except (NoFileError, UnreadableError) as error:
        raise ValueError(f"{refusal} ({error})") from None
