"""Files of recorded traffic become scenarios, and what cannot be right in them is named."""

from __future__ import annotations

import gzip
import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from airhilt.errors import AirhiltError
from airhilt.geodesy.wgs84 import distance_m
from airhilt.scenario.models import AircraftSpec, OnTrack
from airhilt.units import DEGREE
from airhilt.world.tracks.importing import Imported, Wanted, scenario_of
from airhilt.world.tracks.reading import read_traffic
from recorded import ADDRESS, CALLSIGN, WRITERS, rewrite_line, turning_climb, write_readsb

NO_DECODER = pytest.mark.skipif(
    find_spec("pyModeS") is None, reason="no pyModeS: pip install airhilt[decoders]"
)
FORMATS = [pytest.param(name, marks=NO_DECODER) if name == "avr" else name for name in WRITERS]
STEP_M = 8.0
"""Greatest error of a position in frames: a step of the compact format."""


def imported(path: Path, **wanted: Any) -> Imported:
    return scenario_of(read_traffic(path), Wanted("recorded", **wanted))


def the_aircraft(made: Imported) -> tuple[AircraftSpec, OnTrack]:
    (actor,) = made.scenario.actors
    assert isinstance(actor, AircraftSpec)
    assert isinstance(actor.initial, OnTrack)
    return actor, actor.initial


@pytest.mark.parametrize("name", FORMATS)
def test_each_format_becomes_the_track_that_was_flown(name: str, tmp_path: Path) -> None:
    file, write = WRITERS[name]
    flight = turning_climb(30.0)
    write(tmp_path / file, flight)
    actor, track = the_aircraft(imported(tmp_path / file))
    assert (actor.callsign, actor.icao24, actor.aircraft) == (CALLSIGN, ADDRESS, "737")
    assert actor.transponder.squawk == "1000"
    begin_s = flight[0].t_s if name != "avr" else flight[-1].t_s - track.points[-1][0]
    at = {round(each.t_s - begin_s, 3): each for each in flight}
    for t_s, latitude_deg, longitude_deg, altitude_ft in track.points:
        flown = at[round(t_s, 1)]
        there = (flown.latitude_deg * DEGREE, flown.longitude_deg * DEGREE)
        away_m = distance_m(there, (latitude_deg * DEGREE, longitude_deg * DEGREE))
        assert away_m < (STEP_M if name == "avr" else 0.2)
        assert altitude_ft == flown.altitude_ft


def test_a_gzipped_trace_is_read_as_well(tmp_path: Path) -> None:
    plain, packed = tmp_path / "trace.json", tmp_path / "trace_full_3c6444.json.gz"
    write_readsb(plain, turning_climb(20.0))
    packed.write_bytes(gzip.compress(plain.read_bytes()))
    assert imported(packed).document == imported(plain).document


