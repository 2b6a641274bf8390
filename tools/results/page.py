"""The page and those of its sections, from their texts and from what is in the work folder.

A section has a page for each text that is called like it, such as ``full.md`` and
``full_costs.md``. A text has placeholders in braces. ``{table paper.comparison}`` and
``{figure full.averted}`` stand on a line of their own; ``{paper.seeds}`` is a fact of a section,
and ``{paper.comparison.time to first warning, s.mean}`` the cell of a table: section, table, first
cells of the row, column.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from airhilt.errors import AirhiltError
from airhilt.host.files import make_folder, replace_file
from airhilt.report.evaluation import scatter
from airhilt.report.figures import Figures
from airhilt.sweep.evaluation.tables import Cell, Quantity, Table
from results.record import Code, Record, read
from results.sections import Section

TEXTS = Path(__file__).parent
PLACEHOLDER = re.compile(r"\{([^{}]+)\}")
TABLE_PLACEHOLDER = re.compile(r"\{table \w+\.(\w+)\}")
IMAGES = "images/results"
"""Folder of the figures, from that of the page."""
MAIN = "results"
"""Name of the page that leads to the others."""
FOOT = (
    f"[Results]({MAIN}.md) has the commit of these numbers, how to read them, and the other "
    "sections. All tables are made, and for looking things up."
)
"""Last words of the page of a section."""
SHORT = 8
"""Number of characters of a commit in the text."""


@dataclass(frozen=True)
class Page:
    """The page of what is in a work folder.

    Attributes
    ----------
    code
        Code that the numbers of the page are of; None: there is no number yet.
    shows_dirty
        True if sections of other code, and of uncommitted changes, are shown too.
    """

    sections: Sequence[Section]
    records: Mapping[str, Record | None]
    code: Code | None
    shows_dirty: bool
    figures: Figures = field(default_factory=Figures)

    @classmethod
    def of(cls, sections: Sequence[Section], work: Path, shows_dirty: bool) -> Page:
        """Return the page; its code is that of the section that was made last."""
        records = {each.name: read(work / each.name) for each in sections}
        codes = [one.code for one in records.values() if one]
        shown = [code for code in codes if shows_dirty or not code.is_dirty]
        code = max(shown, key=lambda code: code.made, default=None)
        return cls(sections, records, code, shows_dirty)

    def texts(self, folder: Path = TEXTS) -> dict[str, str]:
        """Return the pages as Markdown, by the names of their texts; the main one is `MAIN`.

        Figures are drawn into `figures`.

        Raises
        ------
        AirhiltError
            A placeholder names nothing.
        """
        main = [self._text(folder, name) for name in ("introduction", "rows")]
        texts = {MAIN: "\n\n".join(main) + "\n"}
        for section in self.sections:
            more = sorted(path.stem for path in folder.glob(f"{section.name}_*.md"))
            for name in (section.name, *more):
                texts[name] = f"{self._text(folder, name, section.name)}\n\n{FOOT}\n"
        return texts

    def _text(self, folder: Path, name: str, section: str = "") -> str:
        """Return a text with its numbers, or with the reason why its section has none."""
        text = (folder / f"{name}.md").read_text(encoding="utf-8").strip()
        missing = self._missing(section)
        if missing:
            return _without_body(section, text, missing)
        filled, record = self._filled(name, text), self.records.get(section)
        if record is None:
            return filled
        noted = _with_notes_once(filled, record.tables.values())
        return f"{noted}\n\n{_origin(record.code)}" if self._is_draft else noted

    def write(self, path: Path, folder: Path = TEXTS) -> None:
        """Write the page, those of the sections beside it, and their figures."""
        texts, images = self.texts(folder), path.parent / IMAGES
        make_folder(images.parent)
        shutil.rmtree(images, ignore_errors=True)
        self.figures.write(images)
        for pdf in images.glob("*.pdf"):
            pdf.unlink()
        for old in path.parent.glob(file_name("*")):
            old.unlink()
        for name, text in texts.items():
            replace_file(path if name == MAIN else path.parent / file_name(name), text.encode())

    def _missing(self, section: str) -> str:
        """Return why a section is not shown, empty if it is."""
        if section not in self.records:
            return ""
        record = self.records[section]
        if record is None:
            return "its runs are not made"
        if self.shows_dirty:
            return ""
        if record.code.is_dirty:
            return "its runs are of changes that were not committed"
        if self.code and record.code.commit != self.code.commit:
            return f"its runs are of another commit, {record.code.commit[:SHORT]}"
        return ""

    def _filled(self, name: str, text: str) -> str:
        """Return a text with its placeholders filled."""

        def fill(found: re.Match[str]) -> str:
            value = self._value(found[1])
            if value is None:
                where = f"tools/results/{name}.md"
                raise AirhiltError(f"{where}: {found[0]} names nothing in the work folder")
            return value

        return PLACEHOLDER.sub(fill, text)

    def _value(self, placeholder: str) -> str | None:
        """Return what stands in place of a placeholder; None if it names nothing."""
        own = {"commit": self._commit, "overview": self._overview, "rows": self._rows}
        if placeholder in own:
            return own[placeholder]()
        word, _, rest = placeholder.partition(" ")
        if word in ("table", "figure") and rest:
            section, _, name = rest.partition(".")
            return (self._table if word == "table" else self._figure)(section, name)
        return self._number(placeholder)

    @property
    def _is_draft(self) -> bool:
        """True if the numbers that are shown are not of one commit."""
        codes = [record.code for record in self.records.values() if record]
        several = len({code.commit for code in codes}) > 1
        return self.shows_dirty and (several or any(code.is_dirty for code in codes))

    def _commit(self) -> str:
        if self.code is None:
            return "There are no numbers yet."
        if self._is_draft:
            return (
                "**This page is a draft**: its numbers are of several commits, or of changes that "
                "were not committed. Each section says of which code it is."
            )
        return f"All numbers are of commit `{self.code.commit}`."

    def _overview(self) -> str:
        rows: list[tuple[Cell, ...]] = []
        for each in self.sections:
            missing, record = self._missing(each.name), self.records[each.name]
            facts = record.facts if record and not missing else {}
            own = (facts.get(name, "-") for name in ("seeds", "cameras", "runs", "encounters"))
            rows.append((each.name, *own, f"missing: {missing}" if missing else "made"))
        columns = ("section", "seeds", "cameras", "runs", "encounters", "state")
        return _plain(Table(name="", title="", columns=columns, rows=tuple(rows)))

    def _rows(self) -> str:
        rows: list[tuple[Cell, ...]] = [
            (name, sweep, own["runs"], own["failed"], f"`{own['table_sha256']}`")
            for name, record in self.records.items()
            if record and not self._missing(name)
            for sweep, own in record.document.get("sweeps", {}).items()
        ]
        columns = ("section", "sweep", "runs", "failed", "SHA-256 of `sweep.parquet`")
        return _plain(Table(name="", title="", columns=columns, rows=tuple(rows)))

    def _table(self, section: str, name: str) -> str | None:
        record = self.records.get(section)
        table = record.tables.get(name) if record else None
        return table.markdown().strip() if table else None

    def _figure(self, section: str, name: str) -> str | None:
        record = self.records.get(section)
        table = record.tables.get(name) if record else None
        if table is None or table.figure is None:
            return None
        file = f"{section}_{name}"
        scatter.draw(self.figures, file, table.model_dump(mode="json"), on_panel=False)
        return f"![{table.figure.y} against {table.figure.x}]({IMAGES}/{file}.svg)"

    def _number(self, placeholder: str) -> str | None:
        section, _, rest = placeholder.partition(".")
        record = self.records.get(section)
        if record is None:
            return None
        name, _, cell = rest.partition(".")
        if not cell:
            return record.facts.get(name)
        row, _, column = cell.rpartition(".")
        table = record.tables.get(name)
        return _cell(table, row, column) if table else None


def file_name(name: str) -> str:
    """Return the file of the page that a text of a section becomes."""
    return f"{MAIN}-{name.replace('_', '-')}.md"


def _cell(table: Table, key: str, column: str) -> str | None:
    """Return the text of a cell; the key of its row is its first cells, with commas between."""
    found = [row for row in table.rows if _begins_with(row, key)]
    if len(found) != 1 or column not in table.columns:
        return None
    return _text(found[0][table.columns.index(column)])


def _begins_with(row: Sequence[Cell], key: str) -> bool:
    texts = [_text(cell) for cell in row]
    return any(", ".join(texts[:count]) == key for count in range(1, len(texts)))


def _text(cell: Cell) -> str:
    return cell.text if isinstance(cell, Quantity) else str(cell)


def _plain(table: Table) -> str:
    """Return a table without its title."""
    return table.markdown().partition("\n\n")[2].strip()


def _with_notes_once(text: str, tables: Iterable[Table]) -> str:
    """Return the text of a page; a note of several tables stays under the first of them."""
    notes = {note for table in tables for note in table.notes}
    kept: list[str] = []
    for paragraph in text.split("\n\n"):
        if paragraph not in notes or paragraph not in kept:
            kept.append(paragraph)
    return "\n\n".join(kept)


def _without_body(name: str, text: str, missing: str) -> str:
    """Return the heading of a section, with the tables that are missing and the reason."""
    heading = text.partition("\n")[0]
    tables = ", ".join(f"`{table}`" for table in TABLE_PLACEHOLDER.findall(text))
    reason = f"{missing[0].upper()}{missing[1:]}: `python tools/make_results.py --only {name}`"
    return f"{heading}\n\n**Missing: {tables}.** {reason}."


def _origin(code: Code) -> str:
    changes = " with changes that were not committed" if code.is_dirty else ""
    return f"This section is of commit `{code.commit}`{changes}."
