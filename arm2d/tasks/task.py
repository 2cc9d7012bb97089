"""A task: which words exist, how they are heard, what is held out, and where objects stand.

    Task()                                          the paper's With-Indicate
    Task(third="both")                              twelve instructions
    Task(held_out=("touch green",))                 eight are met, one never
    Task(words="object-first", word_steps=20)       "green", then "touch", then silence
    Task(places="dealt")                            colours change places from trial to trial

Wherever a condition of the paper is taken, a task is taken too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import cache, cached_property
from hashlib import sha256
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any, Final, Literal, get_args, get_type_hints

from arm2d.constants import MAX_STEPS
from arm2d.instructions import (
    ACTION_CODES,
    NON_EXPERIENCED,
    OBJECT_CODES,
    ActionWord,
    Condition,
    Instruction,
    ObjectWord,
    instruction_of,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Code = tuple[int, int, int]
Third = Literal["indicate", "ignore", "both"]
Words = Literal["together", "object-first", "action-first"]
Places = Literal["own", "dealt"]

# Where INDICATE and IGNORE, which share a code in the paper, are both heard.
IGNORE_BESIDE_INDICATE: Final[Code] = (1, 1, 1)
SILENCE: Final[Code] = (0, 0, 0)
WITH_BOTH: Final = "with-both"
LONGEST_NAME: Final = 120


@dataclass(frozen=True)
class Task:
    """What agents are asked, and how. The defaults are the paper's With-Indicate."""

    third: Third = "indicate"
    """Which action stands beside MOVE and TOUCH: indicate, ignore, or both."""

    held_out: tuple[Instruction, ...] = NON_EXPERIENCED
    """Instructions never met during evolution, such as "touch green"; every word must still be met."""

    codes: tuple[str, ...] = ()
    """How words are heard if not as in the paper: a word and three bits, such as "ignore 111"."""

    words: Words = "together"
    """Both words throughout the trial; or one after the other, and then silence."""

    word_steps: int = 10
    """Steps of 0.1 s that each word takes, if they come one after the other."""

    places: Places = "own"
    """Every colour has a sector of its own; or they are dealt to the three sectors anew in each trial."""

    def __post_init__(self) -> None:
        hints = get_type_hints(type(self))
        for name in ("third", "words", "places"):
            if getattr(self, name) not in get_args(hints[name]):
                choices = " or ".join(get_args(hints[name]))
                raise ValueError(f"task {name} = {getattr(self, name)!r}; choose {choices}")
        held_out = _listed("held_out", self.held_out, (Instruction, str), "touch green")
        object.__setattr__(self, "held_out", tuple(sorted(map(instruction_of, held_out))))
        object.__setattr__(self, "codes", _listed("codes", self.codes, (str,), "touch 111"))
        _check_held_out(self)
        _check_codes(self)
        _check_word_steps(self)

    def __str__(self) -> str:
        return self.name

    @cached_property
    def name(self) -> str:
        """Fit for a folder: the third action, then what else is not the paper's, joined by `+`."""
        parts = [self.condition_name]
        for key, value in self.to_mapping().items():
            values = value if isinstance(value, list) else [value]
            parts.append("-".join([key, *map(str, values)] if values else [key, "none"]))
        name = "+".join(parts).replace("_", "-").replace(" ", "-").lower()
        if len(name) <= LONGEST_NAME:
            return name
        return f"{name[: LONGEST_NAME - 9]}-{sha256(name.encode()).hexdigest()[:8]}"

    @property
    def condition_name(self) -> str:
        """What the third action makes of it: with-indicate, with-ignore or with-both."""
        return f"with-{self.third}"

    @property
    def actions(self) -> tuple[ActionWord, ...]:
        """The action words."""
        thirds = {
            "indicate": (ActionWord.INDICATE,),
            "ignore": (ActionWord.IGNORE,),
            "both": (ActionWord.INDICATE, ActionWord.IGNORE),
        }
        return (ActionWord.MOVE, ActionWord.TOUCH, *thirds[self.third])

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """All instructions, action by action."""
        return tuple(Instruction(action, object_) for action in self.actions for object_ in ObjectWord)

    @property
    def experienced(self) -> tuple[Instruction, ...]:
        """Those met during evolution."""
        return tuple(each for each in self.instructions if each not in self.held_out)

    @cached_property
    def word_codes(self) -> NDArray[np.int64]:
        """How three object words, then four action words are heard, [7, 3]."""
        import numpy as np  # here, for whoever only asks for help

        # Not in one table: as numbers, an object word and an action word may be equal.
        actions, given = _action_codes(self.third), self._given_codes
        of_objects = [given.get(word.name, OBJECT_CODES[word]) for word in ObjectWord]
        of_actions = [given.get(word.name, actions[word]) for word in ActionWord]
        return np.array([*of_objects, *of_actions])

    @cached_property
    def code_lists(self) -> list[list[int]]:
        """The same as plain lists, for whoever asks in every step."""
        return self.word_codes.tolist()

    @property
    def in_sequence(self) -> bool:
        """Whether the words come one after the other."""
        return self.words != "together"

    @property
    def largest_fitness(self) -> float:
        """Of a genotype: the mean of 3 for each experienced MOVE and TOUCH, 2 for the others."""
        most = [3 if each.action in (ActionWord.MOVE, ActionWord.TOUCH) else 2 for each in self.experienced]
        return sum(most) / len(most)

    @property
    def _given_codes(self) -> dict[str, Code]:
        return dict(_parse_code(text) for text in self.codes)

    def to_mapping(self) -> dict[str, Any]:
        """What of it is not the paper's, besides the third action, as plain values."""
        plain = {**asdict(self), "held_out": [_plain(each) for each in self.held_out], "codes": [*self.codes]}
        usual = {each.name for each in fields(self) if getattr(self, each.name) == each.default}
        if set(self.held_out) == set(NON_EXPERIENCED):
            usual.add("held_out")
        return {name: value for name, value in plain.items() if name not in usual | {"third"}}


