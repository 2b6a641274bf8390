"""Assembles a page from its sections, with Jinja: one HTML file that opens offline.

Texts of a scenario or a worker may be hostile. They are only ever data: Jinja escapes them in a
template, nothing in the JSON of the page ends its script element, and scripts show them as text.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from airhilt.errors import RunFolderError
from airhilt.host.files import replace_file
from airhilt.host.text import readable
from airhilt.report.page_section import PageSection

if TYPE_CHECKING:
    from jinja2 import Environment

Json = dict[str, Any]

END_OF_SCRIPT = re.compile(r"</(?=script)|<(?=!--)", re.IGNORECASE)
"""Text that would end a script element, or begin a comment in it."""


class Assembly:
    """Puts the markup, scripts and data of the sections into one document.

    Parameters
    ----------
    name
        Name under which templates find the data that all sections share; the id of its element.
    shared
        Scripts in ``report/shared`` that all sections may use; later ones build on earlier ones.
    data
        The data; that of each section is in ``sections``, by name. What cannot be shown is added to
        its ``notes``.
    figures
        Markup of figures by name, for templates only.
    """

    def __init__(
        self,
        name: str,
        title: str,
        shared: Sequence[str],
        sections: Sequence[PageSection],
        data: Json,
        figures: Mapping[str, str] | None = None,
    ) -> None:
        # Not at the top: a run is simulated without it.
        from jinja2 import Environment, StrictUndefined

        self._name = name
        self._title = title
        self._shared = shared
        self._sections = sections
        self._data: Json = _readable(data)
        self._figures = figures or {}
        self._failed: set[str] = set()
        self._environment: Environment = Environment(
            autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
        )

    def page(self) -> str:
        """Return the document."""
        outer = [self._markup(one) for one in self._sections if not one.within]
        return self._environment.from_string(_own_file("page.html")).render(
            name=self._name,
            title=self._title,
            style=_own_file("page.css"),
            sections=outer,
            data=embeddable(self._data),
            scripts=self._scripts(),
        )

    def _markup(self, section: PageSection) -> str:
        """Return the markup of a section; one that fails is noted and left out."""
        parts = [self._markup(one) for one in self._sections if one.within == section.name]
        try:
            return self._environment.from_string(section.template()).render(
                {self._name: self._data},
                data=self._data["sections"].get(section.name),
                figures=self._figures,
                parts=parts,
            )
        except Exception as error:
            self._failed.add(section.name)
            self._data["notes"].append(
                readable(
                    f"The template of section {section.name!r} cannot be shown: "
                    f"{type(error).__name__}: {error}"
                )
            )
            return ""

    def _scripts(self) -> list[Json]:
        shared = [("", _own_file(f"shared/{name}.js")) for name in self._shared]
        own = [
            (section.name, f"page.section({json.dumps(section.name)}, (data) => {{\n{script}}});\n")
            for section in self._sections
            if section.name not in self._failed and (script := section.script())
        ]
        scripts = [*shared, *own, ("", "page.begin();\n")]
        return [{"section": section, "text": inline(script)} for section, script in scripts]


def write_page(page: Path, html: str) -> None:
    """Write a page, all or nothing; `RunFolderError` if it cannot be written."""
    try:
        replace_file(page, f"{html}\n".encode())
    except OSError as error:
        raise RunFolderError(f"{page}: cannot be written: {error.strerror}") from None


def _own_file(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text("utf-8")


def inline(script: str) -> str:
    """Return a script in which no text can end the element that it lies in."""
    return END_OF_SCRIPT.sub(lambda found: found[0][0] + "\\" + found[0][1:], script)


def _readable(data: Any) -> Any:
    match data:
        case str():
            return "\n".join(readable(line, longest=None) for line in data.split("\n"))
        case dict():
            return {_readable(key): _readable(value) for key, value in data.items()}
        case list() | tuple():
            return [_readable(value) for value in data]
    return data


def embeddable(data: Json) -> str:
    """Return data as JSON in which no text can end the script element that it lies in."""
    text = json.dumps(data, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
