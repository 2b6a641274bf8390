"""Cameras: the scene, what draws it, and what is true of each picture."""

AUTO = "auto"
"""Renderer: the same one whatever else is installed, so that machines draw alike."""
FASTEST = "fastest"
"""Renderer: the one that draws in the least time."""
STILL_SAMPLES = 3
"""Samples along each side of a pixel of a background that is drawn once."""
UNSEEN_FIELDS = ("name", "title", "description", "radio")
"""Fields of a scenario that reach no picture; a scene stays open when no others change."""