AnyTask = Condition | Task


def read_task(condition: str, values: Mapping[str, Any] | None = None) -> AnyTask:
    """A task from plain values: the name of a condition, with-both among them, and what else is special.

    Raises:
        ValueError: If there is no such condition or value, or the task makes no sense.
    """
    values = values or {}
    known = [each.name for each in fields(Task) if each.name != "third"]
    for name, value in values.items():
        if name not in known:
            raise ValueError(f"unknown part of a task {name!r}; there are {', '.join(known)}")
        _check_kind(name, value)
    plain: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in values.items()
    }
    return as_paper(Task(third=_third(condition), **plain))


def task_of(task: AnyTask | str) -> Task:
    """A condition of the paper, by itself or by its name, or with-both, as a task; a task as it is.

    Raises:
        ValueError: If there is no such condition, or it is none of these.
    """
    if isinstance(task, Task):
        return task
    if not isinstance(task, str):
        raise ValueError(
            f"{shortened(task)} is no task; give an arm2d.Task, or {', '.join(Condition)} or {WITH_BOTH}"
        )
    return _papers()[task] if isinstance(task, Condition) else Task(third=_third(task))


def as_paper(task: AnyTask | str) -> AnyTask:
    """The condition of the paper that a task is, or else the task."""
    if isinstance(task, Condition):
        return task
    own = task_of(task)
    return next((condition for condition, papers in _papers().items() if own == papers), own)


def own_task(task: AnyTask | str | None) -> Task | None:
    """A task that is not the paper's; None of one that is, and of none."""
    found = None if task is None else as_paper(task)
    return found if isinstance(found, Task) else None


def check_asked(instructions: Sequence[Instruction], task: AnyTask) -> None:
    """Refuse instructions that a task does not have.

    Raises:
        ValueError: If there is one.
    """
    known = task.instructions
    # Few objects, again and again: told apart as objects, they need not be compared.
    for each in {id(each): each for each in instructions}.values():
        if each not in known:
            raise ValueError(f"{task} has no instruction {each}; it has {', '.join(map(str, known))}")


@cache
def _papers() -> dict[Condition, Task]:
    """The paper's conditions as tasks."""
    return {condition: Task(third=_third(condition)) for condition in Condition}


def papers_condition(task: AnyTask | str, what: str) -> Condition:
    """The condition of the paper that a task is, or its name means.

    Raises:
        ValueError: If it is another task, for which `what` is not made.
    """
    found = as_paper(task)
    if isinstance(found, Condition):
        return found
    raise ValueError(
        f"{what} is made for the paper's two conditions, {' and '.join(Condition)}, not for {found}; "
        "wordarm evaluate counts all its instructions"
    )


def _third(condition: str) -> Third:
    """The third action that a condition's name tells."""
    name = condition.strip().lower().replace("_", "-").replace(" ", "-")
    if name == WITH_BOTH:
        return "both"
    try:
        return "indicate" if Condition.parse(condition) is Condition.WITH_INDICATE else "ignore"
    except ValueError as error:
        raise ValueError(f"{error}, {WITH_BOTH}") from None


