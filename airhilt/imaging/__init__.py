"""Pictures in numbers: boxes, pinhole cameras, lenses, masks."""

SMALLEST_SIDE_PX = 16
GREATEST_SIDE_PX = 4096
"""Limits of the width and the height of a picture, in pixels."""
