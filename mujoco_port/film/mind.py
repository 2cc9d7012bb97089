"""What an agent hears, feels, sees and thinks, step by step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import ActionWord, Instruction, ObjectWord, Readings, TrialRecord
from arm2d import constants as c
from arm2d.controller import decode
from arm2d.instructions import ACTION_CODES, OBJECT_CODES
from arm2d.progress import progress_of


@dataclass(frozen=True)
class Mind:
    """An agent's K steps, from what comes in to what goes out.

    Attributes:
        inputs: [K, 18], I1 to I18.
        rates: [K, 3], of the inter-neurons, from 0 to 1.
        motors: [K, 4], of the motor neurons, from 0 to 1.
        share: [K + 1], how much of what is asked is done.
        score: [K + 1], F1 + F2 + F3 so far; None where none is defined.
    """

    inputs: NDArray[np.float64]
    rates: NDArray[np.float64]
    motors: NDArray[np.float64]
    share: NDArray[np.float64]
    score: NDArray[np.float64] | None

    @property
    def steps(self) -> int:
        """K."""
        return len(self.inputs)

    def heard(self, step: int, third: ActionWord) -> Instruction:
        """The instruction heard in a step; `third` is the action that shares its code with another."""
        codes = tuple(self.inputs[step, 12:15].astype(int)), tuple(self.inputs[step, 15:].astype(int))
        known = [each for each in ActionWord if each < ActionWord.INDICATE or each is third]
        action = next(each for each in known if ACTION_CODES[each] == codes[1])
        return Instruction(action, next(each for each in ObjectWord if OBJECT_CODES[each] == codes[0]))


def mind_of(record: TrialRecord, genotype: ArrayLike | None) -> Mind:
    """The mind behind a recorded trial.

    Without a genotype, neurons are shown by their states, and motors by the turns they brought about.
    """
    progress = progress_of(record)
    if genotype is not None:
        rates, motors = think(record.inputs, genotype, record.readings)
    else:
        rates, motors = _squash(record.states), _motors_of_turns(record.turns)
    return Mind(record.inputs, rates, motors, progress.share, progress.score)


def think(
    inputs: NDArray[np.float64], genotype: ArrayLike, readings: Readings
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What inter-neurons [K, 3] and motor neurons [K, 4] do while these inputs [K, 18] come in (eq. 1 to 3).

    To be looked at: what decides a trial is the kernel's arithmetic.
    """
    net = decode(genotype, readings)
    y, rates = np.zeros(c.N_INTER), np.empty((len(inputs), c.N_INTER))
    sensed = _squash(net.gain[0] * inputs + net.input_bias[0])  # eq. 1
    for step, s in enumerate(sensed):
        drive = s @ net.sensory_weights[0] + _squash(y + net.inter_biases[0]) @ net.recurrent_weights[0]
        y = y + c.DT / net.decay_constants[0] * (drive - y)  # eq. 2
        rates[step] = _squash(y + net.inter_biases[0])
    return rates, _squash(rates @ net.motor_weights[0] + net.motor_bias[0])  # eq. 3


def _squash(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return 1.0 / (1.0 + np.exp(-values))


def _motors_of_turns(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """What four motor neurons must have done, [K, 4], for turns [K, 2]: go, and which way, for S1 and S2."""
    return np.stack([(turns != 0.0) * 1.0, 0.5 - 0.5 * np.sign(turns)], axis=-1).reshape(-1, 4)
