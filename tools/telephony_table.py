"""Compare the telephony designators of the project with those that the FAA publishes.

The page is "Three-Letter Designator / Aircraft Company / Telephony Decode" of FAA Order JO 7340.2
(chapter 3, section 3), saved as HTML from https://www.faa.gov/air_traffic/publications/. It is a
work of the United States Government.

    python tools/telephony_table.py PAGE.html
    python tools/telephony_table.py PAGE.html --add RPA,ENY --update

Without options, rows that differ are printed. ``--add`` adds operators by their designators, or
all that have a telephony designator (``--add all``). ``--update`` takes the telephony designators
of the page where they differ.
"""

from __future__ import annotations

import argparse
import csv
import re
from html.parser import HTMLParser
from pathlib import Path

TABLE = Path(__file__).parents[1] / "airhilt" / "phraseology" / "telephony.csv"
FIELDS = ("designator", "telephony", "operator")


class Page(HTMLParser):
    """Collects the rows of four cells: designator, company, country, telephony."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[list[str]] = []
        self._cells: list[str] = []
        self._is_cell = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Begin a row or a cell."""
        del attrs
        if tag == "tr":
            self._cells = []
        elif tag == "td":
            self._is_cell = True
            self._cells.append("")

    def handle_endtag(self, tag: str) -> None:
        """End a cell or a row."""
        if tag == "td":
            self._is_cell = False
        elif tag == "tr" and len(self._cells) == 4:
            self.rows.append([" ".join(cell.split()) for cell in self._cells])

    def handle_data(self, data: str) -> None:
        """Add text to a cell."""
        if self._is_cell:
            self._cells[-1] += data


def published(html: str) -> dict[str, dict[str, str]]:
    """Return the operators of the page that have a telephony designator, by designator."""
    page = Page()
    page.feed(html)
    return {
        designator: {
            "designator": designator,
            "telephony": re.sub(r"[^a-z0-9]+", " ", telephony.lower()).strip(),
            "operator": company.title(),
        }
        for designator, company, _, telephony in page.rows
        if re.fullmatch(r"[A-Z]{3}", designator) and telephony
    }


def main() -> None:
    """Compare, and write if asked to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("--add", default="", help="designators with commas, or all")
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    theirs = published(options.page.read_text(encoding="utf-8"))
    with TABLE.open(encoding="utf-8", newline="") as stream:
        ours = {row["designator"]: row for row in csv.DictReader(stream)}
    for designator in theirs if options.add == "all" else filter(None, options.add.split(",")):
        ours.setdefault(designator, theirs[designator])
    for designator, row in ours.items():
        said = theirs.get(designator, row)["telephony"]
        if said.replace(" ", "") != row["telephony"].replace(" ", ""):
            print(f"{designator}: {row['telephony']}; published: {said}")
            if options.update:
                row["telephony"] = said
    if options.add or options.update:
        with TABLE.open("w", encoding="utf-8", newline="") as stream:
            table = csv.DictWriter(stream, FIELDS, lineterminator="\n")
            table.writeheader()
            table.writerows(ours[designator] for designator in sorted(ours))


if __name__ == "__main__":
    main()
