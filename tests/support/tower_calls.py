"""Calls of a tower, the situations in which they are made, and what is seen of each afterwards."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

from shapely import Point

from airhilt.geodesy.local_frame import LocalFrame
from airhilt.record import Logged
from airhilt.scenario import Scenario
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.layout import Layout
from seats import calls, contents

CALLS: list[dict[str, Any]] = json.loads(
    (Path(__file__).parent.parent / "station/tower_calls.json").read_text(encoding="utf-8")
)["calls"]
"""Calls with the paragraph of the manual that has them: FAA Order JO 7110.65 or ICAO Doc 4444."""
TOWER, GROUND, DEPARTURE = "Washington Tower", "Washington Ground", "Potomac Departure"
TOWER_KHZ, GROUND_KHZ, DEPARTURE_KHZ = 119_100, 121_700, 125_650
LAYOUT = Layout(load_airport("KDCA"))
RUNWAY_01_DEG = 355.5
"""True course of runway 01."""


def on_final(distance_nm: float, *commands: dict[str, Any]) -> dict[str, Any]:
    return {
        "initial": {"type": "final", "runway": "01", "distance_nm": distance_nm},
        "commands": list(commands),
    }


def lined_up(*commands: dict[str, Any]) -> dict[str, Any]:
    return {"initial": {"type": "lined_up", "runway": "01"}, "commands": list(commands)}


def standing(node: str, heading_deg: float = 90.0, *commands: dict[str, Any]) -> dict[str, Any]:
    at = {"type": "node", "node": node}
    return {
        "initial": {"type": "standing", "position": at, "heading_deg": heading_deg},
        "commands": list(commands),
    }


LAND = {"action": "land", "runway": "01"}
TAKE_OFF = {"action": "take_off", "runway": "01"}
HOLDING_SHORT: dict[str, Any] = {
    "initial": {"type": "hold_short", "runway": "01", "taxiway": "A"}, "commands": [],
}  # fmt: skip
SHORT_OF_D = {
    "initial": {"type": "hold_short", "runway": "01", "taxiway": "D"},
}
SHORT_OF_M = {
    "initial": {"type": "hold_short", "runway": "01", "taxiway": "M_west"},
}
DOWNWIND: dict[str, Any] = {
    "initial": {
        "type": "airborne",
        "position": {"type": "runway", "runway": "01", "along_m": 1500, "offset_m": -1900},
        "altitude_ft": 1000, "track_deg": 175.5, "cas_kt": 95,
    },
    "commands": [{"action": "join", "leg": "downwind", "runway": "01", "side": "left"}],
}  # fmt: skip
EN_ROUTE: dict[str, Any] = {
    "initial": {
        "type": "airborne",
        "position": {"type": "from_centre", "bearing_deg": 180, "distance_nm": 15},
        "altitude_ft": 8000, "track_deg": 350, "cas_kt": 250,
    },
}  # fmt: skip
ON_RUNWAY: dict[str, Any] = {
    "initial": {
        "type": "standing",
        "position": {"type": "runway", "runway": "01", "along_m": 900},
        "heading_deg": RUNWAY_01_DEG,
    },
}
SITUATIONS: dict[str, tuple[str, dict[str, Any], float]] = {
    "final": ("AAL123", on_final(5.0), 4.0),
    "short_final": ("AAL123", on_final(1.3, LAND), 4.0),
    "downwind": ("N512SP", DOWNWIND, 4.0),
    "holding_short": ("AAL123", HOLDING_SHORT, 4.0),
    "lined_up": ("AAL123", lined_up(), 4.0),
    "takeoff_roll": ("AAL123", lined_up(TAKE_OFF), 6.0),
    "taxiing": (
        "AAL123", standing("gate_b12", 90.0, {"action": "taxi_to", "runway": "01"}), 15.0,
    ),
    "at_stand": ("AAL123", standing("gate_b12"), 4.0),
    "landed": ("AAL123", on_final(1.0, LAND), 38.0),
    "climb_out": ("AAL123", lined_up(TAKE_OFF), 60.0),
    "en_route": ("AAL123", EN_ROUTE, 4.0),
    "short_of_d": ("AAL123", SHORT_OF_D, 4.0),
    "final_cleared": ("AAL123", on_final(2.0, LAND), 4.0),
    "taxiing_behind": (
        "AAL123", standing("gate_c28", 90.0, {"action": "taxi_to", "runway": "01"}), 15.0,
    ),
    "vehicle_holding_short": ("OPS1", SHORT_OF_M, 4.0),
    "vehicle_on_runway": ("OPS1", ON_RUNWAY, 4.0),
    "vehicle_at_station": ("OPS1", standing("fire_station"), 4.0),
}  # fmt: skip
"""Callsign, beginning, and the time of the call in s of each situation."""


INFORMATION = {
    "id": "information", "at_s": 1, "speaker": TOWER, "frequency_khz": TOWER_KHZ,
    "text": "All stations, information kilo is current.",
}  # fmt: skip


def scenario_of(situation: str, traffic: Sequence[dict[str, Any]], duration_s: float) -> Scenario:
    """Return a scenario in which somebody is in a situation."""
    callsign, begins, _ = SITUATIONS[situation]
    return Scenario.model_validate(
        {
            "name": f"tower_{situation}",
            "family": "S01A",
            "title": f"A call of the tower: {situation}",
            "description": "One call of a tower in one situation.",
            "scene": {"type": "airport", "airport": "KDCA"},
            "duration_s": duration_s,
            "actors": [actor(callsign) | begins, *(actor(**each) for each in traffic)],
            "radio": {"controller": TOWER, "lines": [INFORMATION]},
            "fixes": {"LAM": {"type": "from_centre", "bearing_deg": 270, "distance_nm": 8}},
            "controllers": {
                TOWER: {"frequencies_khz": [TOWER_KHZ]},
                GROUND: {"frequencies_khz": [GROUND_KHZ]},
                DEPARTURE: {"frequencies_khz": [DEPARTURE_KHZ]},
            },
        }
    )


def actor(callsign: str, situation: str | None = None, kind: str = "737") -> dict[str, Any]:
    begins = {} if situation is None else SITUATIONS[situation][1]
    number = sum(ord(letter) for letter in callsign)
    given: dict[str, Any] = {"callsign": callsign, "icao24": f"a{number:05x}"} | begins
    if callsign.startswith("OPS"):
        return {"type": "vehicle", "kind": "follow_me"} | given
    is_light = callsign.startswith("N")
    return {"type": "aircraft", "aircraft": "c172p" if is_light else kind} | given


@dataclass(frozen=True)
class Seen:
    """What is seen of the addressee of a call in the log of a run."""

    log: Sequence[Logged]
    callsign: str
    said_s: float
    """Time of the call in s."""
    until_s: float = math.inf
    """Time in s up to which its movement is seen."""

    @cached_property
    def states(self) -> list[dict[str, Any]]:
        """States from the call on."""
        return [
            each
            for each in contents(self.log, f"truth/state/{self.callsign}")
            if self.said_s <= each["t_ns"] / SECOND_NS <= self.until_s
        ]

    @cached_property
    def answers(self) -> list[dict[str, Any]]:
        """Calls of the addressee after the call."""
        return [
            each
            for each in calls(self.log)
            if each["speaker"] == self.callsign and each["t_tx_ns"] > self.said_s * SECOND_NS
        ]

    @property
    def words(self) -> str:
        return " / ".join(each["text"] for each in self.answers).lower()

    def check(self, does: str, **given: Any) -> bool:
        """Return whether it does something; ``given`` has the details."""
        return bool(getattr(self, does)(**given))

    # --- said -------------------------------------------------------------------------------

    def refuses(self) -> bool:
        return "unable" in self.words

    def asks(self) -> bool:
        return "say" in self.words

    def refuses_or_asks(self) -> bool:
        return self.refuses() or self.asks()

    def says(self, words: list[str]) -> bool:
        return bool(self.answers) and all(word.lower() in self.words for word in words)

    def reads_back(self, words: list[str]) -> bool:
        return self.says(words) and not self.refuses()

    def reports(self, words: list[str], once: str, **given: Any) -> bool:
        """Return whether it tells something, after its readback, as soon as it has done that."""
        for each in self.answers[1:]:
            seen = replace(self, until_s=each["t_tx_ns"] / SECOND_NS)
            if all(word in each["text"].lower() for word in words) and seen.check(once, **given):
                return True
        return False

    def nothing_at_all(self) -> bool:
        return not self.answers

    def leaves_frequency(self, unit: str | None = None, khz: int | None = None) -> bool:
        return any(
            each["frequency_khz"] != TOWER_KHZ
            and (khz is None or each["frequency_khz"] == khz)
            and (unit is None or unit.lower() in each["text"].lower())
            for each in self.answers
        )

    def monitors(self, khz: int) -> bool:
        """Return whether it changes to a frequency without a call there."""
        commands = [
            json.loads(each["text"])
            for each in contents(self.log, "truth/event")
            if each["subject"] == self.callsign and each["kind"] == "command"
        ]
        changes = any(each.get("frequency_khz") == khz for each in commands)
        return changes and not self.leaves_frequency()

    # --- on the ground ----------------------------------------------------------------------

    def stands_still(self) -> bool:
        return speed_m_s(self.states[-1]) < 0.5 and bool(self.states[-1]["on_ground"])

    def moves(self) -> bool:
        return bool(point(self.states[0]).distance(point(self.states[-1])) > 50.0)

    def goes_on(self) -> bool:
        """Return whether it stands for a while, and moves at the end."""
        speeds = [speed_m_s(state) for state in self.states]
        return min(speeds) < 0.5 and speeds[-1] > 1.0

    def follows(self, other: str) -> bool:
        """Return whether it moves along the way of another one, behind it."""
        way = [point(state) for state in contents(self.log, f"truth/state/{other}")]
        here = point(self.states[-1])
        nearest = min(range(len(way)), key=lambda number: here.distance(way[number]))
        is_behind = way[nearest].distance(way[-1]) > 20.0
        return self.moves() and here.distance(way[nearest]) < 30.0 and is_behind

    def backtracks(self, runway: str) -> bool:
        """Return whether it taxis along a runway, against its direction."""
        back_deg = LAYOUT.runway(runway).course_rad / DEGREE + 180.0
        along = [
            point(state)
            for state in self.states
            if self.on_runway(runway, state)
            and abs(turned_deg(state["heading_deg"], back_deg)) < 20.0
        ]
        return bool(along) and along[0].distance(along[-1]) > 100.0

    def on_runway(self, ident: str, state: dict[str, Any]) -> bool:
        strip = LAYOUT.strip_of(ident)
        return bool(state["on_ground"]) and bool(strip.protected_area.contains(point(state)))

    def lines_up(self, runway: str) -> bool:
        last = self.states[-1]
        return last["phase"] == "lined_up" and self.on_runway(runway, last)

    def crosses(self, runway: str) -> bool:
        was_on = [self.on_runway(runway, state) for state in self.states]
        return any(was_on) and not was_on[-1]

    def holds_short_of(self, runway: str) -> bool:
        was_on = any(self.on_runway(runway, state) for state in self.states)
        return self.stands_still() and not was_on

    def vacates(self, at: str | None = None) -> bool:
        runways = [strip.ends[0].ident for strip in LAYOUT.strips.values()]
        last = self.states[-1]
        if not last["on_ground"] or any(self.on_runway(each, last) for each in runways):
            return False
        return at is None or self.is_near_taxiway(at)

    def is_near_taxiway(self, name: str) -> bool:
        """Return whether it was on a taxiway, off the runways."""
        from shapely import LineString

        lines = [
            LineString(LAYOUT.leg(edge))
            for edge in LAYOUT.airport.taxiways.edges
            if edge.taxiway == name
        ]
        runways = [strip.ends[0].ident for strip in LAYOUT.strips.values()]
        off = [s for s in self.states if not any(self.on_runway(each, s) for each in runways)]
        return any(line.distance(point(s)) < 25.0 for line in lines for s in off if s["on_ground"])

    def taxis_to(self, place: str) -> bool:
        nodes = [name for name in LAYOUT.taxiways.nodes if place.lower() in name.lower()]
        last = point(self.states[-1])
        return any(Point(LAYOUT.taxiways.nodes[name]).distance(last) < 80.0 for name in nodes)

    # --- in the air -------------------------------------------------------------------------

    def lands(self) -> bool:
        return bool(not self.states[0]["on_ground"] and self.states[-1]["on_ground"])

    def lands_on(self, runway: str) -> bool:
        return any(
            state["on_ground"] and self.on_runway(runway, state) and
            abs(turned_deg(state["heading_deg"], LAYOUT.runway(runway).course_rad / DEGREE)) < 20.0
            for state in self.states
        )  # fmt: skip

    def takes_off_again(self) -> bool:
        """Return whether it lands and flies again."""
        landed = [state["on_ground"] for state in self.states]
        return any(landed) and not landed[-1]

    def takes_off(self) -> bool:
        return bool(self.states[0]["on_ground"] and not self.states[-1]["on_ground"])

    def goes_around(self) -> bool:
        lowest = min(range(len(self.states)), key=lambda i: float(self.states[i]["altitude_m"]))
        climbed_m = self.states[-1]["altitude_m"] - self.states[lowest]["altitude_m"]
        return bool(climbed_m > 60.0) and not any(state["on_ground"] for state in self.states)

    def altitude(self, ft: float) -> bool:
        return any(abs(state["altitude_m"] / FOOT - ft) < 150.0 for state in self.states)

    def track(self, magnetic_deg: float) -> bool:
        wanted = magnetic_deg - 10.7
        return any(abs(turned_deg(track_deg(state), wanted)) < 8.0 for state in self.states[-100:])

    def comes_nearer_to_ft(self, ft: float) -> bool:
        """Return whether it is nearer to an altitude at the end than at the beginning."""
        first, last = (abs(self.states[at]["altitude_m"] / FOOT - ft) for at in (0, -1))
        return bool(last < first - 100.0)

    def has_flown_track(self, magnetic_deg: float) -> bool:
        """Return whether it flies a magnetic track at any time."""
        wanted = magnetic_deg - 10.7
        return any(abs(turned_deg(track_deg(state), wanted)) < 8.0 for state in self.states)

    def turns(self) -> bool:
        """Return whether it flies another way at the end."""
        return abs(turned_deg(track_deg(self.states[-1]), track_deg(self.states[0]))) > 20.0

    def speed(self, kt: float) -> bool:
        last = self.states[-1]["calibrated_airspeed_m_s"] or 0.0
        return bool(abs(last / KNOT - kt) < 10.0)

    def flies_downwind(self, runway: str) -> bool:
        """Return whether it flies against the direction of a runway, abeam of it."""
        strip = LAYOUT.strip_of(runway)
        back_deg = LAYOUT.runway(runway).course_rad / DEGREE + 180.0
        return any(
            abs(turned_deg(track_deg(state), back_deg)) < 25.0
            and point(state).distance(strip.protected_area) < 4.0 * NAUTICAL_MILE
            for state in self.states
            if not state["on_ground"]
        )

    def is_within_nm(self, nm: float) -> bool:
        """Return whether it is near the airport."""
        return bool(point(self.states[-1]).distance(Point(0.0, 0.0)) < nm * NAUTICAL_MILE)

    def orbits(self) -> bool:
        tracks = [track_deg(state) for state in self.states]
        turned = sum(turned_deg(after, before) for before, after in pairwise(tracks))
        return abs(turned) > 300.0

    def flies_on(self) -> bool:
        return not self.states[-1]["on_ground"]


def point(state: dict[str, Any]) -> Point:
    frame: LocalFrame = LAYOUT.local_frame
    return Point(frame.to_local((state["latitude_deg"] * DEGREE, state["longitude_deg"] * DEGREE)))


def speed_m_s(state: dict[str, Any]) -> float:
    return math.hypot(state["velocity_north_m_s"], state["velocity_east_m_s"])


def track_deg(state: dict[str, Any]) -> float:
    return math.degrees(math.atan2(state["velocity_east_m_s"], state["velocity_north_m_s"])) % 360


def turned_deg(to_deg: float, from_deg: float) -> float:
    """Return the turn from one direction to another, positive to the right, up to 180 degrees."""
    return (to_deg - from_deg + 180.0) % 360.0 - 180.0
