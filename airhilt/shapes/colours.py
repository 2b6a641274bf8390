"""Colours that several bodies share, as linear RGB reflectances."""

from airhilt.shapes.mesh import srgb

WHITE = srgb(238, 240, 243)
SILVER = srgb(178, 184, 190)
GREY = srgb(120, 126, 132)
DARK = srgb(38, 42, 48)
BLACK = srgb(24, 24, 26)
GLASS = srgb(26, 34, 44)
TYRE = srgb(30, 30, 32)
YELLOW = srgb(246, 200, 30)
RED = srgb(196, 26, 30)
LIME = srgb(190, 214, 40)
ORANGE = srgb(240, 120, 20)
AMBER = srgb(255, 170, 30)
