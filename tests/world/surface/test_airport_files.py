"""The airports that ship, and what is refused of an airport file."""

from __future__ import annotations

import json
import math
import runpy
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError
from shapely import Point

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.units import FOOT
from airhilt.world.surface.airport import Airport, load_airport, read_airport
from airhilt.world.surface.draft import as_text
from airhilt.world.surface.importer import import_airport
from airhilt.world.surface.layout import Layout
from paths import ROOT

RUNWAYS = Path(__file__).parent / "ourairports" / "runways.csv"
FREQUENCIES = Path(__file__).parent / "ourairports" / "airport-frequencies.csv"
SHIPPED = ("EHAM", "KDCA", "KSFO", "LSZH", "RJTT")
PUBLISHED_FT = {
    "KSFO": {"01L": 7650, "01R": 8660, "10L": 11870, "10R": 11381},
    "EHAM": {"04": 6627, "09": 11329, "18C": 10826, "18L": 11155, "18R": 12467},
    "LSZH": {"10": 8202, "14": 10827, "16": 12139},
    "RJTT": {"04": 8202, "05": 8202, "16L": 11024},
    "KDCA": {"15": 5204},
}
"""Lengths that OurAirports gives where its coordinates do not contradict them."""
TRUE_DEG = {
    "KSFO": {"28L": 297.8, "19R": 207.8},
    "EHAM": {"18R": 183.2, "06": 57.9},
    "LSZH": {"14": 137.2, "34": 335.0},
    "RJTT": {"05": 42.6, "34L": 329.9},
    "KDCA": {"01": 355.5, "19": 175.5, "15": 142.7, "22": 205.9},
}


@pytest.fixture
def document() -> dict[str, Any]:
    kdca: dict[str, Any] = json.loads(library.find("airports", "kdca").read_text(encoding="utf-8"))
    return kdca


def refused(document: dict[str, Any], folder: Path) -> str:
    path = folder / "changed.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(ScenarioError) as caught:
        read_airport(path)
    return str(caught.value)


def test_the_five_airports_ship() -> None:
    assert library.names("airports") == [name.lower() for name in SHIPPED]


@pytest.mark.parametrize("name", ["KDCA", "kdca", "Kdca"])
def test_an_airport_is_found_in_upper_and_lower_case(name: str) -> None:
    assert load_airport(name).icao == "KDCA"


def test_an_unknown_airport_gets_the_nearest_name() -> None:
    with pytest.raises(ScenarioError, match="did you mean 'kdca'"):
        load_airport("KDCB")


def test_runways_are_as_long_as_published(subtests: pytest.Subtests) -> None:
    for icao in SHIPPED:
        with subtests.test(icao):
            layout = Layout(load_airport(icao))
            for ident, feet in PUBLISHED_FT[icao].items():
                assert layout.runway(ident).length_m == pytest.approx(feet * FOOT, abs=8.0), ident


def test_courses_come_from_the_coordinates(subtests: pytest.Subtests) -> None:
    for icao in SHIPPED:
        with subtests.test(icao):
            layout = Layout(load_airport(icao))
            for ident, course in TRUE_DEG[icao].items():
                assert math.degrees(layout.runway(ident).course_rad) == pytest.approx(
                    course, abs=0.1
                )


def test_runway_numbers_are_the_magnetic_headings_in_tens_of_degrees(
    subtests: pytest.Subtests,
) -> None:
    for icao in SHIPPED:
        with subtests.test(icao):
            for runway in load_airport(icao).runways:
                for end in runway.ends:
                    assert end.heading_magnetic_deg is not None
                    number = float(end.ident[:2]) * 10.0
                    away = (end.heading_magnetic_deg - number + 180.0) % 360.0 - 180.0
                    assert abs(away) < 10.5, end.ident


def test_lengths_that_contradict_the_coordinates_are_noted() -> None:
    note = load_airport("KDCA").sources["runways"].note
    assert (
        "01/19 is 6868 ft long by its coordinates, which are used, and 7169 ft as published" in note
    )


def test_magnetic_variation_is_that_of_the_world_magnetic_model(subtests: pytest.Subtests) -> None:
    for icao, east_deg in [
        ("KDCA", -10.7),
        ("KSFO", 12.95),
        ("EHAM", 2.43),
        ("RJTT", -7.81),
        ("LSZH", 3.43),
    ]:
        with subtests.test(icao):
            variation = load_airport(icao).magnetic_variation
            assert variation.epoch == 2025.0
            assert variation.east_deg == pytest.approx(east_deg, abs=0.05)


def test_what_nobody_surveyed_says_so() -> None:
    for icao in SHIPPED:
        sources = load_airport(icao).sources
        assert {name for name in ("taxiways", "holds", "cameras") if sources[name].synthetic} == {
            "taxiways",
            "holds",
            "cameras",
        }
        assert not sources["runways"].synthetic


def test_washington_tower_and_ground_are_on_their_frequencies() -> None:
    frequencies = {(item.role, item.frequency_khz) for item in load_airport("KDCA").frequencies}
    assert {("tower", 119_100), ("ground", 121_700), ("atis", 132_650)} <= frequencies


