"""Names of airlines on the radio (telephony designators of ICAO Doc 8585)."""

from __future__ import annotations

import csv
from importlib.resources import files
from typing import NamedTuple


class Airline(NamedTuple):
    """An airline: its names on the radio and in the register."""

    designator: str
    telephony: str
    operator: str


def _load() -> dict[str, Airline]:
    table = files(__package__).joinpath("telephony.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(table.splitlines())
    return {row["designator"]: Airline(**row) for row in rows}


AIRLINES = _load()
"""Airlines by ICAO designator."""
TELEPHONY = {designator: airline.telephony for designator, airline in AIRLINES.items()}
"""Telephony designators by ICAO designator."""
ALSO_CALLED = {
    "AFR": ("air france",), "ANA": ("all nippon airways",), "CES": ("china eastern airlines",),
    "CPA": ("cathay pacific",), "EJA": ("exec jet",), "JAL": ("japan air",),
    "KAL": ("korean",), "LAN": ("lan",), "MAS": ("malaysia",), "NKS": ("spirit",),
    "QTR": ("qatar",), "SVA": ("saudi",),
    "TAP": ("tap", "tap portugal"), "TSC": ("air transat",), "TUI": ("tui fly",),
    "UPS": ("ups",), "WZZ": ("wizz air",),
}  # fmt: skip
"""Names that people use although the register does not have them, by ICAO designator."""


def names(designator: str) -> tuple[str, ...]:
    """Return the names of an airline on the radio, the registered one first."""
    return (TELEPHONY[designator], *ALSO_CALLED.get(designator, ()))
