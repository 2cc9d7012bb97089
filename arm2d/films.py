"""Files of pictures, MP4 and PNG, that are whole or not there: an old file stays until the new one is closed.

A film is one only if ffmpeg has closed it with success. What is unfinished has a name of its own that no film
has, `.NAME.<number>.unfinished`, and is taken away on every error and every signal that can be caught.
"""

from __future__ import annotations

import errno
import io
import os
import secrets
import signal
import subprocess
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from itertools import chain
from pathlib import Path
from tempfile import TemporaryFile
from typing import Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from arm2d.files import handle_of_new

# H.264 that every player and browser knows, its index in front so that a browser starts at once; this preset
# takes a third of the default's time, and a constant rate factor of 15 leaves edges sharp.
ENCODING: Final = ("-an", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "15", "-preset", "veryfast")
FORMAT: Final = ("-movflags", "+faststart", "-f", "mp4")
KEPT_OF_A_NAME: Final = 50  # characters, in that of the file that is not finished
NO_ROOM: Final = "No space left on device"  # as ffmpeg says it
# Signals that end a process, unless it takes them up.
ENDING: Final = (
    signal.SIGHUP,
    signal.SIGINT,
    signal.SIGQUIT,
    signal.SIGTERM,
    signal.SIGALRM,
    signal.SIGUSR1,
    signal.SIGUSR2,
    signal.SIGXCPU,
)


class NoEncoderError(OSError):
    """No ffmpeg on this machine writes H.264."""


def find_encoder() -> str:
    """The ffmpeg that writes films here.

    Raises:
        NoEncoderError: If there is none, or none that can write H.264.
    """
    return _find_encoder(os.environ.get("IMAGEIO_FFMPEG_EXE", ""))


@cache
def _find_encoder(chosen: str) -> str:
    """The same for one value of IMAGEIO_FFMPEG_EXE, which `imageio_ffmpeg` reads."""
    import imageio_ffmpeg

    try:
        program = chosen or imageio_ffmpeg.get_ffmpeg_exe()
        listed = subprocess.run(  # noqa: S603 - a program, no shell
            [program, "-hide_banner", "-encoders"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            check=True,
        ).stdout
    except (RuntimeError, OSError, subprocess.CalledProcessError) as error:
        raise NoEncoderError(f"no ffmpeg can be run ({error}); `wordarm doctor` says what to do") from None
    if "libx264" not in listed:
        raise NoEncoderError(
            f"{program} cannot write H.264 (it has no libx264); `wordarm doctor` says what to do"
        )
    return program


def write_mp4(pictures: Iterable[NDArray[np.uint8]], path: Path | str, per_second: int) -> Path:
    """Write frames [H, W, 3], H and W even, as an MP4; a file of that name is replaced when it is complete.

    Raises:
        NoEncoderError: If nothing here can write films; told before the first frame is asked for.
        OSError: If it cannot be written; an old file is still there.
    """
    program, path = find_encoder(), Path(path)
    pictures = iter(pictures)
    with unfinished(path) as file:
        first = next(pictures)
        size = f"{first.shape[1]}x{first.shape[0]}"
        source = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(per_second), "-i", "-")
        command = [program, "-y", "-v", "error", *source, *ENCODING, *FORMAT, str(file)]
        _encode(command, chain([first], pictures), path)
    return path


def write_png(picture: NDArray[np.uint8], path: Path | str) -> Path:
    """Write a picture [H, W, 3] as a PNG; a file of that name is replaced when it is complete.

    Raises:
        OSError: If it cannot be written; an old file is still there.
    """
    from PIL import Image

    path, buffer = Path(path), io.BytesIO()
    Image.fromarray(picture).save(buffer, "PNG")
    with unfinished(path) as file:
        try:
            file.write_bytes(buffer.getvalue())
        except OSError as error:
            _refuse(path, _why(error))
    return path


@contextmanager
def unfinished(path: Path) -> Iterator[Path]:
    """An empty file beside `path`, which gets its name if all goes well and is taken away if not.

    Raises:
        OSError: If it cannot be made or renamed.
    """
    # Absolute: to ffmpeg, what stands before the first colon of a relative path is a protocol.
    folder = Path(os.path.abspath(path)).parent
    # A name may be as long as the file system allows, which this one must not exceed.
    file = folder / f".{path.name[:KEPT_OF_A_NAME]}.{secrets.token_hex(4)}.unfinished"
    with _ending_in_order():
        try:
            try:
                os.close(handle_of_new(file))
            except OSError as error:
                _refuse(path, _why(error))
            yield file
            try:
                _flush(file)
                os.replace(file, path)
            except OSError as error:
                _refuse(path, _why(error))
        finally:
            file.unlink(missing_ok=True)


def _encode(command: list[str], pictures: Iterable[NDArray[np.uint8]], path: Path) -> None:
    """Let ffmpeg write what it is fed; `path` is what the user calls the file."""
    with TemporaryFile() as said:
        # A process group of its own: Ctrl-C in a terminal is for us, who then end it.
        ffmpeg = subprocess.Popen(  # noqa: S603 - a program, no shell
            command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said, process_group=0
        )
        try:
            assert ffmpeg.stdin is not None  # noqa: S101 - asked for above
            with ffmpeg.stdin as feed:
                for picture in pictures:
                    feed.write(np.ascontiguousarray(picture).data)
        except BrokenPipeError:
            pass  # it has ended: its exit code and its last words say why
        except BaseException:
            ffmpeg.kill()
            raise
        finally:
            ended = ffmpeg.wait()
        said.seek(0)
        words = said.read().decode(errors="replace").strip().splitlines()
    if ended:
        if any(NO_ROOM in line for line in words):
            _refuse(path, os.strerror(errno.ENOSPC))
        how = f"ended by {signal.Signals(-ended).name}" if ended < 0 else f"exit code {ended}"
        _refuse(path, f"ffmpeg failed ({words[-1] if words else how})")


def _refuse(path: Path, why: str) -> NoReturn:
    """Say that a file was not written."""
    raise OSError(f"{path} cannot be written: {why}; a file of that name is as it was") from None


def _why(error: OSError) -> str:
    return error.strerror or str(error)


def _flush(file: Path) -> None:
    """Have everything on the disk before the name is given: some disks say only now that they are full."""
    handle = os.open(file, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


@contextmanager
def _ending_in_order() -> Iterator[None]:
    """While open, a signal that would end the process does so only after what is in `finally`.

    Python hands signals to the main thread alone; in another one they end the process as ever.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    caught: list[int] = []

    def stop(number: int, frame: object) -> None:
        del frame
        caught.append(number)
        raise SystemExit(128 + number)

    taken = [each for each in ENDING if signal.getsignal(each) is signal.SIG_DFL]
    for number in taken:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, signal.SIG_DFL)
        if caught:
            signal.raise_signal(caught[0])
