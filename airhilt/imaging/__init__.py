"""Pictures in numbers: boxes, pinhole cameras, lenses, masks."""
