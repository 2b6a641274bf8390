"""A section that shows one of many figures, chosen by what they differ in."""

from __future__ import annotations

from typing import Any

from airhilt.report.sweeps.data import SweepData

Json = dict[str, Any]

HERE = __file__
"""Module of the sections of figures: their template and script are those beside it."""
PX_PER_IN = 96.0


def figure_json(
    sweep: SweepData, name: str, caption: str, width_in: float, choice: dict[str, str]
) -> Json:
    """Return a figure as its section shows it, with the choices by which it differs from others."""
    folder = sweep.folder.figures_path
    return {
        "name": name,
        "caption": caption,
        "width_px": round(width_in * PX_PER_IN),
        "choice": choice,
        "svg": sweep.link_to(folder / f"{name}.svg"),
        "pdf": sweep.link_to(folder / f"{name}.pdf"),
    }


def section_json(name: str, heading: str, text: str, figures: list[Json]) -> Json | None:
    """Return the data of a section of figures, None if there are no figures."""
    if not figures:
        return None
    labels = list(figures[0]["choice"])
    return {
        "name": name,
        "heading": heading,
        "text": text,
        "figures": figures,
        "choices": [
            {"label": label, "values": list(dict.fromkeys(f["choice"][label] for f in figures))}
            for label in labels
        ],
    }
