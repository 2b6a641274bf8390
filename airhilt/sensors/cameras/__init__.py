"""Cameras: the scene, what draws it, and what is true of each picture."""

AUTO = "auto"
"""Renderer: Open3D where it is installed, otherwise Embree."""
STILL_SAMPLES = 3
"""Samples along each side of a pixel of a background that is drawn once."""
UNSEEN_FIELDS = ("name", "title", "description", "radio")
"""Fields of a scenario that reach no picture; a scene stays open when no others change."""
