"""`wordarm live`: how soon the page is there, how many moments a second reach one viewer, and what one costs.

python -m benchmarks.live [seconds]
"""

from __future__ import annotations

import resource
import signal
import statistics
import subprocess
import sys
import time
from itertools import pairwise

from websockets.sync.client import connect

from arm2d import Instruction

STARTS = 3
COMMAND = [sys.executable, "-m", "evolution", "live", "best-generaliser", "--port=0"]


def main() -> None:
    """Start it a few times, look on the last time, and print a table."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 20.0
    starts = []
    for number in range(STARTS):
        began = time.perf_counter()
        server = subprocess.Popen(COMMAND, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert server.stdout is not None
        address = server.stdout.readline().split()[1]
        starts.append(time.perf_counter() - began)
        if number < STARTS - 1:
            ended(server)
    cpu_of_a_start = cpu_of_children() / (STARTS - 1)
    moments = looked_on(address, seconds)
    before = cpu_of_children()
    ended(server)
    cpu = cpu_of_children() - before - cpu_of_a_start
    print(f"from the command to the address: {statistics.median(starts):.1f} s on the clock")
    print(f"the same, with its end:          {cpu_of_a_start:.1f} s of CPU")
    print(f"moments to one viewer:           {moments / seconds:.1f} a second")
    print(f"a moment:                        {1000 * cpu / moments:.1f} ms of CPU")
    for closed in (False, True):
        print(f"while the robot acts, {'closed' if closed else 'open'} loop:")
        for part, cost in costs_of_a_moment(closed).items():
            print(f"  {part:<31}{cost:.1f} ms of CPU")


def costs_of_a_moment(closed: bool) -> dict[str, float]:
    """Milliseconds of CPU of each part of a moment of 1/25 s, the mean over whole trials."""
    from evolution.agents.recording import record_instruction
    from evolution.runs.sources import find_agent
    from models.robots import get_robot
    from mujoco_port.acting.lab import Lab
    from mujoco_port.live.actor import Actor
    from mujoco_port.live.orders import Again, Run, Say
    from mujoco_port.live.posture import Posture
    from mujoco_port.live.session import Session
    from mujoco_port.live.trial import Start

    agent, robot = find_agent("best-generaliser"), get_robot("icub")
    instructions = agent.condition.instructions

    def draw(area: str, seed: int) -> Start:
        record = record_instruction(agent, instructions[0], "left" if area == "left" else "right", seed)
        return Start(float(record.alpha[0]), record.discs[0])

    actor = Actor(agent.name, agent.genotype, agent.readings, instructions)
    lab = Lab(robot, agent.readings)
    session, posture = Session(lab, actor, draw, closed=closed), Posture(lab.body.robot)
    parts = ("physics, agent and judges", "the state, for the panels", "where everything is")
    spent, moments = dict.fromkeys(parts, 0.0), 0
    for words in ("touch green", "move red", "indicate blue"):
        session.do(Again())
        session.do(Say.both(Instruction.parse(words)))
        session.do(Run(True))
        while session.running:
            times = [time.process_time()]
            moment = session.tick()
            times.append(time.process_time())
            session.state()
            times.append(time.process_time())
            posture.poses(moment, pointing=False)
            times.append(time.process_time())
            for part, (began, done) in zip(spent, pairwise(times), strict=True):
                spent[part] += done - began
            moments += 1
    return {part: 1000 * seconds / moments for part, seconds in spent.items()}


def looked_on(address: str, seconds: float) -> int:
    """Moments that come in so many seconds."""
    moments, until = 0, time.perf_counter() + seconds
    with connect(address.replace("http", "ws", 1) + "socket", max_size=None) as socket:
        while time.perf_counter() < until:
            moments += isinstance(socket.recv(timeout=10), bytes)
    return moments


def ended(server: subprocess.Popen) -> None:
    """Wait for its end, as after Ctrl-C."""
    server.send_signal(signal.SIGINT)
    server.communicate(timeout=60)


def cpu_of_children() -> float:
    """CPU seconds of processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()
