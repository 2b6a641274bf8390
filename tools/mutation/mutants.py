"""Mutants: places where the code can be changed a little, and a seeded draw of them.

The changes are the operators of cosmic-ray. Left out are those that the import or the first call
shows at once (types, decorators, an addition made a shift), and texts: docstrings, f-strings, and
errors that are raised.
"""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import cached_property
from itertools import permutations
from pathlib import Path
from random import Random
from typing import Any

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.operators.provider import OperatorProvider

AREAS: dict[str, tuple[str, ...]] = {
    "flight": ("airhilt/world/flight",),
    "radio": ("airhilt/sensors/radio", "airhilt/phraseology"),
    "surveillance": (
        "airhilt/surveillance",
        *(f"airhilt/sensors/{name}.py" for name in ("adsb", "cockpit", "radar", "surface", "tcas")),
    ),
    "assistant": ("airhilt/assistant",),
    "truth": ("airhilt/world/truth",),
    "metrics": ("airhilt/metrics",),
}
"""Folders and modules of the areas that mutants are drawn from, in equal numbers."""
ARITHMETIC = ("Add", "Sub", "Mul", "Div", "FloorDiv", "Mod", "Pow")
SETS = ("BitOr", "BitAnd")
ORDERS = ("Eq", "NotEq", "Lt", "LtE", "Gt", "GtE")
IDENTITIES = ("Is", "IsNot")
TYPES = frozenset(
    {"bool", "bytes", "dict", "float", "int", "list", "object", "set", "str", "tuple"}
)

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
WORD = re.compile(r"[A-Za-z_]\w*")

Position = tuple[int, int]
"""Line, from 1, and column, from 0."""


def operator_names() -> tuple[str, ...]:
    """Return the names of the operators of cosmic-ray that are used."""
    replaced = [
        f"Replace{kind}Operator_{old}_{new}"
        for kind, family in (
            ("Binary", ARITHMETIC),
            ("Binary", SETS),
            ("Comparison", ORDERS),
            ("Comparison", IDENTITIES),
        )
        for old, new in permutations(family, 2)
    ]
    return (
        *replaced,
        *("ReplaceUnaryOperator_Delete_USub", "ReplaceUnaryOperator_Delete_Not"),
        *("ReplaceTrueWithFalse", "ReplaceFalseWithTrue", "ReplaceAndWithOr", "ReplaceOrWithAnd"),
        *("ReplaceBreakWithContinue", "ReplaceContinueWithBreak"),
        *("AddNot", "ExceptionReplacer", "NumberReplacer", "ZeroIterationForLoop"),
    )


def _operators() -> dict[str, Any]:
    provider = OperatorProvider()
    return {name: provider[name]() for name in operator_names()}


@dataclass(frozen=True)
class Mutant:
    """One change of one module.

    Attributes
    ----------
    path
        Path of the module in the repository.
    operator
        Name of cosmic-ray's operator.
    occurrence
        Number of the operator's place in the module, from 0.
    """

    area: str
    path: str
    operator: str
    occurrence: int
    line: int
    column: int

    def applied(self, source: str) -> str:
        """Return the changed module."""
        operator = OperatorProvider()[self.operator]()
        changed: str | None = mutate_code(source, operator, self.occurrence)
        if changed is None:
            raise ValueError(f"{self.path} has no place {self.occurrence} for {self.operator}")
        return changed


