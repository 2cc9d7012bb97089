"""What is heard when: both words throughout a trial, or one after the other and then silence.

In arrays, a word that is not said is number 4 among the actions, number 3 among the objects.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from arm2d.instructions import ActionWord, Instruction, ObjectWord
from arm2d.tasks.task import SILENCE, Task

NO_ACTION: Final = len(ActionWord)
NO_OBJECT: Final = len(ObjectWord)
# One word, the other, silence.
N_PHASES: Final = 3


def phases(actions: NDArray[np.int64], objects: NDArray[np.int64], task: Task) -> NDArray[np.int64]:
    """(action, object) heard in each phase of T trials whose words come in sequence, [T, 3, 2]."""
    heard = np.empty((len(actions), N_PHASES, 2), np.int64)
    heard[...] = NO_ACTION, NO_OBJECT
    action_comes = 0 if task.words == "action-first" else 1
    heard[:, action_comes, 0] = actions
    heard[:, 1 - action_comes, 1] = objects
    return heard


def phase_after(steps: NDArray[np.int64], task: Task) -> NDArray[np.int64]:
    """In which phase words are heard after so many steps; 0 throughout if they are not in sequence."""
    if not task.in_sequence:
        return np.zeros_like(steps)
    return np.minimum(steps // task.word_steps, N_PHASES - 1)


def word_bits(actions: NDArray[np.int64], objects: NDArray[np.int64], codes: NDArray) -> NDArray[np.int64]:
    """I13 to I18 for words heard, [N, 6].

    Args:
        actions: [N], `NO_ACTION` for none.
        objects: [N], `NO_OBJECT` for none.
        codes: [7, 3], three object words, then four action words.
    """
    silence = np.zeros((1, 3), np.int64)
    of_objects = np.concatenate([codes[:NO_OBJECT], silence])
    of_actions = np.concatenate([codes[NO_OBJECT:], silence])
    return np.concatenate([of_objects[objects], of_actions[actions]], axis=-1)


def words_of(bits: NDArray, task: Task) -> tuple[ActionWord | None, ObjectWord | None]:
    """Which words I13 to I18, [6], are in a task; None for one that is not said."""
    codes = task.word_codes
    said_object, said_action = bits[:3], bits[3:]
    object_ = next((word for word in ObjectWord if (codes[word] == said_object).all()), None)
    action = next((word for word in task.actions if (codes[NO_OBJECT + word] == said_action).all()), None)
    return action, object_


def bits_heard(instruction: Instruction, task: Task, step: int) -> list[int]:
    """I13 to I18 in a step, counted from 0, told as simply as possible."""
    codes = task.code_lists
    object_, action = codes[instruction.object], codes[len(ObjectWord) + instruction.action]
    if task.words == "together":
        return [*object_, *action]
    first = step < task.word_steps
    second = not first and step < 2 * task.word_steps
    object_now, action_now = (first, second) if task.words == "object-first" else (second, first)
    return [*(object_ if object_now else SILENCE), *(action if action_now else SILENCE)]
