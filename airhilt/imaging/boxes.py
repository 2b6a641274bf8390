"""Boxes in pixels: left, top, right, bottom."""

from __future__ import annotations

from airhilt.messages import Box


def centre(box: Box) -> tuple[float, float]:
    """Return the middle of a box: column and row."""
    left, top, right, bottom = box
    return (left + right) / 2.0, (top + bottom) / 2.0


def sides(box: Box) -> tuple[float, float]:
    """Return width and height of a box, each at least a pixel."""
    left, top, right, bottom = box
    return max(right - left, 1.0), max(bottom - top, 1.0)


def size_px(box: Box) -> float:
    """Return the longest side of a box."""
    left, top, right, bottom = box
    return max(right - left, bottom - top)


def area(box: Box) -> float:
    """Return the area of a box in square pixels; 0 if it is empty."""
    left, top, right, bottom = box
    return max(right - left, 0.0) * max(bottom - top, 0.0)


def shared_area(one: Box, other: Box) -> float:
    """Return the area of what two boxes share."""
    return area(
        (
            max(one[0], other[0]),
            max(one[1], other[1]),
            min(one[2], other[2]),
            min(one[3], other[3]),
        )
    )


def overlap(one: Box, other: Box) -> float:
    """Return the intersection of two boxes over their union, from 0 to 1."""
    shared = shared_area(one, other)
    return shared / (area(one) + area(other) - shared) if shared else 0.0


def share_of_smaller(one: Box, other: Box) -> float:
    """Return how much of the smaller of two boxes lies in the other, from 0 to 1."""
    shared = shared_area(one, other)
    return shared / min(area(one), area(other)) if shared else 0.0


def moved(box: Box, columns: float, rows: float) -> Box:
    """Return a box further to the right and down."""
    left, top, right, bottom = box
    return left + columns, top + rows, right + columns, bottom + rows


def within(box: Box, columns: float, rows: float) -> Box:
    """Return what of a box lies in a picture of some size; it may be empty."""
    left, top, right, bottom = box
    return (
        min(max(left, 0.0), columns),
        min(max(top, 0.0), rows),
        min(max(right, 0.0), columns),
        min(max(bottom, 0.0), rows),
    )
