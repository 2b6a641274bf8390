"""Figures by matplotlib: in a page, where they follow its colours, and as files for a paper.

The files are SVG and PDF with text as text; the same data gives the same bytes.
"""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from airhilt.errors import AirhiltError
from airhilt.host.files import make_folder, replace_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

INK, DIM, GRID, PANEL = "#181c21", "#545d67", "#e1e5e9", "#fefeff"
COLOURS = (
    "#005fa8", "#b5440c", "#00704f", "#8d3a7c", "#735b00", "#006b7d", "#a0263f", "#5a52b8",
)  # fmt: skip
"""Colours of up to eight series, as on all pages; from there on they begin again."""
MARKERS = "osD^vPX*<>hp"
"""Marks of the series, which tell them apart without colour."""
CSS = {INK: "--ink", DIM: "--dim", GRID: "--grid", PANEL: "--panel"} | {
    colour: f"--c{index}" for index, colour in enumerate(COLOURS)
}
"""Variables of the page that a figure in it takes its colours from."""
STYLE: Any = {
    "text.parse_math": False,
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.edgecolor": DIM,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.linewidth": 0.8,
    "axes.grid": False,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "text.color": INK,
    "xtick.color": DIM,
    "ytick.color": DIM,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "figure.facecolor": "none",
    "axes.facecolor": "none",
    "savefig.facecolor": "none",
    "lines.linewidth": 1.8,
    "hatch.color": DIM,
}
LONGEST_NAME = 100
"""Greatest number of characters of a name, which is that of files."""
PROLOGUE = re.compile(r"^.*?(?=<svg )", re.DOTALL)
METADATA = re.compile(r"\s*<metadata>.*?</metadata>", re.DOTALL)
IDENTITY = re.compile(r'(\bid="|url\(#|href="#)')
COLOUR = re.compile("|".join(CSS))


class Figures:
    """The figures of one page; `drawn` is told their number after each."""

    def __init__(self, drawn: Callable[[int], None] = lambda _: None) -> None:
        self.markup: dict[str, str] = {}
        """Each figure by its name, as it stands in the page."""
        self._files: dict[str, bytes] = {}
        self._drawn = drawn

    def name_for(self, *words: str) -> str:
        """Return a name that no figure has yet: of letters, digits and underscores."""
        text = "_".join(words).lower()[:LONGEST_NAME]
        name = "".join(each if each.isascii() and each.isalnum() else "_" for each in text)
        count = sum(each == name or each.startswith(f"{name}__") for each in self.markup)
        return f"{name}__{count + 1}" if count else name

    @contextmanager
    def drawing(self, name: str, width_in: float, height_in: float) -> Iterator[Figure]:
        """Yield an empty figure, and keep it under its name once it has been drawn."""
        # Not at the top: it takes a second, and most commands draw nothing.
        import matplotlib as mpl
        from matplotlib.figure import Figure

        with mpl.rc_context({**STYLE, "svg.hashsalt": name}), warnings.catch_warnings():
            # Names may have characters that the font lacks; a browser has other fonts.
            warnings.filterwarnings("ignore", message="Glyph .* missing")
            figure = Figure(figsize=(width_in, height_in), layout="constrained")
            yield figure
            svg = _saved(figure, "svg", {"Date": None, "Creator": None})
            figure.set_layout_engine("none")  # The second file has the layout of the first.
            none = {"CreationDate": None, "Creator": None, "Producer": None}
            self._files[f"{name}.pdf"] = _saved(figure, "pdf", none)
        self._files[f"{name}.svg"] = svg
        self.markup[name] = embedded(svg.decode(), name)
        self._drawn(len(self.markup))

    def write(self, folder: Path) -> None:
        """Write each figure into a folder, as SVG and as PDF; `AirhiltError` if one cannot be."""
        try:
            for name, data in self._files.items():
                make_folder(folder)
                replace_file(folder / name, data)
        except OSError as error:
            raise AirhiltError(f"{folder}: cannot be written: {error.strerror}") from None


def embedded(svg: str, name: str) -> str:
    """Return a figure as it stands in a page: with ids and colours that fit there."""
    text = METADATA.sub("", PROLOGUE.sub("", svg))
    text = IDENTITY.sub(lambda found: f"{found[1]}{name}-", text)
    return COLOUR.sub(lambda found: f"var({CSS[found[0]]})", text)


def _saved(figure: Figure, kind: str, metadata: dict[str, None]) -> bytes:
    stream = io.BytesIO()
    figure.savefig(stream, format=kind, metadata=metadata)
    return stream.getvalue()
