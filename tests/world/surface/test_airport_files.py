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


def test_an_airport_is_found_in_upper_and_lower_case() -> None:
    assert load_airport("KDCA") == load_airport("kdca")


def test_runways_are_as_long_as_published(subtests: pytest.Subtests) -> None:
    for icao in SHIPPED:
        with subtests.test(icao):
            layout = Layout(load_airport(icao))
            for ident, feet in PUBLISHED_FT[icao].items():
                assert layout.runway(ident).length_m == pytest.approx(feet * FOOT, abs=8.0), ident


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


def test_what_nobody_surveyed_says_so() -> None:
    for icao in SHIPPED:
        sources = load_airport(icao).sources
        assert all(sources[name].synthetic for name in ("taxiways", "holds", "cameras"))
        assert not sources["runways"].synthetic


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


def test_what_does_not_fit_together_is_refused_with_its_place(
    document: dict[str, Any], tmp_path: Path, subtests: pytest.Subtests
) -> None:
    def misname_runway(airport: Any) -> None:
        airport["runways"][0]["colour"] = "black"

    def misname_node(airport: Any) -> None:
        airport["taxiways"]["edges"][0]["nodes"][0] = "J/Q"

    def misplace_hold(airport: Any) -> None:
        airport["holds"][0]["runway"] = "09/27"

    def repeat_node(airport: Any) -> None:
        airport["taxiways"]["nodes"].append(airport["taxiways"]["nodes"][0])

    def forget_source(airport: Any) -> None:
        del airport["sources"]["runways"]

    for change, told in [
        (misname_runway, "runways/0/colour: unknown field"),
        (misname_node, "(top): no node named 'J/Q'; did you mean"),
        (misplace_hold, "(top): no runway named '09/27'; did you mean '04/22'?"),
        (repeat_node, "more than one node named J/A"),
        (forget_source, "sources does not say where the numbers of runways are from"),
    ]:
        with subtests.test(told):
            changed = json.loads(json.dumps(document))
            change(changed)
            assert told in refused(changed, tmp_path)


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
