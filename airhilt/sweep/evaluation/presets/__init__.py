"""The presets of evaluations: one file a preset, each with its `PRESET`.

One of another package is found by an entry point of the group ``airhilt.presets``.
"""

from airhilt.plugins import Family
from airhilt.sweep.evaluation.preset import Preset

FAMILY = Family("preset", "airhilt.presets", __name__, "PRESET", Preset)