def _action_codes(third: Third) -> dict[ActionWord, Code]:
    return {**ACTION_CODES, ActionWord.IGNORE: IGNORE_BESIDE_INDICATE} if third == "both" else ACTION_CODES


def _plain(instruction: Instruction) -> str:
    return str(instruction).lower()


def _check_kind(name: str, value: Any) -> None:
    """Refuse a value of another kind than its field's."""
    if name in ("held_out", "codes"):
        if not isinstance(value, (list, tuple)) or not all(isinstance(each, str) for each in value):
            raise ValueError(f"task {name} = {value!r} must be a list of texts, such as ['touch green']")
    elif name == "word_steps":
        if not isinstance(value, int) or isinstance(value, bool):
            raise ValueError(f"task word_steps = {value!r} must be a whole number")
    elif not isinstance(value, str):
        raise ValueError(f"task {name} = {value!r} must be text")


def _listed(name: str, values: Any, kinds: tuple[type, ...], example: str) -> tuple[Any, ...]:
    """Several values as a tuple, as long as each is of one of the kinds; a bare text is not several."""
    several = isinstance(values, Iterable) and not isinstance(values, str)
    listed = tuple(values) if several else ()
    if not several or not all(isinstance(each, kinds) for each in listed):
        raise ValueError(f"task {name} = {shortened(values)} must be a list of texts, such as [{example!r}]")
    return listed


def _check_held_out(task: Task) -> None:
    """Refuse instructions that do not exist, that stand twice, or that leave a word unheard."""
    for each in task.held_out:
        if each not in task.instructions:
            raise ValueError(f"{task.condition_name} has no instruction {each} that could be held out")
    if len(set(task.held_out)) < len(task.held_out):
        raise ValueError("task held_out has an instruction twice; leave one out")
    met = {word for each in task.experienced for word in (each.action.name, each.object.name)}
    for word in (*task.actions, *ObjectWord):
        if word.name not in met:
            raise ValueError(
                f"with {', '.join(map(str, task.held_out))} held out, the word {word.name.lower()} would "
                "never be heard; hold out fewer, so that every word is met at least once"
            )


def _parse_code(text: str) -> tuple[str, Code]:
    """A word's name and its code."""
    word, _, bits = text.strip().partition(" ")
    known = [each.name for each in (*ObjectWord, *ActionWord)]
    if word.upper() not in known or len(bits.strip()) != 3 or set(bits.strip()) - {"0", "1"}:
        raise ValueError(f"code {text!r} is not understood; give a word and three bits, such as 'ignore 111'")
    first, second, third = (int(bit) for bit in bits.strip())
    return word.upper(), (first, second, third)


def _check_codes(task: Task) -> None:
    """Refuse codes of words that are never said, that two words share, or that sound like silence."""
    given = [_parse_code(text)[0] for text in task.codes]
    for name in given:
        if name not in {word.name for word in (*task.actions, *ObjectWord)}:
            raise ValueError(f"{task.condition_name} has no word {name.lower()} that could have a code")
        if given.count(name) > 1:
            raise ValueError(f"task codes has {name.lower()} twice; leave one out")
    codes = task.word_codes
    for words, first in ((tuple(ObjectWord), 0), (task.actions, len(ObjectWord))):
        heard: dict[Code, str] = {}
        for word in words:
            code, name = tuple(codes[first + word].tolist()), word.name.lower()
            if code == SILENCE:
                raise ValueError(f"the code of {name} would be 000, which is what silence sounds like")
            if code in heard:
                shown = "".join(map(str, code))
                raise ValueError(
                    f"{heard[code]} and {name} have the same code {shown}; nobody could tell them apart"
                )
            heard[code] = name


def _check_word_steps(task: Task) -> None:
    """Refuse a number of steps that says nothing, or that does not fit into a trial."""
    if not isinstance(task.word_steps, int) or isinstance(task.word_steps, bool):
        raise ValueError(f"task word_steps = {task.word_steps!r} must be a whole number")
    if not task.in_sequence and task.word_steps != Task.word_steps:
        raise ValueError("task word_steps belongs to words that come one after the other; leave it out")
    if not 1 <= 2 * task.word_steps <= MAX_STEPS:
        raise ValueError(f"task word_steps = {task.word_steps} must lie in [1, {MAX_STEPS // 2}]")
