"""Docstrings and helps begin with their subject, and functions fit on a page."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[1]
FRAGMENT = re.compile(
    r"(Of|That|Those|Which|Told|(At|By|For|From|In|Over|To) which)(?!\w)", re.IGNORECASE
)
"""First words of a text without a subject of its own."""
LONGEST = 50
"""Greatest number of lines of a function without its docstring."""


def fragments(source: str) -> Iterator[tuple[int, str]]:
    """Yield number and text of each line where a docstring, its description or a help begins so."""
    for node in ast.walk(ast.parse(source)):
        for begin, text in texts(node):
            indent = len(text)
            is_paragraph = True
            for number, line in enumerate(text.splitlines(), start=begin):
                words = line.strip()
                begins = is_paragraph or len(line) - len(words) > indent
                if words and begins and FRAGMENT.match(words):
                    yield number, words
                is_paragraph = not words
                indent = len(line) - len(words)


def texts(node: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield line and text of a docstring, or of the help of an option that a call declares."""
    found: list[ast.expr] = []
    if isinstance(node, ast.Expr):
        found = [node.value]
    elif isinstance(node, ast.Call):
        found = [each.value for each in node.keywords if each.arg == "help"]
        if isinstance(node.func, ast.Name) and node.func.id == "Flag":
            found += node.args[1:2]
    for each in found:
        if isinstance(each, ast.Constant) and isinstance(each.value, str):
            yield each.lineno, each.value


def lengths(source: str) -> Iterator[tuple[int, str, int]]:
    """Yield line, name and number of lines of each function, without its docstring."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            first = node.body[0]
            is_documented = ast.get_docstring(node) is not None
            skipped = extent(first) if is_documented else 0
            yield node.lineno, node.name, extent(node) - skipped


def extent(node: ast.stmt) -> int:
    return (node.end_lineno or node.lineno) - node.lineno + 1


def sources(folder: str) -> Iterator[tuple[Path, str]]:
    """Yield path and text of each module in a folder of the repository."""
    for path in sorted((REPOSITORY / folder).rglob("*.py")):
        yield path.relative_to(REPOSITORY), path.read_text(encoding="utf-8")


@pytest.mark.parametrize("folder", ["airhilt", "bridges", "examples", "tests", "tools"])
def test_docstrings_descriptions_and_helps_begin_with_their_subject(folder: str) -> None:
    found = [
        f"{path}:{number}: {words}"
        for path, source in sources(folder)
        for number, words in fragments(source)
    ]
    assert not found, "name the subject first:\n" + "\n".join(found)


@pytest.mark.parametrize("folder", ["airhilt", "bridges", "examples", "tools"])
def test_functions_fit_on_a_page(folder: str) -> None:
    found = [
        f"{path}:{number}: {name} has {lines} lines"
        for path, source in sources(folder)
        for number, name, lines in lengths(source)
        if lines > LONGEST
    ]
    assert not found, f"split what is longer than {LONGEST} lines:\n" + "\n".join(found)


def test_the_length_of_a_function_is_counted_without_its_docstring() -> None:
    source = '''
def turn(rate: float) -> float:
    """Turn.

    By the rate.
    """
    return (
        rate
    )
'''
    assert [found[1:] for found in lengths(source)] == [("turn", 4)]


def test_a_description_without_a_subject_is_found() -> None:
    source = '''
def turn(rate: float) -> None:
    """Turn.

    Parameters
    ----------
    rate
        Of the track, in rad/s;
        of the nose on the ground.
    """


LIMIT = 1.0
"""Of the rate."""
option("--rate", help="Which one.")
Flag("--seed", "Of the draws.", "N")
'''
    found = {words for _, words in fragments(source)}
    assert found == {"Of the rate.", "Of the track, in rad/s;", "Which one.", "Of the draws."}
