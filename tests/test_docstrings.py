"""Docstrings begin with their subject."""

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


def fragments(source: str) -> Iterator[tuple[int, str]]:
    """Yield number and text of each line where a docstring or a description in it begins so."""
    for node in ast.walk(ast.parse(source)):
        if not isinstance(node, ast.Expr) or not isinstance(node.value, ast.Constant):
            continue
        text = node.value.value
        if not isinstance(text, str):
            continue
        indent = len(text)
        is_paragraph = True
        for number, line in enumerate(text.splitlines(), start=node.lineno):
            words = line.strip()
            begins = is_paragraph or len(line) - len(words) > indent
            if words and begins and FRAGMENT.match(words):
                yield number, words
            is_paragraph = not words
            indent = len(line) - len(words)


@pytest.mark.parametrize("folder", ["airhilt", "bridges", "tools"])
def test_docstrings_and_descriptions_begin_with_their_subject(folder: str) -> None:
    found = [
        f"{path.relative_to(REPOSITORY)}:{number}: {words}"
        for path in sorted((REPOSITORY / folder).rglob("*.py"))
        for number, words in fragments(path.read_text(encoding="utf-8"))
    ]
    assert not found, "name the subject first:\n" + "\n".join(found)


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
'''
    found = {words for _, words in fragments(source)}
    assert found == {"Of the rate.", "Of the track, in rad/s;"}
