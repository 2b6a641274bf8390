"""What airlines are called on the radio (telephony designators of ICAO Doc 8585)."""

from __future__ import annotations

import csv
from importlib.resources import files
from typing import NamedTuple


class Airline(NamedTuple):
    """An airline, as on the radio and in the register."""

    designator: str
    telephony: str
    operator: str


def _load() -> dict[str, Airline]:
    table = files(__package__).joinpath("telephony.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(table.splitlines())
    return {row["designator"]: Airline(**row) for row in rows}


AIRLINES = _load()
"""By ICAO designator."""
TELEPHONY = {designator: airline.telephony for designator, airline in AIRLINES.items()}
"""What an airline is called, by ICAO designator."""
ALSO_CALLED = {
    "AFR": ("air france",), "ANA": ("all nippon airways",), "CES": ("china eastern airlines",),
    "CPA": ("cathay pacific",), "EJA": ("exec jet",), "JAL": ("japan air",),
    "KAL": ("korean",), "LAN": ("lan",), "MAS": ("malaysia",), "NKS": ("spirit",),
    "QTR": ("qatar",), "SVA": ("saudi",),
    "TAP": ("tap", "tap portugal"), "TUI": ("tui fly",), "UPS": ("ups",), "WZZ": ("wizz air",),
}  # fmt: skip
"""What people say for it instead, though the register does not have it."""


def names(designator: str) -> tuple[str, ...]:
    """Return what the flights of an airline may be called, the registered name first."""
    return (TELEPHONY[designator], *ALSO_CALLED.get(designator, ()))
