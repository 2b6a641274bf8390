"""Channels of the aeronautical VHF band.

ICAO Annex 10 volume V, table 4-1 bis: within each 25 kHz, the channel with that spacing keeps the
frequency as its name (118.000), and the three with 8.33 kHz are named 5, 10 and 15 kHz above it
(118.005, 118.010, 118.015). No channel name ends in 20, 45, 70 or 95.
"""

from __future__ import annotations

from airhilt.errors import ScenarioError

LOWEST_KHZ = 118_000
"""First name of a channel, in kHz."""
HIGHEST_KHZ = 136_990
"""Last name of a channel below 137 MHz, the end of the band (ICAO Annex 10 volume V, 4.1.2)."""
BLOCK_KHZ = 25
"""Spacing of the wide channels, in kHz."""
NARROW_KHZ = frozenset({5, 10, 15})
"""Names of the 8.33 kHz channels within 25 kHz, above the wide one's name."""


def channel_spacing_khz(frequency_khz: int) -> float:
    """Return the spacing of the channel of this name: 25 or 8.33 kHz.

    Raises
    ------
    ScenarioError
        There is no channel of this name.
    """
    above = frequency_khz % BLOCK_KHZ
    if LOWEST_KHZ <= frequency_khz <= HIGHEST_KHZ:
        if above == 0:
            return 25.0
        if above in NARROW_KHZ:
            return 25.0 / 3.0
    raise ScenarioError(
        f"{frequency_khz} kHz is no channel; expected {LOWEST_KHZ} to {HIGHEST_KHZ} in 25 kHz "
        f"steps, or 5, 10 or 15 above one of them (8.33 kHz spacing), such as "
        f"{_nearest(frequency_khz)}"
    )


def _nearest(frequency_khz: int) -> int:
    inside = min(max(frequency_khz, LOWEST_KHZ), HIGHEST_KHZ)
    block = inside - inside % BLOCK_KHZ
    names = (block, *(block + above for above in sorted(NARROW_KHZ)), block + BLOCK_KHZ)
    return min((name for name in names if name <= HIGHEST_KHZ), key=lambda name: abs(name - inside))
