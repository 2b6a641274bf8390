"""Draws an airport as a diagram, north up: SVG, or PNG where resvg-py is installed."""

from __future__ import annotations

from pathlib import Path

from airhilt.errors import ScenarioError
from airhilt.world.surface.chart.sheet import as_svg
from airhilt.world.surface.layout import Layout

__all__ = ["as_svg", "draw"]


def draw(layout: Layout, path: Path) -> Path:
    """Write the diagram of an airport; the name of the file says whether as SVG or PNG.

    Raises
    ------
    ScenarioError
        The name ends otherwise, the file cannot be written, or PNG is asked for and resvg-py is
        not installed.
    """
    document = as_svg(layout)
    if path.suffix.lower() == ".svg":
        content = document.encode()
    elif path.suffix.lower() == ".png":
        content = _as_png(document)
    else:
        raise ScenarioError(f"{path}: expected a name that ends in .svg or .png")
    try:
        path.write_bytes(content)
    except OSError as error:
        raise ScenarioError(f"{path}: cannot be written: {error.strerror}") from error
    return path


def _as_png(document: str) -> bytes:
    try:
        from resvg_py import svg_to_bytes
    except ImportError:
        raise ScenarioError(
            "PNG needs resvg-py: pip install 'airhilt[plot]', or write an .svg"
        ) from None
    return bytes(svg_to_bytes(svg_string=document, zoom=2.0))
