"""Two-word instructions and the two conditions of the experiment (sections I and III)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from reprlib import repr as shortened
from typing import TypeVar


class ActionWord(IntEnum):
    """What to do. The number is the code used in arrays."""

    MOVE = 0
    TOUCH = 1
    INDICATE = 2
    IGNORE = 3


class ObjectWord(IntEnum):
    """Which object. The number is the object's index in arrays."""

    BLUE = 0
    GREEN = 1
    RED = 2


Word = TypeVar("Word", ActionWord, ObjectWord)

# How the words are heard (spec section 4). INDICATE and IGNORE share a code: no agent meets both.
OBJECT_CODES = {ObjectWord.BLUE: (1, 1, 0), ObjectWord.GREEN: (1, 0, 1), ObjectWord.RED: (0, 1, 1)}
ACTION_CODES = {
    ActionWord.MOVE: (0, 1, 1),
    ActionWord.TOUCH: (1, 0, 1),
    ActionWord.INDICATE: (1, 1, 0),
    ActionWord.IGNORE: (1, 1, 0),
}


@dataclass(frozen=True, order=True)
class Instruction:
    """An action word with an object word (the paper: linguistic labels)."""

    action: ActionWord
    object: ObjectWord

    def __post_init__(self) -> None:
        if not isinstance(self.action, ActionWord) or not isinstance(self.object, ObjectWord):
            raise ValueError(
                f"an instruction is an ActionWord and an ObjectWord, not {self.action!r} and "
                f"{self.object!r}; text such as 'touch green' is read by Instruction.parse"
            )

    @classmethod
    def parse(cls, text: str) -> Instruction:
        """Read an instruction such as "touch green", in any case.

        Raises:
            ValueError: If the text is not one known action word and one known object word.
        """
        words = text.split()
        if len(words) != 2:
            raise ValueError(
                f"instruction {text!r} has {len(words)} words, not two; "
                "give an action word and an object word, such as 'touch green'"
            )
        return cls(_find_word(ActionWord, "action", words[0]), _find_word(ObjectWord, "object", words[1]))

    def __str__(self) -> str:
        return f"{self.action.name} {self.object.name.capitalize()}"

    def __repr__(self) -> str:
        return f"Instruction.parse('{str(self).lower()}')"


class Condition(StrEnum):
    """Which third action stands beside MOVE and TOUCH."""

    WITH_INDICATE = "with-indicate"
    WITH_IGNORE = "with-ignore"

    @property
    def third_action(self) -> ActionWord:
        """INDICATE or IGNORE."""
        return ActionWord.INDICATE if self is Condition.WITH_INDICATE else ActionWord.IGNORE

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """All nine instructions, action by action, in the order of the words' codes."""
        actions = (ActionWord.MOVE, ActionWord.TOUCH, self.third_action)
        return tuple(Instruction(action, object_) for action in actions for object_ in ObjectWord)

    @property
    def held_out(self) -> tuple[Instruction, ...]:
        """The two never met."""
        return NON_EXPERIENCED

    @property
    def experienced(self) -> tuple[Instruction, ...]:
        """The seven instructions met during evolution."""
        return tuple(each for each in self.instructions if each not in NON_EXPERIENCED)

    @classmethod
    def parse(cls, text: str) -> Condition:
        """Read a condition's name, in any case, with hyphen, underscore or blank.

        Raises:
            ValueError: If there is no such condition.
        """
        name = text.strip().lower().replace("_", "-").replace(" ", "-")
        try:
            return cls(name)
        except ValueError:
            raise ValueError(f"unknown condition {text!r}; there are {', '.join(cls)}") from None


# Never met during evolution, in both conditions (section V).
NON_EXPERIENCED = (
    Instruction(ActionWord.TOUCH, ObjectWord.GREEN),
    Instruction(ActionWord.MOVE, ObjectWord.BLUE),
)


def instruction_of(asked: Instruction | str) -> Instruction:
    """An instruction, given as a record or as text.

    Raises:
        ValueError: If it is neither, or the text is not understood.
    """
    if isinstance(asked, Instruction):
        return asked
    if isinstance(asked, str):
        return Instruction.parse(asked)
    raise ValueError(f"{shortened(asked)} is no instruction; give text such as 'touch green'")


def instructions_of(asked: Iterable[Instruction | str] | Instruction | str) -> list[Instruction]:
    """One instruction or several, each a record or text.

    Raises:
        ValueError: If it is neither, or a text is not understood.
    """
    if isinstance(asked, Instruction | str) or not isinstance(asked, Iterable):
        return [instruction_of(asked)]
    return [each if isinstance(each, Instruction) else instruction_of(each) for each in asked]


def _find_word(words: type[Word], kind: str, text: str) -> Word:
    """The member of `words` called `text` in any case."""
    try:
        return words[text.upper()]
    except KeyError:
        known = ", ".join(word.name.lower() for word in words)
        raise ValueError(f"unknown {kind} word {text!r}; this world knows {known}") from None
