"""The seats of a run that are left to people."""

from __future__ import annotations

from collections.abc import Iterable

from airhilt.errors import ScenarioError, shown
from airhilt.scenario.models import Scenario, WildlifeSpec

TOWER = "tower"
"""Name by which the seat of the controller can be asked for in any scenario."""
GROUND = "ground"
"""Likewise of the first unit that is called ground, as in Washington Ground."""
ROLES = frozenset((TOWER, GROUND))
"""Names by which seats can be asked for that are not their own."""


def without_roles(names: Iterable[str], controller: str, known: Iterable[str]) -> tuple[str, ...]:
    """Return names of seats in which the name of a unit stands for its role, each once.

    ``known`` has the names of all seats.
    """
    grounds = (name for name in known if name.lower().endswith(f" {GROUND}"))
    units = {TOWER: controller, GROUND: next(grounds, GROUND)}
    return tuple(dict.fromkeys(units.get(name, name) for name in names))


def possible_seats(scenario: Scenario) -> tuple[str, ...]:
    """Return the units and callsigns that people may be; none without a radio line."""
    if not scenario.radio.lines:
        return ()
    actors = [one.callsign for one in scenario.actors if not isinstance(one, WildlifeSpec)]
    speakers = [line.speaker for line in scenario.radio.lines]
    return tuple(dict.fromkeys([scenario.radio.controller, *actors, *speakers]))


def seats_of(names: Iterable[str], scenario: Scenario) -> tuple[str, ...]:
    """Return the units and callsigns that are asked for, each once.

    Raises
    ------
    ScenarioError
        There is none of a name in the scenario, or nobody speaks on the radio there.
    """
    if (asked := list(names)) and not scenario.radio.lines:
        raise ScenarioError(
            f"--seat {shown(asked[0])}: {scenario.name!r} has no radio line, and so no frequency; "
            "expected a scenario with radio/lines"
        )
    known = possible_seats(scenario)
    found = without_roles(asked, scenario.radio.controller, known)
    for name in found:
        if name not in known:
            raise ScenarioError(
                f"--seat {shown(name)}: nobody of that name speaks in {scenario.name!r}; expected "
                f"{TOWER}, or one of {', '.join(known)}"
            )
    return found
