"""Sections of a page: each has a template, and a script where one is needed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic.dataclasses import dataclass

from airhilt.errors import AirhiltError
from airhilt.plugins import Family


@dataclass(frozen=True)
class PageSection:
    """One section of a page."""

    name: str
    """Name of its module or entry point; its data is found by it."""
    order: int
    """Place among the sections of the page, or of the section that it stands in."""
    module: str
    """``__file__`` of its module: the template and the script have its name."""
    within: str = ""
    """Name of the section that it stands in."""

    def template(self) -> str:
        """Return the Jinja template."""
        return Path(self.module).with_suffix(".html").read_text("utf-8")

    def script(self) -> str:
        """Return the script, empty if there is none."""
        path = Path(self.module).with_suffix(".js")
        return path.read_text("utf-8") if path.is_file() else ""


def cannot_be_shown(section: str, error: Exception) -> str:
    """Return a sentence on why a section of that name is not on the page."""
    known = isinstance(error, AirhiltError | OSError)
    cause = str(error) if known else f"{type(error).__name__}: {error}"
    return f"The section {section!r} cannot be shown: {cause}"


def load_member(family: Family, name: str) -> Any:
    """Return a section whose template and script can be read.

    It raises `AirhiltError` if it cannot be loaded, or stands in no section, or they cannot be
    read.
    """
    section: PageSection = family.load(name)
    if section.within and section.within not in family.names():
        raise AirhiltError(f"there is no section {section.within!r} that it stands in")
    try:
        section.template(), section.script()
    except (OSError, ValueError, TypeError) as error:
        raise AirhiltError(f"{type(error).__name__}: {error}") from error
    return section


def load_members(family: Family) -> tuple[list[Any], list[str]]:
    """Return all sections of a page in their order, and a sentence on each that cannot be shown."""
    sections: list[PageSection] = []
    problems: list[str] = []
    for name in family.names():
        try:
            sections.append(load_member(family, name))
        except AirhiltError as error:
            problems.append(cannot_be_shown(name, error))
    return sorted(sections, key=lambda section: (section.order, section.name)), problems
