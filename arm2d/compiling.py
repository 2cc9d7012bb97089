"""How functions of this project are compiled: by Numba, once per machine.

No option that reorders or fuses floating-point operations is used, so compiled code gives the bits
of plain Python (arm2d.arithmetic says why that matters).

Machine code is kept where `arm2d.cache` says. Numba would run whatever lies there: files are therefore
sealed by a checksum, and what is damaged is compiled again. A full disk costs the cache, not the command.
"""

from __future__ import annotations

import pickle
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    IndexDataCacheFile,
    _CacheLocator,
)

from arm2d.cache import SEAL, CacheWarning, cache_folder, sealed, unsealed


def compiled(function: Callable | None = None, *, allocates: bool = True, **options: Any) -> Any:
    """Decorator: compile with Numba in its numpy error model, cached.

    Args:
        function: What is decorated.
        allocates: Whether the function makes arrays. One that only works on arrays it is lent is
            compiled without reference counting, whose atomic operations cost a tenth of a trial.
        options: Those of `numba.njit`.
    """
    if function is None:
        return lambda function: compiled(function, allocates=allocates, **options)
    if not allocates:
        options["_nrt"] = False
    # Nobody takes one of them for a C function: what would make it one need not be compiled.
    options["no_cfunc_wrapper"] = True
    dispatcher = numba.njit(function, error_model="numpy", **options)
    if cache_folder() is not None:
        _keep(dispatcher, function)
    return dispatcher


def _keep(dispatcher: Any, function: Callable) -> None:
    """Let what is compiled be kept in our folder; where that fails, nowhere."""
    try:
        kept = _SealedCache(function)
    except RuntimeError:  # no place
        return
    # Numba has a variable that names other places.
    if isinstance(kept._impl.locator, _Place):
        dispatcher._cache = kept


class _Place(_CacheLocator):
    """A folder for each content of a module, by its name, so that all clones and environments share it.

    Numba would go by the file's path.
    """

    def __init__(self, function: Callable, file: str, folder: str) -> None:
        self._line = function.__code__.co_firstlineno
        self._content = SEAL(Path(file).read_bytes()).hexdigest()
        self._path = str(Path(folder) / f"{function.__module__}-{self._content[:12]}")

    def get_cache_path(self) -> str:
        return self._path

    def get_source_stamp(self) -> str:
        return self._content

    def get_disambiguator(self) -> str:
        return str(self._line)

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> _Place | None:
        folder = cache_folder()
        if folder is None:
            return None
        try:
            place = cls(py_func, py_file, folder)
            place.ensure_cache_path()
        except OSError:  # no room, or no file, as for what was typed in
            return None
        return place


class _Kept(CompileResultCacheImpl):
    """What Numba keeps of a function, in our place."""

    _locator_classes = [_Place]  # noqa: RUF012 - Numba's way


class _SealedFile(IndexDataCacheFile):
    """Numba's index and data files, each behind a checksum of its content, data with the key they belong to.

    Two machines that share a home and compile at once both take the first free name of a data file: the
    index of one may come to name the code that the other compiled for its own processor.
    """

    def save(self, key: Any, data: Any) -> None:
        super().save(key, (key, data))

    def load(self, key: Any) -> Any:
        found = super().load(key)
        return found[1] if found and found[0] == key else None

    def _load_index(self) -> dict:
        found = _read(Path(self._index_path))
        return found[1] if found and found[0] == (self._version, self._source_stamp) else {}

    def _save_index(self, overloads: dict) -> None:
        self._write(self._index_path, ((self._version, self._source_stamp), overloads))

    def _load_data(self, name: str) -> Any:
        found = _read(Path(self._data_path(name)))
        if found is None:
            raise OSError(f"{name} is damaged")  # for Numba: as if it were not there
        return found

    def _save_data(self, name: str, data: Any) -> None:
        self._write(self._data_path(name), data)

    def _write(self, path: str, content: Any) -> None:
        with self._open_for_write(path) as file:
            file.write(sealed(self._dump(content)))


class _SealedCache(FunctionCache):
    """What was compiled of one function."""

    _impl_class = _Kept

    def __init__(self, function: Callable) -> None:
        super().__init__(function)
        locator = self._impl.locator
        self._cache_file = _SealedFile(self._cache_path, self._impl.filename_base, locator.get_source_stamp())

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _tell_once(
                f"compiled code: {Path(self._cache_path).parent} cannot be written to ({error.strerror}); "
                "every process compiles what is missing there"
            )


@cache
def _tell_once(sentence: str) -> None:
    """Warn of something; while Numba compiles, Python forgets of what it has warned."""
    warnings.warn(sentence, CacheWarning, stacklevel=3)


def _read(path: Path) -> Any:
    """What a sealed file holds; None if it is missing or damaged."""
    content = unsealed(path)
    # Numba would read it without a look; arm2d.cache sees to it that only the user can have written it.
    return None if content is None else pickle.loads(content)  # noqa: S301
