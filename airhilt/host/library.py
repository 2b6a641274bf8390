"""Finds the aircraft, airports, scenarios and bridges that ship with AIRHILT.

In an installed wheel they lie in ``airhilt/library/``; in a source tree, at its top level.
"""

from __future__ import annotations

import difflib
from pathlib import Path

from airhilt.errors import ScenarioError

SHOWN_NAMES = 12
"""Number of known names that an error about an unknown one shows."""
KINDS = ("aircraft", "airports", "scenarios", "bridges")


def folder(kind: str) -> Path:
    """Return the folder that holds one of `KINDS`."""
    package = Path(__file__).resolve().parents[1]
    installed = package / "library" / kind
    return installed if installed.is_dir() else package.parent / kind


def names(kind: str) -> list[str]:
    """Return the names of all JSON files of a kind, sorted."""
    return sorted(path.stem for path in folder(kind).glob("*.json"))


def find(kind: str, name: str) -> Path:
    """Return the path of a named JSON file.

    Raises
    ------
    ScenarioError
        There is none of that name; the message gives the nearest.
    """
    known = names(kind)
    if name in known:
        return folder(kind) / f"{name}.json"
    raise ScenarioError(f"no {kind.removesuffix('s')} named {name!r}{nearest(name, known)}")


def nearest(name: str, known: list[str]) -> str:
    """Return a tail for an error message that helps with a misspelt name."""
    lowered = {candidate.lower(): candidate for candidate in known}
    close = difflib.get_close_matches(name.lower(), list(lowered), n=1)
    if close:
        return f"; did you mean {lowered[close[0]]!r}?"
    if not known:
        return "; none is known"
    more = f" and {len(known) - SHOWN_NAMES} more" if len(known) > SHOWN_NAMES else ""
    return f"; known: {', '.join(known[:SHOWN_NAMES])}{more}"
