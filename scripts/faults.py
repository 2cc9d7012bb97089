"""Small faults in a source text: what `scripts.mutants` puts in to see whether a test notices.

A fault replaces a few bytes and leaves the rest of the file as it is. There are no faults in annotations,
decorators, texts, and the words of an error.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

# An operator's node, how it is written, and what takes its place.
COMPARISONS: Final[dict[type, tuple[str, str]]] = {
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.NotEq: ("!=", "=="),
    ast.In: ("in", "not in"),
    ast.NotIn: ("not in", "in"),
    ast.Is: ("is", "is not"),
    ast.IsNot: ("is not", "is"),
}
OPERATORS: Final[dict[type, tuple[str, str]]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "*"),
    ast.Mod: ("%", "*"),
    ast.Pow: ("**", "*"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
}
NAMES: Final = {
    one: other
    for pair in (("min", "max"), ("minimum", "maximum"), ("any", "all"), ("argmin", "argmax"))
    for one, other in (pair, pair[::-1])
}
# Without these a function goes on as if nothing had been asked.
DROPPED: Final = (ast.Raise, ast.AugAssign, ast.Continue, ast.Break)
SKIPPED: Final = frozenset({"annotation", "returns", "decorator_list"})


@dataclass(frozen=True)
class Fault:
    """A change of a few bytes.

    Attributes:
        start: Offset of the first byte that is replaced.
        end: Offset after the last.
        new: What takes their place.
        kind: What was done, in two or three words.
    """

    start: int
    end: int
    new: str
    kind: str

    def put_into(self, source: bytes) -> bytes:
        """The source with this fault."""
        return source[: self.start] + self.new.encode() + source[self.end :]


def faults_in(source: bytes) -> list[Fault]:
    """Every fault that can be put into a source, in the order of their places."""
    return sorted(set(_Places(source).faults(ast.parse(source))), key=lambda each: (each.start, each.kind))


class _Places:
    """Finds nodes of a syntax tree again in the bytes."""

    def __init__(self, source: bytes) -> None:
        self._source = source
        self._lines = [0]
        for line in source.splitlines(keepends=True):
            self._lines.append(self._lines[-1] + len(line))

    def faults(self, node: ast.AST) -> Iterator[Fault]:
        """The faults of a node and of all below it."""
        if isinstance(node, ast.JoinedStr) or (
            isinstance(node, ast.If) and "TYPE_CHECK" in ast.dump(node.test)
        ):
            return
        yield from self._own_faults(node)
        if isinstance(node, ast.Raise):
            return
        for name, value in ast.iter_fields(node):
            if name not in SKIPPED:
                for child in value if isinstance(value, list) else [value]:
                    if isinstance(child, ast.AST):
                        yield from self.faults(child)

    def _own_faults(self, node: ast.AST) -> Iterator[Fault]:
        match node:
            case ast.Compare():
                operands = pairwise([node.left, *node.comparators])
                for operator, (left, right) in zip(node.ops, operands, strict=True):
                    yield self._between(left, right, *COMPARISONS[type(operator)], "other comparison")
            case ast.BoolOp():
                old, new = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
                for left, right in pairwise(node.values):
                    yield self._between(left, right, old, new, f"{new} for {old}")
            case ast.BinOp() if type(node.op) in OPERATORS:
                yield self._between(node.left, node.right, *OPERATORS[type(node.op)], "other operator")
            case ast.UnaryOp(op=ast.Not() | ast.USub()):
                word = "not" if isinstance(node.op, ast.Not) else "-"
                yield Fault(self._start(node), self._start(node) + len(word), "", f"{word} dropped")
            case ast.Constant(value=bool()):
                yield self._instead(node, str(not node.value), "other truth value")
            case ast.Constant(value=int() | float() as number):
                yield self._instead(node, repr(number + 1), "number plus one")
            case ast.Name(id=name) | ast.Attribute(attr=name) if name in NAMES:
                yield Fault(self._end(node) - len(name), self._end(node), NAMES[name], "other function")
            case ast.If() | ast.While() | ast.IfExp():
                test = self._text(node.test)
                yield self._instead(node.test, f"(not ({test}))", "condition negated")
            case ast.FunctionDef(body=[_, _, *_]):
                yield from self._early_return(node)
        if isinstance(node, ast.stmt):
            yield from self._dropped(node)

    def _dropped(self, node: ast.stmt) -> Iterator[Fault]:
        """A statement replaced by one that does nothing, if the rest of the function can do without it."""
        if isinstance(node, ast.AugAssign) and type(node.op) in OPERATORS:
            old, new = OPERATORS[type(node.op)]
            yield self._between(node.target, node.value, f"{old}=", f"{new}=", "other operator")
        calls = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        kept = isinstance(node, ast.Assign) and not isinstance(node.targets[0], ast.Name | ast.Tuple)
        if isinstance(node, DROPPED) or calls or kept:
            yield self._instead(node, "pass", "statement dropped")

    def _early_return(self, node: ast.FunctionDef) -> Iterator[Fault]:
        first = node.body[1] if ast.get_docstring(node) else node.body[0]
        start = self._start(first)
        if isinstance(first, ast.stmt) and not getattr(first, "decorator_list", None):
            yield Fault(start, start, f"return\n{' ' * first.col_offset}", "early return")

    def _between(self, left: ast.expr, right: ast.expr, old: str, new: str, kind: str) -> Fault:
        """What stands between two operands, replaced."""
        gap = self._source[self._end(left) : self._start(right)]
        [found] = list(re.finditer(re.escape(old.encode()), gap))[:1]
        return Fault(self._end(left) + found.start(), self._end(left) + found.end(), new, kind)

    def _instead(self, node: ast.expr | ast.stmt, new: str, kind: str) -> Fault:
        return Fault(self._start(node), self._end(node), new, kind)

    def _text(self, node: ast.expr) -> str:
        return self._source[self._start(node) : self._end(node)].decode()

    def _start(self, node: ast.expr | ast.stmt) -> int:
        return self._lines[node.lineno - 1] + node.col_offset

    def _end(self, node: ast.expr | ast.stmt) -> int:
        return self._lines[(node.end_lineno or 0) - 1] + (node.end_col_offset or 0)
