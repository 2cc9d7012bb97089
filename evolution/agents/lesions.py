"""Which word an agent needs, and when: a word is silenced or exchanged before or after first sight.

A compositional agent as the paper describes it (section VII) searches on the object word alone and
then acts on the action word alone. Axes: P agents, 9 instructions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from arm2d import ActionWord, Condition, LabelChanges, ObjectWord, Readings, Trials, run_trials
from arm2d.kernel.world import WORD_CODES
from arm2d.records import alike, brief
from arm2d.tasks.task import AnyTask, papers_condition
from evolution.agents.behaviour import TRIALS_PER_AREA, draw_behaviour_trials

WORDS: Final = ("action", "object")
TIMES: Final = ("before sight", "after sight")
MANNERS: Final = ("silenced", "exchanged")


@dataclass(frozen=True)
class Lesion:
    """What is done to an instruction.

    Attributes:
        word: Which word, "action" or "object".
        time: "before sight" or "after sight": up to the step after which the target first comes into
            view, or from the next one on. If it never does, nothing is "after".
        manner: "silenced" sets the word's three inputs to 0, which no agent ever heard; "exchanged"
            puts another word of the condition in its place, each of the two others in turn.
    """

    word: str
    time: str
    manner: str

    @property
    def harmless(self) -> bool:
        """Whether an agent that searches on the object word and acts on the action word would not mind."""
        return (self.word, self.time) in (("action", "before sight"), ("object", "after sight"))


LESIONS: Final = tuple(
    sorted((Lesion(*each) for each in product(WORDS, TIMES, MANNERS)), key=lambda each: not each.harmless)
)


@dataclass(frozen=True)
class LesionScores:
    """What lesions leave of P agents' skills.

    Attributes:
        condition: Names the instructions.
        per_area: Trials of each instruction from each start area, the same for all agents and lesions.
        intact: [P, 9], share of successful trials without a lesion.
        lesioned: [P, 8, 9], with each of `LESIONS`.
    """

    condition: Condition
    per_area: int
    intact: NDArray[np.float64]
    lesioned: NDArray[np.float64]

    __repr__ = brief
    __eq__ = alike

    def arrays(self) -> dict[str, NDArray]:
        """Its arrays by name, ready for an .npz."""
        names = [f"{lesion.word} word {lesion.manner} {lesion.time}" for lesion in LESIONS]
        return {"intact": self.intact, "lesioned": self.lesioned, "lesions": np.array(names)}


def lesion_scores(
    genotypes: ArrayLike,
    condition: AnyTask | str,
    readings: Readings,
    *,
    per_area: int = TRIALS_PER_AREA,
    trial_seed: int = 0,
) -> LesionScores:
    """Run the same trials without and with each lesion; they are those of `record_behaviour`.

    Args:
        genotypes: [P, G], or one [G].
        condition: Which nine instructions; its name will do.
        readings: The world, which should be the one the agents evolved in.
        per_area: Trials of each instruction from each start area.
        trial_seed: Draws the trials.

    Raises:
        ValueError: If a genotype is unsound, or there are no trials.
    """
    condition = papers_condition(condition, "this test of lesions")
    trials = draw_behaviour_trials(condition, readings, per_area, trial_seed)
    intact = run_trials(genotypes, trials, readings).success
    lesioned = [_success(genotypes, trials, lesion, condition, readings) for lesion in LESIONS]
    by_instruction = [success.reshape(len(success), 9, -1).mean(axis=-1) for success in (intact, *lesioned)]
    return LesionScores(condition, per_area, by_instruction[0], np.stack(by_instruction[1:], axis=1))


def _success(
    genotypes: ArrayLike, trials: Trials, lesion: Lesion, condition: Condition, readings: Readings
) -> NDArray[np.float64]:
    """Success in each trial, a mean over substitutes, [P, T]."""
    by_target = []
    for target in ObjectWord:
        own = trials[np.flatnonzero(trials.objects == target)]
        heard = lesioned_trials(own, target, lesion, condition)
        runs = [run_trials(genotypes, each, readings, word_codes=codes).success for each, codes in heard]
        by_target.append(np.mean(runs, axis=0))
    success = np.empty((len(by_target[0]), len(trials)))
    for target, values in zip(ObjectWord, by_target, strict=True):
        success[:, trials.objects == target] = values
    return success


def lesioned_trials(
    trials: Trials, target: ObjectWord, lesion: Lesion, condition: Condition
) -> list[tuple[Trials, NDArray[np.int64]]]:
    """Trials of one target with a word replaced, one variant for each substitute, and how words are heard.

    Silence is a word as well, one that these trials need for nothing else, heard as 0 0 0: the action
    word of the other condition, or the object word of another disc.

    Args:
        trials: T trials of the target.
        target: The object word of all of them.
        lesion: What is done.
        condition: Whose words may be exchanged.
    """
    codes = WORD_CODES.copy()
    if lesion.word == "action":
        spare = next(each for each in ActionWord if each not in _actions(condition))
        others = [_rotated(trials.actions, condition, shift) for shift in (1, 2)]
        silent, row = np.full(len(trials), spare), len(ObjectWord) + spare
    else:
        others = [np.full(len(trials), (target + shift) % len(ObjectWord)) for shift in (1, 2)]
        silent, row = others[0], int(others[0][0])
    if lesion.manner == "exchanged":
        return [(_replace(trials, lesion, words), codes) for words in others]
    codes[row] = 0
    return [(_replace(trials, lesion, silent), codes)]


def _replace(trials: Trials, lesion: Lesion, substitutes: NDArray[np.int64]) -> Trials:
    """The trials with a word of the instruction replaced before or after first sight."""
    whole = (trials.actions, trials.objects)
    broken = (substitutes, trials.objects) if lesion.word == "action" else (trials.actions, substitutes)
    first, later = (broken, whole) if lesion.time == "before sight" else (whole, broken)
    return replace(trials, changes=LabelChanges(*first, *later, np.zeros(len(trials), np.int64)))


def _actions(condition: Condition) -> tuple[ActionWord, ...]:
    """The three action words of a condition."""
    return tuple(each.action for each in condition.instructions[:: len(ObjectWord)])


def _rotated(actions: NDArray[np.int64], condition: Condition, shift: int) -> NDArray[np.int64]:
    """For each action word another of the same condition, [T]."""
    known = _actions(condition)
    return np.array([known[(known.index(ActionWord(action)) + shift) % len(known)] for action in actions])
