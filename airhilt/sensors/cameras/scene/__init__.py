"""The scene before the cameras: landscape, bodies, light and weather."""
