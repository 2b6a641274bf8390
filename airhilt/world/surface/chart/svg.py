"""Elements of an SVG document as text; every name in them is escaped."""

from __future__ import annotations

from collections.abc import Sequence
from xml.sax.saxutils import escape

from airhilt.world.surface.path import Local


def title(text: str) -> str:
    """Return the text that is shown when an element is pointed at."""
    return f"<title>{escape(text)}</title>"


def area(style: str, outline: Sequence[Local], name: str, more: str = "") -> str:
    """Return a polygon; ``more`` holds further attributes."""
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in outline)
    return f'<polygon class="{style}" points="{points}"{more}>{title(name)}</polygon>'


def line(style: str, ends: tuple[Local, Local], more: str = "", name: str = "") -> str:
    """Return a line; ``more`` holds further attributes."""
    a, b = ends
    start = (
        f'<line class="{style}" x1="{a[0]:.1f}" y1="{a[1]:.1f}" x2="{b[0]:.1f}" '
        f'y2="{b[1]:.1f}"{more}'
    )
    return f"{start}>{title(name)}</line>" if name else f"{start}/>"


def circle(style: str, at: Local, radius_px: float, name: str) -> str:
    """Return a circle."""
    return (
        f'<circle class="{style}" cx="{at[0]}" cy="{at[1]}" r="{radius_px:g}">'
        f"{title(name)}</circle>"
    )


def text(style: str, at: Local, words: str, turn_deg: float = 0.0, anchor: str = "middle") -> str:
    """Return a text about a point, turned clockwise."""
    turn = f' transform="rotate({turn_deg:.1f} {at[0]:.1f} {at[1]:.1f})"' if turn_deg else ""
    return (
        f'<text class="{style}" x="{at[0]:.1f}" y="{at[1]:.1f}" text-anchor="{anchor}" '
        f'dominant-baseline="central"{turn}>{escape(words)}</text>'
    )
