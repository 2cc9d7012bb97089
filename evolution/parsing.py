"""From arguments to the record of a command, with tyro; what cannot be understood becomes one sentence.

Help is at most 80 columns wide, joins the lines of a field's docstring, and says nothing of a default that is
"not given".
"""

from __future__ import annotations

import ast
import inspect
import io
import os
import re
import shutil
import sys
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import MISSING, Field, fields, is_dataclass
from difflib import get_close_matches
from functools import cache, partial
from itertools import pairwise
from typing import Annotated, Any, Final, TypeVar, get_args, get_origin, get_type_hints

import tyro
from tyro.conf import DisallowNone, FlagConversionOff, FlagCreatePairsOff, arg
from tyro.constructors import (
    MISSING_NONPROP,
    ConstructorRegistry,
    StructConstructorSpec,
    StructFieldSpec,
    StructTypeInfo,
)

T = TypeVar("T")

# Columns of help, however wide or narrow the terminal says it is.
NARROWEST, WIDEST = 40, 80
# Columns of a box that holds a parser's complaint, so that nothing is wrapped in it.
UNWRAPPED: Final = 100_000
# At the left of a column of help; a wide page has several.
OPTION_AT_START: Final = re.compile(r"(?:^\W*|\s{2})(--[a-z][\w.-]*)", re.MULTILINE)
WORDINGS: Final = (
    (r"^Error parsing |'None', ", ""),
    (r"invalid literal for int\(\) with base 10: (.*)", r"a whole number is needed, not \1"),
    (r"could not convert string to float: (.*)", r"a number is needed, not \1"),
    (r"no type matching {(.*)} could be instantiated from \[(.*)\]", r"give one of \1, not \2"),
    (r"invalid choice (.*) for argument '(.*)'. Expected one of \((.*)\)", r"\2: give one of \3, not \1"),
    (r"Missing value for argument '(.*)'. Expected (\d+) values", r"\1 is given too few values; it takes \2"),
    (r"Unrecognized options: (.*)", r"no argument is wanted where \1 stands"),
)
STYLES: Final = re.compile(r"\x1b\[[\d;]*m")
BLANK_ROW: Final = re.compile(r"│\s+│")

REGISTRY: Final = ConstructorRegistry()


def read_command(kind: type[T], arguments: Sequence[str], prog: str, default: T | None = None) -> T:
    """The command that the arguments ask for.

    Args:
        kind: A dataclass.
        arguments: Without the command's name.
        prog: How the command is called, for people.
        default: Its values stand where no argument does.

    Raises:
        ValueError: If there is no such option, or it has no such value, with what would be right.
        SystemExit: With code 0, after help was printed.
    """
    asks_for_help = bool({"-h", "--help"} & set(arguments))
    width, page, complaint = _width(), _Page(asks_for_help), io.StringIO()
    try:
        with (
            _columns(width if asks_for_help else UNWRAPPED),
            redirect_stdout(page),
            redirect_stderr(complaint),
        ):
            return _parsed(kind, arguments, prog, default)
    except SystemExit as end:
        if end.code == 0:
            print(_fitted(page.getvalue(), width))
            raise
    raise ValueError(
        _about_options(kind, arguments, prog, default) or _sentence(complaint.getvalue(), prog)
    ) from None


def nearest(word: str, among: Sequence[str]) -> str | None:
    """What a mistyped word was probably meant to be."""
    return next(iter(get_close_matches(word, among, n=1)), None)


def _parsed(kind: type[T], arguments: Sequence[str], prog: str, default: Any) -> T:
    return tyro.cli(
        kind,
        prog=prog,
        args=list(arguments),
        default=default,
        config=(DisallowNone, FlagCreatePairsOff),
        registry=REGISTRY,
    )


def _width() -> int:
    return min(max(shutil.get_terminal_size().columns, NARROWEST), WIDEST)


@contextmanager
def _columns(width: int) -> Iterator[None]:
    """While open, the terminal is said to be so wide: the parser believes the environment."""
    before = os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = str(width)
    try:
        yield
    finally:
        if before is None:
            del os.environ["COLUMNS"]
        else:
            os.environ["COLUMNS"] = before


class _Page(io.StringIO):
    """What help is collected in: styled for where it goes; a complaint stands in a box that can be read."""

    def __init__(self, asks_for_help: bool) -> None:
        super().__init__()
        self._goes_to, self._asks_for_help = sys.stdout, asks_for_help

    @property
    def encoding(self) -> str:  # pyright: ignore[reportIncompatibleVariableOverride]
        return self._goes_to.encoding if self._asks_for_help else "utf-8"

    def isatty(self) -> bool:
        return self._goes_to.isatty()


