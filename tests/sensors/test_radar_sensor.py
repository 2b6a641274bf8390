"""Surveillance radar in a run: when the beam passes, what is detected, and how exactly."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import TypeAdapter

from airhilt import load
from airhilt.cosim.replay import replay
from airhilt.cosim.simulation import run
from airhilt.errors import ScenarioError
from airhilt.geodesy.positions import Position
from airhilt.messages import RadarInfo, RadarPlot
from airhilt.options import Options
from airhilt.record import read_log
from airhilt.scenario import Scenario
from airhilt.sensors.radar import SENSOR
from airhilt.sim import Director, Priority, Virtual
from airhilt.surveillance.radar import RADARS, Antenna
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS
from airhilt.world.loading import load_text
from airhilt.world.mover import SurfaceState, carried_on
from airhilt.world.site import ScenarioSite
from sensed import Acting, Body, sense
from shortened import shortened

CENTRE = {"type": "from_centre", "bearing_deg": 0.0, "distance_nm": 0.0}
TURN_S = {"terminal": 4.8, "en_route": 12.0}
TICK_NS = SECOND_NS // 20


def state(
    site: ScenarioSite,
    bearing_deg: float,
    distance_nm: float,
    altitude_ft: float,
    speed_m_s: float = 230.0,
    track_deg: float = 0.0,
) -> SurfaceState:
    position = {"type": "from_centre", "bearing_deg": bearing_deg, "distance_nm": distance_nm}
    latitude, longitude = site.place(TypeAdapter(Position).validate_python(position))
    altitude_m = altitude_ft * FOOT
    return SurfaceState(
        latitude, longitude, altitude_m, altitude_m - site.ground_m,
        speed_m_s * math.cos(track_deg * DEGREE), speed_m_s * math.sin(track_deg * DEGREE), 0.0,
        track_deg * DEGREE,
    )  # fmt: skip


class Watch:
    """A radar with targets that fly straight on."""

    def __init__(self, kind: str = "terminal", seed: int = 1, count: int = 2, **radar: Any) -> None:
        document = load("s02a_headon").model_dump(mode="json")
        document |= {
            "actors": document["actors"][:count], "conflict": None, "end_when": [],
            "perturbations": [], "radio": {}, "cameras": [],
            "radars": [{"name": "R1", "kind": kind, "position": CENTRE} | radar],
        }  # fmt: skip
        self.scenario = Scenario.model_validate(document)
        self.site = ScenarioSite.of(self.scenario)
        self.director = Director(Virtual())
        self.seed = seed
        self.actors: dict[str, Acting] = {}
        self.info: list[RadarInfo] = []
        self.plots: list[RadarPlot] = []
        self.keys: set[str] = set()
        self.ticked_ns = 0

    def add(self, *where: float, index: int = 0, equipped: bool = True, **rest: Any) -> Acting:
        spec = self.scenario.actors[index]
        spec = spec.model_copy(
            update={"transponder": spec.transponder.model_copy(update={"equipped": equipped})}
        )
        body = {key: rest.pop(key) for key in ("on_ground", "dimensions") if key in rest}
        category = rest.pop("category", "A3")
        acting = Acting(spec, Body(state(self.site, *where, **rest), **body), category)
        self.actors[spec.callsign] = acting
        return acting

    def publish(self, key: str, message: Any, *, raw: bytes | None = None) -> None:
        assert raw is None
        self.keys.add(key)
        (self.info if isinstance(message, RadarInfo) else self.plots).append(message)

    def go(self, seconds: float) -> Watch:
        self.director.every(TICK_NS, self.tick, Priority.PHYSICS, first_ns=TICK_NS)
        sense(
            SENSOR, self.scenario, self.site, self.actors, self.publish, seconds,
            seed=self.seed, director=self.director, state_at_ns=lambda: self.ticked_ns,
        )  # fmt: skip
        return self

    def tick(self) -> None:
        for acting in self.actors.values():
            acting.body.state = carried_on(acting.body.state, 0.05)
        self.ticked_ns = self.director.now_ns

    def antenna(self) -> Antenna:
        info = self.info[0]
        return Antenna(info.latitude_deg * DEGREE, info.longitude_deg * DEGREE, info.altitude_m)


def turn(degrees: float) -> float:
    return (degrees + 180.0) % 360.0 - 180.0


@pytest.mark.parametrize("kind", ["terminal", "en_route"])
def test_a_target_is_plotted_once_a_turn(kind: str) -> None:
    watch = Watch(kind)
    watch.add(40.0, 50.0, 35_000.0, speed_m_s=0.001)
    watch.go(50 * TURN_S[kind])
    times = [plot.t_plot_ns / SECOND_NS for plot in watch.plots]
    turns = [(b - a) / TURN_S[kind] for a, b in itertools.pairwise(times)]
    assert len(times) > 45
    assert all(each == pytest.approx(round(each), abs=1e-6) for each in turns)
    assert watch.keys == {"radar/R1", "radar/R1/info"}


def test_the_beam_passes_targets_in_the_order_of_their_azimuths() -> None:
    watch = Watch()
    for index, bearing in enumerate((10.0, 100.0)):
        watch.add(bearing, 30.0, 20_000.0, index=index, speed_m_s=0.001)
    watch.go(60.0)
    passed = sorted((plot.t_plot_ns, plot.azimuth_deg) for plot in watch.plots)
    for (early_ns, early_deg), (late_ns, late_deg) in itertools.pairwise(passed):
        elapsed = (late_ns - early_ns) / SECOND_NS / 4.8
        turned = (elapsed - (late_deg - early_deg) / 360.0) % 1.0
        assert min(turned, 1.0 - turned) < 0.01
    published = [plot.t_ns for plot in watch.plots]
    assert published == sorted(published)
    for plot in watch.plots:
        assert 0 <= plot.t_ns - plot.t_plot_ns <= 150_000_000


@pytest.mark.parametrize("kind", ["terminal", "en_route"])
def test_plots_are_published_at_the_ends_of_32_sectors_of_a_turn(kind: str) -> None:
    """As a radar tells of the sectors that it crosses in EUROCONTROL ASTERIX category 034."""
    watch = Watch(kind)
    watch.add(40.0, 50.0, 35_000.0)
    watch.add(160.0, 50.0, 35_000.0, index=1)
    sectors = [plot.t_ns / SECOND_NS / TURN_S[kind] * 32 for plot in watch.go(100.0).plots]
    assert len(sectors) > 10
    assert sectors == pytest.approx([round(each) for each in sectors], abs=1e-6)


def test_ranges_and_azimuths_have_the_steps_of_asterix() -> None:
    """Category 048, item I048/040: 1/256 NM and 360/65536 degrees."""
    watch = Watch()
    watch.add(40.0, 30.0, 20_000.0, speed_m_s=123.0)
    for plot in watch.go(200.0).plots:
        for steps in (plot.range_m * 256.0 / 1852.0, plot.azimuth_deg * 65536.0 / 360.0):
            assert steps == pytest.approx(round(steps), abs=1e-6)


@pytest.mark.parametrize(("beyond_m", "is_seen"), [(9_500.0, True), (11_000.0, False)])
def test_what_taxies_is_seen_while_its_middle_is_above_the_horizon(
    beyond_m: float, is_seen: bool
) -> None:
    """A middle of 6.25 m is 10,300 m behind the horizon of the antenna, and its top 14,600 m."""
    watch = Watch(antenna_height_ft=30.0)
    horizon_m = math.sqrt(2.0 * 4.0 / 3.0 * 6_378_137.0 * 30.0 * FOOT)
    away_nm = (horizon_m + beyond_m) / NAUTICAL_MILE
    ground_ft = watch.site.ground_m / FOOT
    watch.add(0.0, away_nm, ground_ft, speed_m_s=0.0, on_ground=True)
    assert bool(watch.go(60.0).plots) is is_seen


@pytest.mark.parametrize(("elevation_deg", "is_seen"), [(29.5, True), (30.5, False)])
def test_the_cone_of_silence_begins_at_30_degrees(elevation_deg: float, is_seen: bool) -> None:
    watch = Watch()
    height_ft = 6.0 * NAUTICAL_MILE * math.tan(elevation_deg * DEGREE) / FOOT
    antenna_ft = watch.site.ground_m / FOOT + 75.0
    watch.add(90.0, 6.0, antenna_ft + height_ft, speed_m_s=0.0)
    assert bool(watch.go(30.0).plots) is is_seen


def test_a_target_that_the_beam_has_not_reached_hides_none_behind_it() -> None:
    """Whichever is first in the scenario, both are plotted in each turn."""
    watch = Watch()
    for index, bearing in enumerate((10.0, 190.0)):
        watch.add(bearing, 30.0, 20_000.0, index=index, speed_m_s=0.001)
    azimuths = [plot.azimuth_deg for plot in watch.go(20 * TURN_S["terminal"]).plots]
    assert sum(azimuth < 100.0 for azimuth in azimuths) >= 17
    assert sum(azimuth > 100.0 for azimuth in azimuths) >= 17


def test_a_moving_target_is_measured_at_the_instant_at_which_the_beam_passes() -> None:
    watch = Watch()
    acting = watch.add(90.0, 30.0, 30_000.0, speed_m_s=250.0, track_deg=350.0)
    start = acting.body.state
    watch.go(300.0)
    antenna = watch.antenna()
    errors_m, errors_deg = [], []
    for plot in watch.plots:
        truth = antenna.to(carried_on(start, plot.t_plot_ns / SECOND_NS))
        errors_m.append(plot.range_m - truth.range_m)
        errors_deg.append(turn(plot.azimuth_deg - truth.azimuth_rad / DEGREE))
    # carried_on follows one step here and thousands of steps in the run, so allow for 100 m.
    assert abs(np.mean(errors_m)) < 100.0
    assert abs(np.mean(errors_deg)) < 0.1


@pytest.mark.parametrize(
    ("equipped", "range_m", "azimuth_deg"), [(True, 70.0, 0.08), (False, 120.0, 0.15)]
)
def test_errors_have_the_declared_size(equipped: bool, range_m: float, azimuth_deg: float) -> None:
    watch = Watch()
    acting = watch.add(200.0, 25.0, 25_000.0, speed_m_s=0.0, equipped=equipped)
    watch.go(4.8 * 1200)
    truth = watch.antenna().to(acting.body.state)
    errors_m = [plot.range_m - truth.range_m for plot in watch.plots]
    errors_deg = [turn(plot.azimuth_deg - truth.azimuth_rad / DEGREE) for plot in watch.plots]
    assert np.std(errors_m) == pytest.approx(range_m, rel=0.1)
    assert np.std(errors_deg) == pytest.approx(azimuth_deg, rel=0.1)
    assert abs(np.mean(errors_m)) < 0.15 * range_m
    assert abs(np.mean(errors_deg)) < 0.15 * azimuth_deg


def test_detection_converges_to_its_probability() -> None:
    watch = Watch()
    acting = watch.add(300.0, 55.0, 25_000.0, speed_m_s=0.0, equipped=False, category="A1")
    turns = 1500
    watch.go(4.8 * turns)
    range_m = watch.antenna().to(acting.body.state).range_m
    expected = RADARS["terminal"].detection_probability(1.0, range_m)
    assert 0.5 < expected < 0.9
    assert len(watch.plots) / turns == pytest.approx(expected, abs=0.04)


def test_replies_are_as_probable_as_declared() -> None:
    watch = Watch()
    watch.add(300.0, 100.0, 35_000.0, speed_m_s=0.0)  # Beyond the primary radar.
    turns = 1500
    plots = watch.go(4.8 * turns).plots
    assert {plot.kind for plot in plots} == {"secondary"}
    assert len(plots) / turns == pytest.approx(0.97, abs=0.02)
    for name, probability in (("mode_a", 0.98), ("mode_c_ft", 0.96)):
        valid = [plot for plot in plots if getattr(plot, name) is not None]
        assert len(valid) / len(plots) == pytest.approx(probability, abs=0.02)


def test_an_aircraft_without_a_transponder_is_a_primary_plot_without_code_and_altitude() -> None:
    watch = Watch()
    watch.add(120.0, 20.0, 10_000.0, equipped=False)
    plots = watch.go(60.0).plots
    assert plots
    assert all((p.kind, p.mode_a, p.mode_c_ft) == ("primary", None, None) for p in plots)


def test_an_aircraft_with_a_transponder_is_known_by_its_code_and_level() -> None:
    watch = Watch()
    watch.add(120.0, 20.0, 10_040.0)
    plots = watch.go(120.0).plots
    assert {plot.mode_c_ft for plot in plots} <= {None, 10_000}
    assert len({plot.mode_a for plot in plots} - {None}) == 1
    assert "combined" in {plot.kind for plot in plots}


def test_what_stands_on_the_ground_is_taken_for_ground() -> None:
    still, moving = Watch(), Watch()
    still.add(0.0, 1.5, 0.0, speed_m_s=0.0, on_ground=True)
    moving.add(0.0, 1.5, 0.0, speed_m_s=60.0, on_ground=True)
    assert still.go(60.0).plots == []
    assert {plot.kind for plot in moving.go(60.0).plots} == {"primary"}  # It does not reply there.


def test_what_crosses_the_line_of_sight_near_the_radar_is_taken_for_ground_by_primary() -> None:
    watch = Watch()
    watch.add(90.0, 8.0, 5_000.0, speed_m_s=3.0, track_deg=0.0)
    assert {plot.kind for plot in watch.go(60.0).plots} == {"secondary"}


def test_one_target_more_changes_nothing_in_the_plots_of_another() -> None:
    alone, together = Watch(), Watch()
    alone.add(90.0, 30.0, 30_000.0)
    together.add(90.0, 30.0, 30_000.0)
    together.add(270.0, 30.0, 30_000.0, index=1)
    plots = alone.go(60.0).plots
    assert plots
    assert plots == [plot for plot in together.go(60.0).plots if plot.azimuth_deg < 180.0]


def test_who_has_ended_is_not_plotted_and_all_others_are() -> None:
    watch = Watch()
    gone = watch.add(90.0, 20.0, 10_000.0)
    watch.add(180.0, 20.0, 10_000.0, index=1)
    gone.body.ended = "collided"
    codes = {plot.mode_a for plot in watch.go(15.0).plots}
    assert len(watch.plots) >= 2
    assert len(codes) == 1


def test_another_seed_draws_other_plots() -> None:
    first, again, other = (Watch(seed=seed) for seed in (1, 1, 2))
    for watch in (first, again, other):
        watch.add(90.0, 30.0, 30_000.0)
        watch.go(30.0)
    assert first.plots == again.plots
    assert first.plots != other.plots


# --- in a run -------------------------------------------------------------------------------


def radar_messages(folder: Path) -> list[RadarPlot]:
    log = read_log(folder / "log.mcap")
    return [RadarPlot.model_validate_json(m.data) for m in log if m.key == "radar/R1"]


@pytest.fixture(scope="module")
def intruder_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Forty seconds of an intruder without a transponder, watched by a terminal radar."""
    document = shortened(load("s02c_intruder_crossing").model_dump(mode="json"), 40.0)
    document["cameras"] = []
    document["radars"] = [
        {
            "name": "R1",
            "position": {"type": "from_centre", "bearing_deg": 270.0, "distance_nm": 30.0},
        }
    ]
    folder = tmp_path_factory.mktemp("intruder") / "run"
    options = Options(out=folder, latency="fixed", speech=False, cameras=False)
    run(Scenario.model_validate(document), options)
    return folder


def test_a_replay_gives_the_same_plots(intruder_run: Path) -> None:
    assert radar_messages(intruder_run)
    assert replay(intruder_run).identical


@pytest.mark.parametrize(
    ("radars", "problem"),
    [
        ([{"name": "R1", "position": {"type": "node", "node": "J9"}}], "radars/0/position"),
        ([{"name": "R1", "position": CENTRE}] * 2, "radars/1/name"),
    ],
)
def test_a_radar_that_cannot_be_is_refused(radars: list[Any], problem: str) -> None:
    document = load("s02a_headon").model_dump(mode="json") | {"radars": radars}
    with pytest.raises(ScenarioError, match=problem):
        load_text(json.dumps(document), "headon")
