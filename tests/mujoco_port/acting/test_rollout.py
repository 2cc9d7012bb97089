"""A trial that is carried out step by step, and goes on with other words."""

from dataclasses import fields

import numpy as np

from arm2d import Instruction
from mujoco_port.acting.eyes import geometric_eyes
from mujoco_port.acting.open_loop import OpenLoop
from mujoco_port.acting.rollout import Carrying, PhysicalRecord

ROWS = [
    each.name
    for each in fields(PhysicalRecord)
    if each.name not in ("instruction", "scale", "step_s", "orders", "inputs")
]


class Listening(OpenLoop):
    """Follows its orders and keeps all that it is told."""

    def __init__(self, angles):
        super().__init__(iter(angles))
        self.told = []

    def after(self, so_far, seen):
        self.told.append({name: getattr(so_far, name).copy() for name in ROWS})
        return super().after(so_far, seen)


def test_after_other_words_the_pilot_still_knows_the_last_step_and_the_record_begins_anew(
    lab, champion_records
):
    record, n = champion_records[0], lab.body.steps_per_turn
    angles = [(60.0 + 2.9 * k, 90.0) for k in range(12)]
    pilot = Listening(angles)
    asked = [Instruction.parse(text) for text in ("touch blue", "move red")]
    discs, eyes = record.discs[0], geometric_eyes(lab.body)
    trial = Carrying(lab.body, lab.kinematics, pilot, eyes, asked[0], discs)
    for _ in range(4):
        trial.step()
    before = {name: getattr(trial.record, name).copy() for name in ROWS}
    assert len(before["hand"]) == 4 * n
    trial.ask(asked[1])
    assert len(trial.record.hand) == 0
    trial.step()
    for name in ROWS:
        np.testing.assert_array_equal(pilot.told[-1][name], before[name][-n:], name)
    assert trial.record.instruction == asked[1]
    assert len(trial.record.hand) == n
    assert trial.record.orders.tolist() == [list(each) for each in angles[4:6]]
