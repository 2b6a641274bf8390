"""The first warning: what it is counted from, and what the time to it consists of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section


class FirstWarning(Content):
    """Event that begins the conflict, in words; null where the scenario does not say."""

    def as_json(self, run: RunData) -> dict[str, Any]:
        """Return the event that begins the conflict."""
        conflict = run.info.scenario.get("conflict") or {}
        begins = conflict.get("begins") or conflict.get("opens_when")
        return {"begins": None if begins is None else condition_text(begins)}


def condition_text(condition: Mapping[str, Any]) -> str:
    """Return a condition of a scenario by its type and values, such as ``on runway: OPS1, 01``."""
    values = [text for name, value in condition.items() if name != "type" for text in _texts(value)]
    return f"{condition['type'].replace('_', ' ')}: {', '.join(values)}"


def _texts(value: Any) -> Iterator[str]:
    match value:
        case None:
            pass
        case dict():
            yield f"({', '.join(text for part in value.values() for text in _texts(part))})"
        case list():
            for part in value:
                yield from _texts(part)
        case float():
            yield f"{value:g}"
        case _:
            yield str(value)


SECTION = Section("warning", order=25, module=__file__, content=FirstWarning)