class Module:
    """Lines of a module, as its syntax tree has them."""

    def __init__(self, source: str) -> None:
        self._source = source
        self._tree = ast.parse(source)

    @cached_property
    def _left_out(self) -> list[tuple[Position, Position]]:
        """Begin and end of what is not mutated."""
        return [*map(_span, _unmutated(self._tree)), *_marks_of_keywords(self._tree)]

    def is_mutated(self, place: Position) -> bool:
        """Return whether a place is none of those that are left out."""
        return not any(begin <= place < end for begin, end in self._left_out)

    def statement(self, line: int) -> ast.stmt:
        """Return the innermost statement that has a line."""
        found = [
            node
            for node in ast.walk(self._tree)
            if isinstance(node, ast.stmt) and node.lineno <= line <= (node.end_lineno or 0)
        ]
        return max(found, key=lambda node: (node.lineno, -(node.end_lineno or 0)))

    def lines_of(self, line: int) -> range:
        """Return the lines that run when what is on a line runs.

        These are the lines of its statement, without the body of a compound one. For the defaults
        of a function's parameters the body is taken too.
        """
        node = self.statement(line)
        body: list[ast.stmt] = getattr(node, "body", [])
        if body and not isinstance(node, ast.FunctionDef):
            return range(node.lineno, max(body[0].lineno, node.lineno + 1))
        return range(node.lineno, (node.end_lineno or node.lineno) + 1)

    def runs_at_import(self, line: int) -> bool:
        """Return whether a line is outside all functions."""
        return not any(
            isinstance(node, FUNCTIONS) and node.lineno <= line <= (node.end_lineno or 0)
            for node in ast.walk(self._tree)
        )

    def names_given_at(self, line: int) -> frozenset[str]:
        """Return the names that what is on a line gives a value.

        These are the names that its statement assigns to; inside a function, that of the function.
        """
        functions = [
            node.name
            for node in ast.walk(self._tree)
            if isinstance(node, FUNCTIONS) and node.lineno <= line <= (node.end_lineno or 0)
        ]
        return frozenset(functions[:1]) if functions else _given(self.statement(line))

    def names_made_of(self, names: AbstractSet[str]) -> frozenset[str]:
        """Return some names, and those that statements outside functions give a value with them."""
        return _closure(names, [each for each in self._definitions if not each.is_function])

    def functions_with(self, names: AbstractSet[str]) -> frozenset[str]:
        """Return the functions that have some names in them, or what is made of them.

        A word of a text is a name too, and so is a keyword.
        """
        known = _closure(names, self._definitions)
        return frozenset(
            name for each in self._definitions if each.is_function for name in each.gives & known
        )

    def lines_that_use(self, names: AbstractSet[str]) -> set[int]:
        """Return the lines inside functions with one of some names, or attributes.

        A default of a parameter is used by the whole function.
        """
        found: set[int] = set()
        for function in ast.walk(self._tree):
            if isinstance(function, FUNCTIONS):
                found |= set(_lines_with(function, names))
                if any(_lines_with(function.args, names)):
                    found |= set(range(function.lineno, (function.end_lineno or 0) + 1))
        return found

    def imports(self, module: str) -> bool:
        """Return whether a module, or something in it, is imported by its full name."""
        return module in self._imported

    @cached_property
    def _imported(self) -> set[str]:
        names: set[str] = set()
        for node in ast.walk(self._tree):
            if isinstance(node, ast.ImportFrom) and node.module:
                names |= {node.module, *(f"{node.module}.{each.name}" for each in node.names)}
            elif isinstance(node, ast.Import):
                names |= {each.name for each in node.names}
        return names

    @cached_property
    def _definitions(self) -> list[_Definition]:
        """The statements of the module and of its classes, without the classes themselves."""
        bodies = [node.body for node in self._tree.body if isinstance(node, ast.ClassDef)]
        return [
            _Definition(_given(node), frozenset(_words(node)), isinstance(node, FUNCTIONS))
            for body in (self._tree.body, *bodies)
            for node in body
            if not isinstance(node, ast.ClassDef)
        ]


@dataclass(frozen=True)
class _Definition:
    """A statement outside functions, or a function: what it gives a value, and all its words."""

    gives: frozenset[str]
    words: frozenset[str]
    is_function: bool


def _closure(names: AbstractSet[str], definitions: Sequence[_Definition]) -> frozenset[str]:
    """Return some names, and those of the definitions that are made of them."""
    known = frozenset(names)
    while made := [each for each in definitions if each.words & known and not each.gives <= known]:
        known = known.union(*(each.gives for each in made))
    return known


def _given(statement: ast.stmt) -> frozenset[str]:
    """Return the name of a function, or the names that a statement assigns to."""
    if isinstance(statement, FUNCTIONS):
        return frozenset({statement.name})
    return frozenset(
        node.id
        for node in ast.walk(statement)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    )


def _lines_with(root: ast.AST, names: AbstractSet[str]) -> Iterator[int]:
    for node in ast.walk(root):
        if (isinstance(node, ast.Name) and node.id in names) or (
            isinstance(node, ast.Attribute) and node.attr in names
        ):
            yield node.lineno


