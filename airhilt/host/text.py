"""Text for people: counts, and what comes from outside, such as from a program or a file."""

from __future__ import annotations

MOST_CHARACTERS = 400
"""Greatest length of one text: a worker may write as much as it likes."""
LONGEST_LINE = 1000
"""Greatest length of a line that has a text in it."""
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


def readable(text: str, longest: int | None = MOST_CHARACTERS) -> str:
    """Return a text in one line, without characters that command a terminal, and not too long.

    Line ends and other white space become spaces. Control characters, such as the beginning of an
    ANSI escape sequence, and characters without a shape, such as those that turn the direction of
    writing (Unicode categories Cc, Cf, Cs, Co, Cn), become U+FFFD.

    Parameters
    ----------
    longest
        Greatest length; None: any.
    """
    if longest is not None and len(text) > longest:
        text = f"{text[: longest - 1]}…"
    if text.isprintable():
        return text
    return "".join(map(_readable, text))


def _readable(character: str) -> str:
    if character.isprintable():
        return character
    return " " if character.isspace() else REPLACEMENT


def counted(count: int, noun: str) -> str:
    """Return a count with its noun, such as ``1 run`` or ``2 runs``."""
    return f"{count} {noun}{'s' * (count != 1)}"
