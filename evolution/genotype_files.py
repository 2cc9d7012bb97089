"""Files of genotypes that anyone may have written: read with care, or refused."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

# Far above any file of genotypes; keeps a mistaken or malicious file from filling the memory.
LARGEST_FILE: Final = 64 * 2**20


def read_genotype_file(path: Path) -> Mapping[str, NDArray]:
    """The named arrays of an .npz, or the only one of an .npy as "genotypes"; not yet held against anything.

    Raises:
        ValueError: If it is neither, or too large.
        OSError: If it cannot be read.
    """
    refusal = f"{path} is not a genotype file: give an .npz with an array genotypes [P, 84], or an .npy"
    if path.stat().st_size > LARGEST_FILE:
        raise ValueError(f"{refusal}; this file is larger than {LARGEST_FILE // 2**20} MB")
    data = io.BytesIO(path.read_bytes())
    try:
        if zipfile.is_zipfile(data):
            return _read_archive(data)
        data.seek(0)
        return {"genotypes": np.lib.format.read_array(data, allow_pickle=False)}
    except Exception as error:  # whatever a broken or foreign file brings about in the readers
        raise ValueError(f"{refusal} ({error})") from None


def _read_archive(data: io.BytesIO) -> dict[str, NDArray]:
    """The arrays of an .npz that does not swell when unpacked."""
    with zipfile.ZipFile(data) as archive:
        if sum(each.file_size for each in archive.infolist()) > LARGEST_FILE:
            raise ValueError(f"its content is larger than {LARGEST_FILE // 2**20} MB")
    data.seek(0)
    with np.load(data, allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}