def test_a_file_of_no_format_is_refused_with_the_formats(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("dear diary\n")
    with pytest.raises(AirhiltError, match=r"notes\.txt: no format .* readsb .* avr"):
        read_traffic(tmp_path / "notes.txt")


def test_frames_without_times_are_refused_with_their_line(tmp_path: Path) -> None:
    pytest.importorskip("pyModeS")
    (tmp_path / "raw.txt").write_text("*8D4840D6202CC371C32CE0576098;\n")
    with pytest.raises(AirhiltError, match="line 1: no frame with a time"):
        read_traffic(tmp_path / "raw.txt")


# --- what cannot be right ---------------------------------------------------------------------


def bad_records(path: Path) -> list[str]:
    return [str(bad) for bad in read_traffic(path).bad]


def test_a_step_back_in_time_is_named_with_line_and_field(tmp_path: Path) -> None:
    path = tmp_path / "log.txt"
    WRITERS["sbs"][1](path, turning_climb(30.0))
    rewrite_line(path, 32, lambda cells: [*cells[:7], "22:13:22.000", *cells[8:]])
    (text,) = bad_records(path)
    assert text.startswith("line 32: 7 and 8 (date and time): ")
    assert "s before the one before" in text


@pytest.mark.parametrize(
    ("row", "column", "cell", "field", "expected"),
    [
        (12, 2, "48.5", "lat", "expected at most 1000 kt"),
        (12, 2, "92.0", "lat", "expected degrees from -90 to 90"),
        (12, 3, "east", "lon", "found 'east'"),
        (12, 1, "xyz", "icao24", "expected six hexadecimal digits"),
        (12, 9, "9000", "baroaltitude", "expected at most 20,000 ft/min"),
        (12, 9, "90000", "baroaltitude", "expected -1500 to 60000 ft"),
        (12, 10, "never", "time", "found 'never'"),
    ],
)
def test_an_impossible_value_is_named_with_line_and_field(
    row: int, column: int, cell: str, field: str, expected: str, tmp_path: Path
) -> None:
    path = tmp_path / "states.csv"
    WRITERS["opensky"][1](path, turning_climb(30.0))
    rewrite_line(path, row, lambda cells: [*cells[:column], cell, *cells[column + 1 :]])
    (text,) = bad_records(path)
    assert text.startswith(f"line {row}: {field}: ")
    assert expected in text


def test_a_position_that_no_speed_in_the_file_explains_is_named(tmp_path: Path) -> None:
    """Its time is wrong by 4 s."""
    flight = turning_climb(120.0, step_s=10.0)
    flight[5] = flight[5]._replace(t_s=flight[5].t_s - 4.0)
    write_readsb(tmp_path / "trace.json", flight)
    (text,) = bad_records(tmp_path / "trace.json")
    assert text.startswith("trace/5: 1 (latitude): the way to it takes ")
    assert "expected about 440 kt" in text


def test_what_is_bad_is_left_out_and_the_rest_stays(tmp_path: Path) -> None:
    flight = turning_climb(40.0)
    write_readsb(tmp_path / "good.json", [each for each in flight if each.t_s != 21.0])
    flight[21] = flight[21]._replace(latitude_deg=-40.0)
    write_readsb(tmp_path / "bad.json", flight)
    assert imported(tmp_path / "bad.json").document == imported(tmp_path / "good.json").document


def test_the_longest_part_between_gaps_is_taken_and_the_gap_named(tmp_path: Path) -> None:
    flight = [each for each in turning_climb(400.0) if not 60.0 < each.t_s < 200.0]
    write_readsb(tmp_path / "trace.json", flight)
    made = imported(tmp_path / "trace.json")
    assert made.scenario.duration_s == 200.0
    assert any("trace/61: time: 140 s after the position before" in note for note in made.notes)
    whole = imported(tmp_path / "trace.json", longest_gap_s=200.0)
    assert (whole.scenario.duration_s, whole.notes) == (400.0, ())


def test_a_part_and_an_aircraft_can_be_chosen(tmp_path: Path) -> None:
    write_readsb(tmp_path / "trace.json", turning_climb(60.0))
    made = imported(tmp_path / "trace.json", from_s=10.0, until_s=40.0, only=[CALLSIGN.lower()])
    assert made.scenario.duration_s == 30.0
    with pytest.raises(AirhiltError, match="--only"):
        imported(tmp_path / "trace.json", only=["UAL1"])


def test_what_is_on_the_ground_is_in_a_scenario_of_an_airport_only(tmp_path: Path) -> None:
    flight = turning_climb(30.0)
    write_readsb(tmp_path / "trace.json", flight)
    document = json.loads((tmp_path / "trace.json").read_text())
    for point in document["trace"][20:]:
        point[3] = "ground"
    (tmp_path / "trace.json").write_text(json.dumps(document))
    en_route = imported(tmp_path / "trace.json")
    assert en_route.scenario.duration_s == 19.0
    assert en_route.notes == (f"{ADDRESS}: 11 positions on or below the ground are left out",)
    _, track = the_aircraft(imported(tmp_path / "trace.json", airport="LSZH"))
    assert track.points[-1][3] is None


def test_altitudes_rise_with_the_pressure_at_sea_level(tmp_path: Path) -> None:
    write_readsb(tmp_path / "trace.json", turning_climb(10.0))
    _, track = the_aircraft(imported(tmp_path / "trace.json", qnh_hpa=1023.25))
    assert track.points[0][3] == pytest.approx(20_000.0 + 273.0)


def test_the_same_file_gives_the_same_scenario(tmp_path: Path) -> None:
    write_readsb(tmp_path / "trace.json", turning_climb(60.0))
    assert imported(tmp_path / "trace.json") == imported(tmp_path / "trace.json")