def _words(statement: ast.stmt) -> Iterator[str]:
    """Yield the names, attributes, parameters and keywords of a statement, and words of texts."""
    for node in ast.walk(statement):
        if isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, ast.arg | ast.keyword) and node.arg:
            yield node.arg
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield from WORD.findall(node.value)


def _span(node: ast.AST) -> tuple[Position, Position]:
    found: Any = node
    return (found.lineno, found.col_offset), (found.end_lineno, found.end_col_offset)


def _unmutated(tree: ast.Module) -> Iterator[ast.AST]:
    """Yield types, decorators, texts, errors and assertions, and unions of types."""
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr | ast.Raise | ast.Assert):
            yield node
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield from node.decorator_list
        if isinstance(node, FUNCTIONS) and node.returns is not None:
            yield node.returns
        if isinstance(node, ast.AnnAssign | ast.arg) and node.annotation is not None:
            yield node.annotation
        if isinstance(node, ast.BinOp) and _is_union(node):
            yield node


def _marks_of_keywords(tree: ast.Module) -> Iterator[tuple[Position, Position]]:
    """Yield where a signature has a star before named parameters: it multiplies nothing."""
    for node in ast.walk(tree):
        if not isinstance(node, FUNCTIONS) or not node.args.kwonlyargs or node.args.vararg:
            continue
        signature = node.args
        before = [*signature.posonlyargs, *signature.args, *signature.defaults]
        begin = max((_span(each)[1] for each in before), default=(node.lineno, node.col_offset))
        yield begin, _span(signature.kwonlyargs[0])[0]


def _is_union(node: ast.expr) -> bool:
    """Return whether an expression is a union of types, by how its names are written."""
    if isinstance(node, ast.BinOp):
        sides = (node.left, node.right)
        return isinstance(node.op, ast.BitOr) and any(_is_union(side) for side in sides)
    if isinstance(node, ast.Subscript):
        return _is_union(node.value)
    name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
    is_class = name[:1].isupper() and not name.isupper()
    return is_class or name in TYPES or (isinstance(node, ast.Constant) and node.value is None)


def places(source: str) -> Mapping[Position, Sequence[tuple[str, int]]]:
    """Return the places of a module that are mutated, with operators and their occurrences."""
    module, operators = Module(source), _operators()
    seen: Counter[str] = Counter()
    found: defaultdict[Position, list[tuple[str, int]]] = defaultdict(list)
    for node in ast_nodes(get_ast(source)):
        for name, operator in operators.items():
            for begin, _ in operator.mutation_positions(node):
                if module.is_mutated(begin):
                    found[begin].append((name, seen[name]))
                seen[name] += 1
    return found


def draw(root: Path, seed: int, count: int) -> list[Mutant]:
    """Return mutants in an order by chance, each area as often as the others.

    A place is drawn first, each as likely as the others of its area, and then one of the changes
    that can be made there. No place is drawn twice.
    """
    drawn = []
    for index, (area, folders) in enumerate(AREAS.items()):
        share = count // len(AREAS) + (index < count % len(AREAS))
        drawn += _drawn_from(root, area, folders, Random(f"{seed}/{area}"), share)
    Random(seed).shuffle(drawn)
    return drawn


def _drawn_from(
    root: Path, area: str, folders: Sequence[str], random: Random, count: int
) -> list[Mutant]:
    sources = {
        path: (root / path).read_text(encoding="utf-8") for path in module_paths(root, folders)
    }
    found = {path: places(source) for path, source in sources.items()}
    order = [(path, place) for path in found for place in found[path]]
    random.shuffle(order)
    drawn: list[Mutant] = []
    for path, place in order:
        if len(drawn) == count:
            break
        mutant = Mutant(area, path, *random.choice(found[path][place]), *place)
        if _compiles(mutant.applied(sources[path])):
            drawn.append(mutant)
    return drawn


def _compiles(source: str) -> bool:
    try:
        ast.parse(source)
    except SyntaxError:
        return False
    return True


def module_paths(root: Path, folders: Sequence[str]) -> list[str]:
    """Return the paths of the modules in folders of a repository."""
    return sorted(
        path.relative_to(root).as_posix()
        for folder in folders
        for path in ([root / folder] if folder.endswith(".py") else (root / folder).rglob("*.py"))
    )
