"""The sections of a report: one Python module each, with its template and its script beside it.

A section ``radar`` is the module ``radar.py`` with its `SECTION`, the Jinja template ``radar.html``
and, if anything is to be drawn, the script ``radar.js``. One of another package is found by an
entry point of the group ``airhilt.report_sections`` that names the object.

The template sees `run`, the data that all sections share, `data`, the section's own data, and
`parts`, the markup of the sections within it. The script is the body of a function of `data`. It
may use everything in ``report/shared/*.js``, and returns what is drawn: `draw`, called once, and
`fit`, called again in a window of another width. Both may return a function of the time shown, in
s.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError
from pydantic.dataclasses import dataclass

from airhilt.errors import AirhiltError
from airhilt.plugins import Family
from airhilt.record import Logged, RunFolder
from airhilt.report.page_section import PageSection, cannot_be_shown

if TYPE_CHECKING:
    from airhilt.report.data import RunData

Json = dict[str, Any]


class Content:
    """The data of a section, gathered from one run folder and its log."""

    def __init__(self, folder: RunFolder) -> None:
        self.folder = folder

    def take(self, logged: Logged) -> None:
        """Receive the next message with one of the section's keys.

        After a ValidationError the page leaves the message out, and says so. Any other exception
        costs the section.
        """

    def as_json(self, run: RunData) -> Any:
        """Return the section's data, once the log has been read."""
        raise NotImplementedError


@dataclass(frozen=True)
class Section(PageSection):
    """One section of the page of a run."""

    content: Callable[[RunFolder], Content] | None = None
    """Makes the receiver of messages from the run folder; None if there is no data to receive."""
    keys: tuple[str, ...] = ()
    """Beginnings of the keys of the messages that the content receives."""


class GuardedContent:
    """The content of a section, whose failure costs that section alone.

    `is_whole` is false once the content has failed; `notes` say why.
    """

    def __init__(self, section: Section, folder: RunFolder) -> None:
        self.section = section
        self.is_whole = True
        self.notes: list[str] = []
        self._content: Content | None = None
        if section.content is not None:
            with self._guarding():
                self._content = section.content(folder)

    def take(self, logged: Logged) -> None:
        """Hand a message to the content; ValidationError if it is of another version."""
        if self._content is not None:
            with self._guarding(ValidationError):
                self._content.take(logged)

    def as_json(self, run: RunData) -> Any:
        """Return the section's data, None if it failed or JSON cannot hold it."""
        if self._content is not None:
            with self._guarding():
                data = self._content.as_json(run)
                json.dumps(data, allow_nan=False)
                return data
        return None

    @contextmanager
    def _guarding(self, *passing: type[Exception]) -> Iterator[None]:
        """Give the content up after an exception, unless that may pass."""
        try:
            yield
        except passing:
            raise
        except Exception as error:
            self.notes.append(cannot_be_shown(self.section.name, error))
            self.is_whole = False
            self._content = None


FAMILY = Family(
    "report section", "airhilt.report_sections", __name__, "SECTION", Section, AirhiltError
)
