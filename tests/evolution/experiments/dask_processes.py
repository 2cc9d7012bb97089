"""A Dask scheduler and workers as real processes on this machine."""

import json
import subprocess
import sys
import time
from pathlib import Path

DASK = (sys.executable, "-m", "dask")


def wait_for(condition, seconds=120):
    until = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < until
        time.sleep(0.02)
    return found


class DaskProcesses:
    """Starts them, and leaves none behind."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.processes: list[subprocess.Popen] = []
        self.address = ""

    def start_scheduler(self, port: int = 0) -> subprocess.Popen:
        """On loopback; the port it had can be given to the next one."""
        file = self.folder / "scheduler.json"
        file.unlink(missing_ok=True)
        process = self._start(
            "scheduler", "--host=127.0.0.1", f"--port={port}", f"--scheduler-file={file}", "--no-dashboard"
        )
        self.address = wait_for(lambda: file.exists() and _address(file))
        return process

    def start_worker(self, threads: int = 1) -> subprocess.Popen:
        """One worker, without a nanny that would start it again when it dies."""
        return self._start(
            "worker", self.address, f"--nthreads={threads}", "--no-nanny", "--no-dashboard",
            f"--local-directory={self.folder}", "--host=127.0.0.1",
        )  # fmt: skip

    @property
    def port(self) -> int:
        return int(self.address.rpartition(":")[2])

    def close(self) -> None:
        for each in reversed(self.processes):  # a worker that has lost its scheduler waits for another one
            each.terminate()
            try:
                each.wait(20)
            except subprocess.TimeoutExpired:
                each.kill()
                each.wait()

    def _start(self, *arguments: str) -> subprocess.Popen:
        with (self.folder / f"{arguments[0]}-{len(self.processes)}.log").open("wb") as log:
            process = subprocess.Popen([*DASK, *arguments], stdout=log, stderr=log, cwd=self.folder)
        self.processes.append(process)
        return process


def _address(file: Path) -> str:
    try:
        return json.loads(file.read_text())["address"]
    except ValueError:  # half written
        return ""


def parent_of(pid: int) -> int:
    """The process that started a process."""
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