def _fitted(text: str, width: int) -> str:
    """Help whose description is as wide as its boxes, and without their empty rows."""
    lines = [line for line in text.splitlines() if not BLANK_ROW.fullmatch(STYLES.sub("", line))]
    return "\n".join(
        line
        if len(STYLES.sub("", line)) <= width
        else textwrap.fill(line, width, subsequent_indent=_indent(line))
        for line in lines
    )


def _indent(line: str) -> str:
    """What stands before the further lines of a long one: those of a usage are no text of their own."""
    return "    " if STYLES.sub("", line).startswith("usage: ") else ""


def _about_options(kind: type[T], arguments: Sequence[str], prog: str, default: T | None) -> str | None:
    """What is wrong with the first option that does not exist; None if all do."""
    known = _options(kind, prog, default)
    for argument in arguments:
        if argument == "--":
            return None
        name = argument.partition("=")[0].replace("_", "-")
        if re.fullmatch(r"--[a-z][\w.-]*", name, re.IGNORECASE) and name not in known:
            meant = nearest(name.lower(), known)
            hint = f"the nearest is {meant}" if meant else f"see: {prog} --help"
            return f"{prog.split()[-1]} has no option {argument.partition('=')[0]}; {hint}"
    return None


def _options(kind: type[T], prog: str, default: T | None) -> list[str]:
    """All options of a command, read from its help."""
    text = io.StringIO()
    try:
        with _columns(UNWRAPPED), redirect_stdout(text):
            _parsed(kind, ["--help"], prog, default)
    except SystemExit:
        pass
    return OPTION_AT_START.findall(text.getvalue())


def _sentence(complaint: str, prog: str) -> str:
    """What the parser draws in a box, down to its first rule, as one sentence."""
    lines = [line[1:-1].strip() for line in complaint.splitlines()[1:-1]]
    rows = []
    for line in lines:
        if not line.strip("─"):
            break
        rows.append(line)
    missing = [row for row in rows if re.fullmatch(r"(--[\w.-]+ )?[A-Z]+(\.\.\.)?", row)]
    if rows and rows[0].startswith("Missing from") and missing:
        return f"{prog.split()[-1]} needs {' and '.join(missing)}; see: {prog} --help"
    text = " ".join(rows).rstrip(".")
    for found, wanted in WORDINGS:
        text = re.sub(found, wanted, text)
    return f"{text}; see: {prog} --help"


@REGISTRY.struct_rule
def _read_dataclass(info: StructTypeInfo) -> StructConstructorSpec | None:
    """Read a dataclass's fields as the parser does, but with help fit to be read."""
    if not is_dataclass(info.type):
        return None
    hints = get_type_hints(info.type, include_extras=True)
    return StructConstructorSpec(
        instantiate=info.type,
        fields=tuple(
            _field_spec(info.type, field, hints[field.name], _default(field, info.default))
            for field in fields(info.type)
        ),
    )


def _field_spec(owner: type, field: Field, kind: Any, default: object) -> StructFieldSpec:
    """A field, its default left out of the help where it says nothing."""
    if get_origin(kind) is not Annotated and (several := _several(kind)):
        kind = Annotated[kind, arg(metavar=several)]
    bare = get_args(kind)[0] if get_origin(kind) is Annotated else kind
    if bool in get_args(bare):  # neither yes nor no is the default, so both can be said
        kind = Annotated[kind, FlagConversionOff]
    if default is None or default == () or isinstance(default, bool):
        kind = Annotated[kind, arg(help_behavior_hint="")]
    return StructFieldSpec(field.name, kind, default, helptext=partial(_field_help, owner, field.name))


def _several(kind: Any) -> str | None:
    """What stands for the values of an option that takes any number of them."""
    for part in (kind, *get_args(kind)):
        if get_origin(part) is tuple and get_args(part)[1:] == (...,):
            return f"{get_args(part)[0].__name__.upper()}..."
    return None


def _default(field: Field, instance: object) -> object:
    """The default of a field: that of a given instance, or its own."""
    if hasattr(instance, field.name):
        return getattr(instance, field.name)
    if field.default is not MISSING:
        return field.default
    return MISSING_NONPROP if field.default_factory is MISSING else field.default_factory()


def _field_help(owner: type, name: str) -> str | None:
    """The docstring below a field, on one line."""
    return next((docs[name] for each in owner.__mro__ if name in (docs := _field_docs(each))), None)


@cache
def _field_docs(owner: type) -> dict[str, str]:
    """The docstrings below the fields of a class."""
    if not is_dataclass(owner):
        return {}
    (definition,) = ast.parse(textwrap.dedent(inspect.getsource(owner))).body
    return {
        field.target.id: " ".join(below.value.value.split())
        for field, below in pairwise(definition.body)  # pyright: ignore[reportAttributeAccessIssue]
        if isinstance(field, ast.AnnAssign)
        and isinstance(field.target, ast.Name)
        and isinstance(below, ast.Expr)
        and isinstance(below.value, ast.Constant)
        and isinstance(below.value.value, str)
    }
