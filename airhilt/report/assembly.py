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
from types import MappingProxyType
from typing import Any

from airhilt.errors import RunFolderError
from airhilt.host.files import replace_file
from airhilt.host.text import readable
from airhilt.report.page_section import PageSection

Json = dict[str, Any]

END_OF_SCRIPT = re.compile(r"</(?=script)|<(?=!--)", re.IGNORECASE)
"""Text that would end a script element, or begin a comment in it."""


def assemble(
    name: str,
    title: str,
    shared: Sequence[str],
    sections: Sequence[PageSection],
    data: Json,
    figures: Mapping[str, str] = MappingProxyType({}),
) -> str:
    """Return a document of the markup, scripts and data of some sections.

    Templates find the data that all sections share under the name. `shared` are scripts in
    ``report/shared`` that all sections may use; later ones build on earlier ones. The data of each
    section is in ``sections``, by name; what cannot be shown is added to ``notes``. `figures` has
    markup by name, for templates only.
    """
    # Not at the top: a run is simulated without it.
    from jinja2 import Environment, StrictUndefined

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    whole: Json = _readable(data)
    failed = set()

    def markup(section: PageSection) -> str:
        parts = [markup(one) for one in sections if one.within == section.name]
        own = whole["sections"].get(section.name)
        try:
            template = environment.from_string(section.template())
            return template.render({name: whole}, data=own, figures=figures, parts=parts)
        except Exception as error:
            failed.add(section.name)
            problem = f"{type(error).__name__}: {error}"
            whole["notes"].append(
                readable(f"The template of section {section.name!r} cannot be shown: {problem}")
            )
            return ""

    outer = [markup(one) for one in sections if not one.within]
    # The script of a section has a scope and an element of its own.
    together = "".join(_own_file(f"shared/{one}.js") for one in shared)
    scripts = [("", f'"use strict";\n{together}')]
    scripts += [
        (one.name, f"page.section({json.dumps(one.name)}, (data) => {{\n{script}}});\n")
        for one in sections
        if one.name not in failed and (script := one.script())
    ]
    scripts.append(("", "page.begin();\n"))
    return environment.from_string(_own_file("page.html")).render(
        name=name,
        title=title,
        style=_own_file("page.css"),
        sections=outer,
        data=embeddable(whole),
        scripts=[{"section": section, "text": inline(script)} for section, script in scripts],
    )


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
