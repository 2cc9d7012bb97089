"""What a run has recorded so far: its parts, then what its checkpoint holds beyond them."""

from __future__ import annotations

from collections.abc import Iterator

from evolution.runs.checkpoint import load_checkpoint
from evolution.runs.folder import RunFolder
from evolution.runs.history import History


def recorded_histories(folder: RunFolder) -> Iterator[History]:
    """The generations scored so far, file after file, without a gap.

    Raises:
        DamagedFileError: If one of the files is damaged.
    """
    spans = folder.finished_spans()
    for span in spans:
        yield folder.read_part(span)
    if unfinished := _beyond(folder, spans):
        yield unfinished


def recorded_history(folder: RunFolder) -> History:
    """The same as one history.

    Raises:
        ValueError: If nothing is recorded yet.
        DamagedFileError: If one of the files is damaged.
    """
    histories = list(recorded_histories(folder))
    if not histories:
        raise ValueError(f"{folder.path} has recorded no generation yet; go on with: wordarm evolve")
    return History.join(histories)


def recorded_generation(folder: RunFolder, generation: int) -> History:
    """One generation, as a history of one; only the file it stands in is read.

    Raises:
        ValueError: If the run has not come so far.
        DamagedFileError: If that file is damaged.
    """
    spans = folder.finished_spans()
    for span in spans:
        if generation in span:
            row = generation - span.start
            return folder.read_part(span)[row : row + 1]
    unfinished, end = _beyond(folder, spans), spans[-1].stop if spans else 0
    if unfinished and end <= generation < end + len(unfinished):
        return unfinished[generation - end : generation - end + 1]
    end += len(unfinished) if unfinished else 0
    raise ValueError(f"{folder.path} has no generation {generation}; it has {end}, numbered from 0")


def _beyond(folder: RunFolder, spans: list[range]) -> History | None:
    """The generations that the checkpoint holds beyond the finished parts, if any."""
    if len(spans) == len(folder.spans):
        return None
    checkpoint = load_checkpoint(folder)
    end = spans[-1].stop if spans else 0
    return checkpoint.unfinished if checkpoint and checkpoint.unfinished and checkpoint.first == end else None
