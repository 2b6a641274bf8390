"""Cameras: the scene, what draws it, and what is true of each picture."""

AUTO = "auto"
"""Renderer: Open3D where it is installed, otherwise Embree."""
