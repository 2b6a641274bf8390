"""What controllers say is read as what they mean, whoever is told, and in both phraseologies."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from airhilt.messages import (
    AdsbReport,
    CancelTakeoff,
    Climb,
    GoAround,
    HoldPosition,
    MaintainLevel,
    Recommendation,
    Turn,
)
from airhilt.phraseology import Instruction, Style, parse_call
from airhilt.sensors.radio.controllers.displays import Displays
from airhilt.sensors.radio.controllers.measures import Measure
from airhilt.sensors.radio.controllers.strips import Strips
from airhilt.sensors.radio.controllers.wording import Wording
from airhilt.sensors.radio.stations import Stations
from airhilt.sim import Director, Virtual
from airhilt.world.loading import load
from airhilt.world.site import ScenarioSite

ON_FREQUENCY = ("AAL123", "DAL456", "BAW38", "UAL1200", "N172SP", "OPS2", "FIRE3")
LEVELS_FT = st.integers(10, 450).map(lambda hundreds: hundreds * 100.0)
DEGREES = st.integers(-180, 180).filter(bool).map(float)
RUNWAYS = st.sampled_from(["01", "19", "18L", "27R"])
ACTIONS: st.SearchStrategy[Recommendation] = st.one_of(
    st.builds(GoAround, runway=RUNWAYS),
    st.builds(CancelTakeoff, runway=RUNWAYS),
    st.builds(HoldPosition, runway=RUNWAYS),
    st.builds(MaintainLevel, altitude_ft=LEVELS_FT),
    st.builds(Turn, degrees=DEGREES),
    st.builds(
        Climb, sense=st.sampled_from(["climb", "descend"]), altitude_ft=LEVELS_FT,
        vertical_rate_fpm=st.just(1500.0), turn_deg=st.one_of(st.just(0.0), DEGREES),
    ),
)  # fmt: skip
SCENARIO = load("s01a_nominal")
STATIONS = Stations({}, ScenarioSite.of(SCENARIO), SCENARIO)


def displays(*shown: tuple[str, float, float]) -> Displays:
    """Return displays with targets: callsigns, latitudes and tracks in degrees."""
    found = Displays(Director(Virtual()))
    for at, (callsign, latitude_deg, track_deg) in enumerate(shown):
        found.take(
            AdsbReport(
                t_ns=0, icao24=f"{at:06x}", callsign=callsign, latitude_deg=latitude_deg,
                longitude_deg=-77.0, altitude_ft=9000.0, emitter_category="A3",
                ground_speed_kt=250.0, track_deg=track_deg, vertical_rate_fpm=0.0, nacp=9, nacv=2,
                receiver="one", t_adsb_in_ns=0, t_adsb_out_ns=0,
            )
        )  # fmt: skip
    return found


def calm(instructions: tuple[Instruction, ...]) -> list[Instruction]:
    """Return instructions without their haste: one "immediately" is said for all."""
    return [replace(each, immediate=False) for each in instructions]


@settings(max_examples=400, deadline=None)
@given(
    ACTIONS, st.sampled_from(ON_FREQUENCY), st.sampled_from(["faa", "icao"]), st.booleans(),
    st.booleans(), st.floats(38.0, 40.0), st.integers(0, 359), st.floats(-180.0, 180.0),
)  # fmt: skip
def test_the_words_of_a_measure_mean_the_measure(
    action: Recommendation, callsign: str, style: Style, is_shown: bool, is_alert: bool,
    latitude_deg: float, track_deg: int, variation_deg: float,
) -> None:  # fmt: skip
    other = next(name for name in ON_FREQUENCY if name != callsign)
    own = [(callsign, 39.0, float(track_deg))] if is_shown else []
    screen = displays(*own, (other, latitude_deg, 90.0))
    wording = Wording(screen, Strips(STATIONS, Director(Virtual())), style, variation_deg)
    measure = Measure(callsign, action, screen.target(other), is_alert=is_alert)
    instructions = wording.instructions(measure)
    text = wording.text(measure, instructions)
    read = parse_call(text, ON_FREQUENCY)
    assert read.callsign == callsign, text
    assert calm(read.instructions) == calm(instructions), text
