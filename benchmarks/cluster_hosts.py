"""Several hosts on one machine: network namespaces with a scheduler, workers, and a host that is cut off.

python -m benchmarks.cluster_hosts      (as root on Linux, with iproute2)

Three namespaces hang on one bridge: the scheduler's, and two with a worker each. Once both work on a run, the
second is cut off from the network. Its run must go on elsewhere, never be written by two, and end with the
bits of an undisturbed one.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from evolution.experiments.cluster.address import connected
from evolution.experiments.cluster.running import RemoteStart
from evolution.experiments.jobs import Overseer
from evolution.experiments.plan import Plan
from evolution.experiments.plan_runner import run_plan
from evolution.experiments.standing import is_held
from evolution.search.config import RunConfig
from evolution.search.settings import Settings

HOSTS = ("wordarm0", "wordarm1", "wordarm2")
BRIDGE = "wordarm"
NETWORK = "10.77.0"
ADDRESS = f"tcp://{NETWORK}.10:8786"
SMALL = Settings(population=20, elites=2, parents=10, generations=1500)
CONFIGS = tuple(RunConfig(seed=seed, settings=SMALL) for seed in (1, 2))
DASK = (sys.executable, "-m", "dask")


def ip(*arguments: str) -> None:
    """Run iproute2."""
    subprocess.run(["ip", *arguments], check=True)


@contextmanager
def hosts() -> Iterator[None]:
    """Namespaces with addresses 10.77.0.10 and following; this one is 10.77.0.1."""
    with ExitStack() as undo:
        ip("link", "add", BRIDGE, "type", "bridge")
        undo.callback(ip, "link", "delete", BRIDGE)
        ip("address", "add", f"{NETWORK}.1/24", "dev", BRIDGE)
        ip("link", "set", BRIDGE, "up")
        for i, host in enumerate(HOSTS):
            ip("netns", "add", host)
            undo.callback(ip, "netns", "delete", host)
            ip("link", "add", f"{host}-out", "type", "veth", "peer", "name", "eth0", "netns", host)
            ip("link", "set", f"{host}-out", "master", BRIDGE, "up")
            ip("-n", host, "address", "add", f"{NETWORK}.{10 + i}/24", "dev", "eth0")
            for device in ("eth0", "lo"):
                ip("-n", host, "link", "set", device, "up")
        yield


def start_on(host: str, *command: str) -> subprocess.Popen:
    """Start a process on a host."""
    return subprocess.Popen(
        ["ip", "netns", "exec", host, *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


def main() -> None:
    """Cut a host off, and compare."""
    with tempfile.TemporaryDirectory() as name, hosts():
        folder, processes = Path(name), []
        undisturbed, plan = (Plan(folder / each, CONFIGS, False) for each in ("undisturbed", "cut-off"))
        assert run_plan(undisturbed, 2) == ()
        try:
            processes.append(start_on(HOSTS[0], *DASK, "scheduler", f"--host={NETWORK}.10", "--no-dashboard"))
            time.sleep(5)
            for host in HOSTS[1:]:
                worker = ("worker", ADDRESS, "--nthreads=1", "--nworkers=1", f"--local-directory={folder}")
                processes.append(start_on(host, *DASK, *worker, "--interface=eth0", "--no-dashboard"))
            run_cut_off(plan)
        finally:
            for process in processes:
                process.terminate()
            for process in processes:
                process.wait()
        same = [parts(undisturbed.path(each)) == parts(plan.path(each)) for each in CONFIGS]
        print(f"{sum(same)} of {len(same)} runs have the bits of the undisturbed ones")
        for log in sorted((plan.folder / "logs").glob("*.log")):
            print(f"{log.name}: begun {log.read_text().count('from generation')} times")
        sys.exit(not all(same))


def run_cut_off(plan: Plan) -> None:
    """Run the plan on the hosts; cut the last one off when all runs are at work."""
    cut_at = None

    def cut(jobs: object) -> None:
        nonlocal cut_at
        if cut_at is None and all(is_held(plan.path(each)) for each in CONFIGS):
            ip("link", "set", f"{HOSTS[-1]}-out", "down")
            cut_at = time.monotonic()
            print("both runs at work; the second host is cut off", flush=True)

    with connected(ADDRESS, plan.folder) as cluster:
        cluster.on_note = print
        assert run_plan(plan, sys.maxsize, Overseer(on_tick=cut), RemoteStart(cluster)) == ()
    assert cut_at is not None, "the runs were over before anything was cut off"
    print(f"all runs done {time.monotonic() - cut_at:.0f} s after that")


def parts(path: Path) -> dict[str, bytes]:
    """Every finished part of a run."""
    return {each.name: each.read_bytes() for each in path.glob("parts/*.npz")}


if __name__ == "__main__":
    main()