def test_imported_airports_are_what_the_importer_makes(subtests: pytest.Subtests) -> None:
    for icao, name in [
        ("KSFO", "San Francisco International"),
        ("EHAM", "Amsterdam Schiphol"),
        ("RJTT", "Tokyo Haneda"),
        ("LSZH", "Zürich"),
    ]:
        with subtests.test(icao):
            made = import_airport(icao, RUNWAYS, FREQUENCIES, name=name, year=2025.0)
            assert as_text(made) == library.find("airports", icao.lower()).read_text(
                encoding="utf-8"
            )


def test_washington_is_what_its_tool_makes(tmp_path: Path) -> None:
    out = tmp_path / "kdca.json"
    tool = runpy.run_path(str(ROOT / "tools" / "make" / "kdca.py"))
    tool["main"](str(RUNWAYS), str(FREQUENCIES), str(out))
    assert out.read_bytes() == library.find("airports", "kdca").read_bytes()


def test_a_file_that_is_read_and_written_again_stays_the_same() -> None:
    for icao in SHIPPED:
        path = library.find("airports", icao.lower())
        assert as_text(load_airport(icao)) == path.read_text(encoding="utf-8")


def test_the_example_of_the_guide_is_an_airport(tmp_path: Path) -> None:
    guide = (ROOT / "docs" / "airports.md").read_text(encoding="utf-8")
    path = tmp_path / "example.json"
    path.write_text(guide.split("```json\n")[1].split("```")[0], encoding="utf-8")
    layout = Layout(read_airport(path))
    hold = layout.hold("18", "A")
    assert hold.heading_rad == pytest.approx(math.pi / 2.0, abs=1e-3)
    strip = layout.strips["18/36"]
    assert (
        strip.protected_area.exterior.distance(Point(layout.local_frame.to_local(hold.place))) < 0.1
    )


def test_unknown_fields_are_refused_with_their_place(
    document: dict[str, Any], tmp_path: Path
) -> None:
    document["runways"][0]["colour"] = "black"
    assert "runways/0/colour" in refused(document, tmp_path)


def test_an_edge_to_a_node_that_does_not_exist_is_refused(
    document: dict[str, Any], tmp_path: Path
) -> None:
    document["taxiways"]["edges"][0]["nodes"][0] = "J/Q"
    assert "no node named 'J/Q'; did you mean" in refused(document, tmp_path)


def test_a_hold_at_a_runway_that_does_not_exist_is_refused(
    document: dict[str, Any], tmp_path: Path
) -> None:
    document["holds"][0]["runway"] = "09/27"
    assert "(top): no runway named '09/27'; did you mean '04/22'?" in refused(document, tmp_path)


def test_two_nodes_of_one_name_are_refused(document: dict[str, Any], tmp_path: Path) -> None:
    document["taxiways"]["nodes"].append(document["taxiways"]["nodes"][0])
    assert "more than one node named J/A" in refused(document, tmp_path)


def test_numbers_without_a_source_are_refused(document: dict[str, Any], tmp_path: Path) -> None:
    del document["sources"]["runways"]
    assert "sources does not say where the numbers of runways are from" in refused(
        document, tmp_path
    )


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"gone\.json: cannot be read: No such file"):
        read_airport(tmp_path / "gone.json")


BOUNDED = (
    "elevation_ft", "reference.lat_deg", "magnetic_variation.east_deg",
    "magnetic_variation.epoch", "runways.0.width_ft", "runways.0.hold_distance_m",
    "runways.0.ends.0.elevation_ft", "runways.0.ends.1.displaced_threshold_ft",
    "taxiways.edges.0.width_m", "tower.height_m", "buildings.0.height_m",
    "frequencies.0.frequency_khz", "cameras.0.height_m", "cameras.0.elevation_deg",
)  # fmt: skip


@pytest.mark.parametrize("given", [True, "19", 1e308, -1e308])
def test_numbers_are_strict_and_have_bounds(document: dict[str, Any], given: Any) -> None:
    for place in BOUNDED:
        *folders, name = place.split(".")
        inner: Any = document
        for part in folders:
            inner = inner[int(part)] if part.isdecimal() else inner[part]
        inner[name] = given
    with pytest.raises(ValidationError) as caught:
        Airport.model_validate(document)
    assert set(BOUNDED) <= {".".join(map(str, one["loc"])) for one in caught.value.errors()}


def test_an_airport_lies_around_its_reference_point(
    document: dict[str, Any], tmp_path: Path
) -> None:
    for lat_deg, lon_deg in [(0.0, 0.0), (-38.85, 102.96)]:
        document["runways"][0]["ends"][0] |= {"lat_deg": lat_deg, "lon_deg": lon_deg}
        assert "is not near the reference point" in refused(document, tmp_path)


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"[" * 100_000, "nested too deeply"), (b'{"icao": "\xff"}', "not UTF-8"), (b"{", "JSON")],
)
def test_a_file_that_is_no_json_within_limits_is_refused(
    tmp_path: Path, content: bytes, said: str
) -> None:
    path = tmp_path / "mine.json"
    path.write_bytes(content)
    with pytest.raises(ScenarioError, match=said):
        read_airport(path)
