"""Airports made from OurAirports, whole and damaged."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
import shapely

from airhilt.errors import ScenarioError
from airhilt.world.surface.airport import Airport, read_airport
from airhilt.world.surface.draft import write_airport
from airhilt.world.surface.importer import import_airport
from airhilt.world.surface.layout import Layout
from airhilt.world.surface.ourairports import HOLD_DISTANCE_FAA_M
from airhilt.world.surface.taxiways import TOUCHES_M
from breadth import mostly_slow

FOLDER = Path(__file__).parent / "ourairports"
RUNWAYS, FREQUENCIES = FOLDER / "runways.csv", FOLDER / "airport-frequencies.csv"
ROWS = list(csv.DictReader(RUNWAYS.read_text(encoding="utf-8").splitlines()))
IDENTS = sorted({row["airport_ident"] for row in ROWS})


def imported(ident: str, runways: Path = RUNWAYS, frequencies: Path = FREQUENCIES) -> Airport:
    return import_airport(ident, runways, frequencies, year=2025.0)


def rewritten(
    folder: Path,
    changes: dict[str, str],
    ident: str = "KPAO",
    *,
    separator: str = ",",
    columns: list[str] | None = None,
) -> Path:
    """Return a file with the rows of one airport, changed."""
    path = folder / "runways.csv"
    names = columns or list(ROWS[0])
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, names, delimiter=separator, extrasaction="ignore")
        writer.writeheader()
        writer.writerows({**row, **changes} for row in ROWS if row["airport_ident"] == ident)
    return path


# --- all of them ------------------------------------------------------------------------------


@pytest.mark.parametrize("ident", mostly_slow(IDENTS, "LSZH", "RJTT"))
def test_every_airport_becomes_one_on_which_aircraft_can_taxi(ident: str, tmp_path: Path) -> None:
    path = tmp_path / "made.json"
    write_airport(imported(ident), path)
    layout = Layout(read_airport(path))
    stand = layout.stands[0]
    for strip in layout.strips.values():
        holds = [name for name, hold in layout.holds.items() if hold.runway == strip.name]
        assert len(holds) >= 2, strip.name
        for name in holds:
            assert layout.taxi_route(stand, name)
        for end in strip.ends:
            assert layout.exits(end.ident), end.ident


def test_taxiways_enter_protected_areas_only_past_a_hold(subtests: pytest.Subtests) -> None:
    for ident in IDENTS:
        with subtests.test(ident):
            airport = imported(ident)
            layout = Layout(airport)
            kinds = {node.name: node.kind for node in airport.taxiways.nodes}
            protected = shapely.union_all(
                [strip.protected_area for strip in layout.strips.values()]
            )
            for edge in airport.taxiways.edges:
                line = shapely.LineString([layout.taxiways.nodes[node] for node in edge.nodes])
                enters = line.intersection(protected).length > TOUCHES_M
                assert enters == (sorted(kinds[node] for node in edge.nodes) == ["hold", "runway"])


def test_american_holds_are_at_250_feet_and_others_at_90_metres() -> None:
    assert {runway.hold_distance_m for runway in imported("KSFO").runways} == {HOLD_DISTANCE_FAA_M}
    assert {runway.hold_distance_m for runway in imported("EHAM").runways} == {90.0}
    assert {runway.hold_distance_m for runway in imported("KPAO").runways} == {30.0}


def test_what_is_not_for_aeroplanes_is_left_out_and_noted() -> None:
    assert "left out H1/H1: closed" in imported("KLGA").sources["runways"].note
    assert "left out 17R/35L: closed" in imported("LIML").sources["runways"].note
    assert "left out 01H/19H: for helicopters" in imported("LSZH").sources["runways"].note


def test_runway_numbers_get_their_leading_zero() -> None:
    assert [runway.name for runway in imported("KTEB").runways] == ["01/19", "06/24"]


# --- damaged files ----------------------------------------------------------------------------


def test_an_unknown_airport_gets_the_nearest_identifier() -> None:
    with pytest.raises(ScenarioError, match="no airport 'LSZG'; did you mean 'LSZH'"):
        imported("LSZG")


def test_a_missing_column_is_named_with_those_that_exist(tmp_path: Path) -> None:
    columns = [name for name in ROWS[0] if name != "he_longitude_deg"]
    with pytest.raises(
        ScenarioError, match="has no column he_longitude_deg; it has id, airport_ref"
    ):
        imported("KPAO", rewritten(tmp_path, {}, columns=columns))


def test_a_file_that_is_something_else_is_named(tmp_path: Path) -> None:
    picture = tmp_path / "picture.csv"
    picture.write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(ScenarioError, match=r"picture\.csv: is not UTF-8 text"):
        imported("KPAO", picture)
    with pytest.raises(ScenarioError, match=r"gone\.csv: cannot be read"):
        imported("KPAO", tmp_path / "gone.csv")


def test_a_file_that_is_too_large_or_no_table_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "runways.csv"
    for text, answer in [
        ("\n" * 50_000_001, "has over 50,000,000 bytes"),
        (",".join(ROWS[0]) + "\n" * 200_002, "found over 200,000 lines"),
        (f"{','.join(ROWS[0])}\n{'a' * 200_000}", "no CSV"),
    ]:
        path.write_text(text)
        with pytest.raises(ScenarioError, match=rf"runways\.csv: .*{answer}"):
            imported("KPAO", path)


def test_a_table_may_have_semicolons_and_a_byte_order_mark(tmp_path: Path) -> None:
    usual = imported("kpao")
    assert imported("KPAO", rewritten(tmp_path, {}, separator=";")) == usual
    path = tmp_path / "runways.csv"
    path.write_text(RUNWAYS.read_text(encoding="utf-8"), encoding="utf-8-sig")
    assert imported("KPAO", path) == usual
    names = {item.name for item in imported("KDCA").frequencies}
    assert "Washington Tower ;Helicopters" in names


def test_a_missing_elevation_is_that_of_the_others(tmp_path: Path) -> None:
    airport = imported("KPAO", rewritten(tmp_path, {"le_elevation_ft": ""}))
    assert airport.runways[0].ends[0].elevation_ft == 6.0
    assert "13 has no elevation" in airport.sources["runways"].note


def test_an_airport_without_any_elevation_is_refused(tmp_path: Path) -> None:
    path = rewritten(tmp_path, {"le_elevation_ft": "", "he_elevation_ft": ""})
    with pytest.raises(ScenarioError, match="gives no elevation for any runway of KPAO"):
        imported("KPAO", path)


def test_empty_width_and_heading_are_made_good(tmp_path: Path) -> None:
    path = rewritten(tmp_path, {"width_ft": "", "le_heading_degT": "", "he_heading_degT": ""})
    airport = imported("KPAO", path)
    assert airport.runways[0].width_ft == 100.0
    assert airport.runways[0].ends[0].heading_magnetic_deg == pytest.approx(125.0, abs=0.3)
    assert "13/31 has no width, 100 ft is used" in airport.sources["runways"].note


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"closed": "1"}, "closed"),
        ({"le_ident": "H1", "he_ident": "H1"}, "for helicopters"),
        ({"le_ident": "N", "he_ident": "S"}, "has no runway number"),
        ({"le_ident": "", "he_ident": ""}, "has no runway number"),
        ({"le_latitude_deg": ""}, "has no coordinates"),
        ({"le_latitude_deg": "nan"}, "has no coordinates"),
    ],
)
def test_an_airport_without_a_usable_runway_is_refused(
    tmp_path: Path, changes: dict[str, str], reason: str
) -> None:
    with pytest.raises(ScenarioError, match=f"no usable runway at KPAO: left out .*: {reason}"):
        imported("KPAO", rewritten(tmp_path, changes))


def test_thresholds_displaced_beyond_the_runway_are_refused(tmp_path: Path) -> None:
    path = rewritten(tmp_path, {"le_displaced_threshold_ft": "9000"})
    with pytest.raises(
        ScenarioError, match="runway 13/31 has thresholds that are displaced beyond"
    ):
        imported("KPAO", path)


@pytest.mark.parametrize(
    ("changes", "answer"),
    [
        ({"le_latitude_deg": "4000"}, r"le of runway 13/31 of KPAO: lat_deg: found 4000\.0: "),
        ({"he_elevation_ft": "1e30"}, r"he of runway 13/31 of KPAO: elevation_ft: found 1e\+30: "),
        ({"width_ft": "-150"}, r"runway 13/31 of KPAO: width_ft: found -150\.0: .* greater than 0"),
        ({"surface": "x" * 3000}, "surface: found .*: string should have at most 2000"),
        ({"he_latitude_deg": "0"}, "m long by its coordinates; expected at most 20000 m"),
    ],
)
def test_an_impossible_field_is_named_in_one_line(
    tmp_path: Path, changes: dict[str, str], answer: str
) -> None:
    with pytest.raises(ScenarioError, match=rf"runways\.csv: .*{answer}") as caught:
        imported("KPAO", rewritten(tmp_path, changes))
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400


def test_a_frequency_that_no_radio_has_is_named(tmp_path: Path) -> None:
    path = tmp_path / "frequencies.csv"
    path.write_text("airport_ident,type,description,frequency_mhz\nKPAO,TWR,T,5.6\n")
    with pytest.raises(ScenarioError, match="a frequency of KPAO: frequency_khz: found 5600"):
        imported("KPAO", frequencies=path)


def test_a_table_may_be_wide_and_one_airport_has_few_rows(tmp_path: Path) -> None:
    head, *rows = RUNWAYS.read_text(encoding="utf-8").splitlines()
    row = next(each for each in rows if "KPAO" in each)
    path = tmp_path / "runways.csv"
    path.write_text(f"{head}{',more' * 100_000}\n{row}{',1' * 100_000}\n")
    assert imported("KPAO", path) == imported("KPAO")
    path.write_text("\n".join([head, *[row] * 51]))
    with pytest.raises(ScenarioError, match="found over 50 rows of KPAO; expected fewer"):
        imported("KPAO", path)


def test_an_airport_without_frequencies_has_none(tmp_path: Path) -> None:
    path = tmp_path / "frequencies.csv"
    path.write_text("airport_ident,type,description,frequency_mhz\nKPAO,TWR,Türm,\n", "utf-8")
    assert imported("KPAO", frequencies=path).frequencies == ()


def test_the_magnetic_variation_can_be_stated() -> None:
    airport = import_airport("KPAO", RUNWAYS, FREQUENCIES, year=2031.0, variation_deg=13.5)
    assert airport.magnetic_variation.east_deg == 13.5
    assert airport.sources["magnetic_variation"].text == "Stated by the user"


def test_a_year_beyond_the_magnetic_model_is_refused() -> None:
    with pytest.raises(ScenarioError, match="covers 2025 to 2030; state the variation itself"):
        import_airport("KPAO", RUNWAYS, FREQUENCIES, year=2031.0)
