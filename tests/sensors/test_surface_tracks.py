"""Surface surveillance by its published limits: how far, how high, how surely and how exactly."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from airhilt import load
from airhilt.geodesy.wgs84 import Place, distance_m, offset_m, onward
from airhilt.messages import SurfaceTrack
from airhilt.scenario.models import Scenario, SurfaceSurveillance
from airhilt.sensors.surface import SENSOR
from airhilt.units import DEGREE, FOOT, KNOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.loading import load_text
from airhilt.world.mover import SurfaceState
from airhilt.world.site import ScenarioSite
from sensed import Acting, Body, sense

AIRCRAFT, TRUCK, ANIMAL = "AAL123", "OPS1", "ANIMAL1"


def airport(kind: str = "deer", **changes: Any) -> Scenario:
    """Return an airport with an aircraft, trucks and an animal."""
    document = load("s01b_noncompliance").model_dump(mode="json")
    where = {"type": "runway", "runway": "04", "along_m": 300.0, "offset_m": 80.0}
    animal = {
        "type": "wildlife", "callsign": ANIMAL, "kind": kind,
        "initial": {"type": "standing", "heading_deg": 90.0, "position": where},
    }  # fmt: skip
    document["actors"].append(animal)
    document |= {"perturbations": [], "conflict": None, "failures": [], "end_when": []}
    document["radio"] = {"controller": "Washington Tower"}
    return load_text(json.dumps(document | {"surface_surveillance": {}} | changes), "airport")


class Watch:
    """The sensor, with actors that stay where they are put."""

    def __init__(self, scenario: Scenario | None = None) -> None:
        self.scenario = scenario or airport()
        self.site = ScenarioSite.of(self.scenario)
        self.actors: dict[str, Acting] = {}
        self.tracks: list[SurfaceTrack] = []
        self.age_ns = 0

    def out_from_runway_01(self, distance_nm: float) -> Place:
        """Return a place below the approach, some way before the runway."""
        runway = self.site.runway("01")
        return onward(runway.start, runway.course_rad + math.pi, distance_nm * NAUTICAL_MILE)

    def add(
        self, callsign: str, place: Place, height_ft: float = 0.0,
        velocity: tuple[float, float] = (0.0, 0.0), *, equipped: bool = True,
    ) -> Body:  # fmt: skip
        spec: Any = next(each for each in self.scenario.actors if each.callsign == callsign)
        if callsign != ANIMAL:
            transponder = spec.transponder.model_copy(update={"equipped": equipped})
            spec = spec.model_copy(update={"transponder": transponder})
        state = SurfaceState(
            *place, self.site.ground_m + height_ft * FOOT, height_ft * FOOT, *velocity, 0.0, 0.0
        )
        body = Body(state, on_ground=height_ft == 0.0)
        self.actors[callsign] = Acting(spec, body)
        return body

    def publish(self, _: str, track: Any, *, raw: bytes | None = None) -> None:
        assert raw is None
        self.tracks.append(track)

    def go(self, seconds: float = 20.0) -> list[SurfaceTrack]:
        sense(
            SENSOR, self.scenario, self.site, self.actors, self.publish, seconds, age_ns=self.age_ns
        )
        return self.tracks

    def of(self, callsign: str | None) -> list[SurfaceTrack]:
        """Return the tracks of who has a transponder, or all without a name."""
        return [track for track in self.tracks if track.callsign == callsign]

    def errors_m(self, callsign: str) -> np.ndarray:
        """Return north and east errors of the tracks of an actor."""
        state = self.actors[callsign].body.state
        place = state.latitude_rad, state.longitude_rad
        return np.array([offset_m(place, place_of(track)) for track in self.of(callsign)])


def place_of(track: SurfaceTrack) -> Place:
    return track.latitude_deg * DEGREE, track.longitude_deg * DEGREE


@pytest.mark.parametrize(("distance_nm", "is_seen"), [(2.49, True), (2.51, False)])
def test_the_radar_sees_out_to_two_and_a_half_miles(distance_nm: float, is_seen: bool) -> None:
    watch = Watch()
    watch.add(AIRCRAFT, watch.out_from_runway_01(distance_nm), 100.0, equipped=False)
    assert bool(watch.go()) is is_seen


@pytest.mark.parametrize(("distance_nm", "is_seen"), [(4.99, True), (5.01, False)])
def test_transponders_are_located_out_to_five_miles(distance_nm: float, is_seen: bool) -> None:
    watch = Watch()
    watch.add(AIRCRAFT, watch.out_from_runway_01(distance_nm), 1_000.0)
    assert {track.kind for track in watch.go()} == ({"secondary"} if is_seen else set())


@pytest.mark.parametrize(("kind", "is_seen"), [("deer", True), ("coyote", False)])
def test_what_echoes_as_one_square_metre_is_seen_and_a_coyote_is_not(
    kind: str, is_seen: bool
) -> None:
    watch = Watch(airport(kind))
    watch.add(ANIMAL, watch.out_from_runway_01(0.5))
    assert bool(watch.go()) is is_seen


SECONDS = 1_500
FLIGHT = (30.0, -40.0)
"""North and east velocity of the aircraft, in m/s."""


@pytest.fixture(scope="module")
def long() -> Watch:
    """An aircraft at 500 ft, a truck and a deer, all with a constant state for some time."""
    watch = Watch()
    watch.add(AIRCRAFT, watch.out_from_runway_01(1.0), 500.0, FLIGHT)
    watch.add(TRUCK, watch.out_from_runway_01(0.2))
    watch.add(ANIMAL, watch.out_from_runway_01(0.7))
    watch.go(SECONDS)
    return watch


def test_radar_detects_in_90_percent_of_the_seconds(long: Watch) -> None:
    echoes = long.of(None)
    assert {track.kind for track in echoes} == {"primary"}
    assert len(echoes) / SECONDS == pytest.approx(0.90, abs=0.025)


def test_a_transponder_is_located_in_999_of_1000_intervals_of_two_seconds(long: Watch) -> None:
    replies = long.of(AIRCRAFT)
    assert {track.kind for track in replies} == {"secondary"}  # It is too high for the radar.
    assert len(replies) / SECONDS == pytest.approx(1.0 - math.sqrt(0.001), abs=0.015)


def test_an_echo_and_a_reply_are_one_combined_detection(long: Watch) -> None:
    kinds = [track.kind for track in long.of(TRUCK)]
    assert kinds.count("combined") / SECONDS == pytest.approx(0.90 * 0.97, abs=0.03)
    assert kinds.count("secondary") > kinds.count("primary") > 0


def test_what_is_declared_as_lost_is_lost() -> None:
    watch = Watch(airport(surface_surveillance={"loss_probability": 0.4}))
    watch.add(TRUCK, watch.out_from_runway_01(0.2))
    assert len(watch.go(400.0)) / 400.0 == pytest.approx(0.6, abs=0.07)


@pytest.mark.parametrize(("callsign", "accuracy_m"), [(TRUCK, 7.5), (AIRCRAFT, 20.0)])
def test_95_percent_of_positions_are_within_what_is_stated(
    long: Watch, callsign: str, accuracy_m: float
) -> None:
    assert {track.accuracy_m for track in long.of(callsign)} == {accuracy_m}
    errors = long.errors_m(callsign)
    off = np.hypot(errors[:, 0], errors[:, 1])
    assert np.mean(off <= accuracy_m) == pytest.approx(0.95, abs=0.02)
    # Each axis has its own error, and of the same size.
    sigma_m = accuracy_m / math.sqrt(-2.0 * math.log(0.05))
    assert np.std(errors, axis=0) == pytest.approx([sigma_m, sigma_m], rel=0.15)
    assert abs(np.corrcoef(errors.T)[0, 1]) < 0.2


def test_errors_of_positions_fade_with_a_time_constant_of_5_s(long: Watch) -> None:
    north = long.errors_m(TRUCK)[:, 0]
    for seconds in (1, 5):  # Hardly any second is without a track.
        kept = np.corrcoef(north[:-seconds], north[seconds:])[0, 1]
        assert kept == pytest.approx(math.exp(-seconds / 5.0), abs=0.1)


def test_95_percent_of_velocities_are_within_3_kt(long: Watch) -> None:
    off = []
    for track in long.of(AIRCRAFT):
        assert track.track_deg is not None
        speed_m_s, angle = track.ground_speed_kt * KNOT, track.track_deg * DEGREE
        north_m_s, east_m_s = speed_m_s * math.cos(angle), speed_m_s * math.sin(angle)
        off.append(math.hypot(north_m_s - FLIGHT[0], east_m_s - FLIGHT[1]))
    assert np.mean(np.array(off) <= 1.5) == pytest.approx(0.95, abs=0.03)


def test_speeds_have_steps_of_a_tenth_of_a_knot(long: Watch) -> None:
    tenths = [10.0 * track.ground_speed_kt for track in long.of(AIRCRAFT)]
    assert tenths == pytest.approx([round(each) for each in tenths])
    assert math.gcd(*(round(each) for each in tenths)) == 1


def test_a_track_comes_half_a_second_after_its_measurement_each_second() -> None:
    watch = Watch()
    watch.add(AIRCRAFT, watch.out_from_runway_01(1.0))
    tracks = watch.go(30.0)
    assert {track.t_ns - track.t_track_ns for track in tracks} == {500_000_000}
    assert {track.t_track_ns % SECOND_NS for track in tracks} == {0}
    assert len(tracks) >= 28


@pytest.mark.parametrize(("end_s", "numbers"), [(14.0, {1}), (15.0, {1, 2})])
def test_a_target_has_a_new_number_after_more_than_5_s_without_detection(
    end_s: float, numbers: set[int]
) -> None:
    watch = Watch(airport(surface_surveillance={"outages_s": [[10.0, end_s]]}))
    watch.add(AIRCRAFT, watch.out_from_runway_01(1.0))
    tracks = watch.go(30.0)
    seconds = [track.t_track_ns // SECOND_NS for track in tracks]
    assert [s for s in seconds if 9 <= s <= 15] == [9, *range(round(end_s), 16)]
    assert {track.track for track in tracks} == numbers


def test_targets_are_numbered_from_1_and_those_that_have_ended_are_left_out() -> None:
    watch = Watch()
    gone = watch.add(AIRCRAFT, watch.out_from_runway_01(1.0))
    watch.add(TRUCK, watch.out_from_runway_01(0.5))
    gone.ended = "collided"
    address = watch.actors[TRUCK].spec.icao24
    shown = {(track.track, track.callsign, track.icao24) for track in watch.go()}
    assert shown == {(1, TRUCK, address)}


def test_a_target_is_shown_where_it_is_at_the_instant_of_the_measurement() -> None:
    """It flies with 200 m/s, and its state is 0.4 s old."""
    watch = Watch()
    watch.add(AIRCRAFT, watch.out_from_runway_01(1.0), velocity=(200.0, 0.0))
    watch.age_ns = 2 * SECOND_NS // 5
    watch.go(60.0)
    assert np.mean(watch.errors_m(AIRCRAFT), axis=0) == pytest.approx([80.0, 0.0], abs=8.0)


def altitudes(tracks: list[SurfaceTrack]) -> Iterator[tuple[float | None, bool | None]]:
    return ((track.altitude_ft, track.on_ground) for track in tracks)


def test_an_altitude_is_that_of_a_transponder_in_the_air_to_the_nearest_25_ft() -> None:
    watch = Watch()
    ground_ft = watch.site.ground_m / FOOT
    place = watch.out_from_runway_01(1.0)
    watch.add(AIRCRAFT, place, 1_012.6 - ground_ft)
    assert set(altitudes(watch.go())) == {(1_025.0, False)}
    watch = Watch()
    watch.add(AIRCRAFT, place)
    assert set(altitudes(watch.go())) == {(None, True)}
    watch = Watch()
    watch.add(AIRCRAFT, place, 150.0, equipped=False)
    assert set(altitudes(watch.go())) == {(None, None)}
    assert {(track.icao24, track.callsign) for track in watch.tracks} == {(None, None)}


@pytest.mark.parametrize(("speed_m_s", "stands"), [(0.05, True), (0.06, False)])
def test_what_hardly_moves_stands(speed_m_s: float, stands: bool) -> None:
    watch = Watch()
    watch.add(AIRCRAFT, watch.out_from_runway_01(1.0), velocity=(speed_m_s, 0.0))
    tracks = watch.go()
    assert all((track.track_deg is None) is stands for track in tracks)
    assert all(track.ground_speed_kt == 0.0 for track in tracks) is stands


def test_the_radar_looks_from_both_ends_of_each_runway() -> None:
    watch = Watch()
    for ident in ("01", "19", "04", "22", "15", "33"):
        runway = watch.site.runway(ident)
        beyond = onward(runway.start, runway.course_rad + math.pi, 2.4 * NAUTICAL_MILE)
        assert distance_m(beyond, runway.start) == pytest.approx(2.4 * NAUTICAL_MILE, abs=1.0)
        watch.actors.clear()
        watch.tracks.clear()
        watch.add(AIRCRAFT, beyond, 100.0, equipped=False)
        assert watch.go(), ident


def created(scenario: Scenario, *subscribed: str) -> bool:
    site, asked = ScenarioSite.of(scenario), frozenset(subscribed)
    return sense(SENSOR, scenario, site, {}, print, 0.0, subscribed=asked) is not None


def test_it_is_there_if_the_scenario_or_a_worker_asks_and_there_is_an_airport() -> None:
    silent = airport().model_copy(update={"surface_surveillance": None})
    assert not created(silent, "radar")
    assert created(silent, "surface")
    assert created(silent.model_copy(update={"surface_surveillance": SurfaceSurveillance()}))
    assert not created(load("s02a_headon"), "surface")
