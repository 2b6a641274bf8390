"""The aircraft files are complete, and a wrong one is told what is wrong with it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pydantic
import pytest

from airhilt.errors import ScenarioError
from airhilt.host import library
from airhilt.world.flight import load_aircraft_type
from airhilt.world.flight.aircraft_type import AircraftType


@pytest.fixture
def wrong(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Write a changed 737 as the aircraft ``wrong``."""
    content = json.loads(library.find("aircraft", "737").read_text())

    def write(change: Callable[..., Any]) -> None:
        change(content)
        (tmp_path / "wrong.json").write_text(json.dumps(content))
        monkeypatch.setattr(library, "folder", lambda kind: tmp_path)

    return write


def test_every_type_is_there(subtests: pytest.Subtests) -> None:
    for name, designator in [
        ("737", "B737"),
        ("B747", "B744"),
        ("c172p", "C172"),
        ("c310", "C310"),
    ]:
        with subtests.test(name):
            kind = load_aircraft_type(name)
            assert kind.name == name
            assert kind.icao_designator == designator
            assert kind.speeds.minimum_clean_kt < kind.speeds.cruise_kt < kind.speeds.maximum_kt


def test_a_misspelt_name_gets_the_nearest() -> None:
    with pytest.raises(ScenarioError, match="did you mean 'B747'"):
        load_aircraft_type("b74")


def test_a_missing_field_is_named_with_its_place(wrong: Callable[..., Any]) -> None:
    wrong(lambda content: content["speeds"].pop("cruise_kt"))
    with pytest.raises(ScenarioError, match=r"wrong.json: speeds/cruise_kt: missing"):
        load_aircraft_type("wrong")


def test_an_unknown_field_is_refused(wrong: Callable[..., Any]) -> None:
    wrong(lambda content: content["gains"]["pitch"].update(gain=1.0))
    with pytest.raises(ScenarioError, match=r"gains/pitch/gain: unknown field"):
        load_aircraft_type("wrong")


def test_a_value_out_of_range_is_refused(wrong: Callable[..., Any]) -> None:
    wrong(lambda content: content["dimensions"].update(span_m=-1.0))
    with pytest.raises(
        ScenarioError, match=r"dimensions/span_m: found -1.0: input should be greater than 0"
    ):
        load_aircraft_type("wrong")


def numbers(value: Any, *place: str | int) -> Iterator[tuple[str | int, ...]]:
    """Yield the place of each number in a document."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        for name, inner in items:
            yield from numbers(inner, *place, name)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield place


def test_every_number_is_strict_and_has_bounds(subtests: pytest.Subtests) -> None:
    for given in [True, "190", 1e308, -1e308]:
        with subtests.test(str(given)):
            whole = json.loads(library.find("aircraft", "737").read_text())
            places = list(numbers(whole))
            assert len(places) > 60
            for place in places:
                content = json.loads(json.dumps(whole))
                inner = content
                for name in place[:-1]:
                    inner = inner[name]
                inner[place[-1]] = given
                with pytest.raises(ScenarioError, match=re.escape("/".join(map(str, place)))):
                    load_aircraft_type("mine.json", {"mine.json": content})


LIMITS: dict[tuple[float, float, bool, bool], tuple[str, ...]] = {
    # The least and the greatest number, whether each of them is taken, and ends of names.
    (0.0, 1000.0, False, True): (
        "_kt", "attitude_per_s", "roll.bank_per_s", "thrust.lever_rate_per_s",
        "course_per_s", "altitude_per_s", "glide_per_s", "ground.yaw_rate_s",
        "flare.time_constant_s", "flare.climb",
    ),
    (0.0, 20000.0, False, True): ("_fpm",),
    (0.0, 100000.0, False, True): (
        "speeds.service_ceiling_ft", "reference_pressure_pa", "look_ahead_m",
        "landing.aim_m", "landing.configure_m",
    ),
    (0.0, 5.0, False, True): ("speeds.maximum_mach",),
    (-90.0, 90.0, True, True): ("zero_lift_angle_deg",),
    (0.0, 45.0, False, True): ("bank_limit_deg",),
    (0.0, 90.0, False, False): ("ground.nose_wheel_limit_deg",),
    (0.0, 90.0, False, True): ("_contact_deg", "takeoff.pitch_deg", "model_nose_wheel_deg"),
    (0.0, 180.0, False, True): ("_deg_s",),
    (0.0, 50.0, False, True): ("deceleration_m_s2",),
    (0.0, 1000.0, True, True): (
        "decrab_height_m", "pitch.rate_s", "roll.rate_s", "yaw.rate_s", "climb_rate_s",
        "_integral", "_integral_per_s", "_integral_m", "yaw.sideslip", "speed_s_m",
        "acceleration_s2_m", "thrust.climb_angle",
    ),
    (0.0, 1.0, True, False): ("idle_height_part", "takeoff.pull"),
    (0.0, 1.0, True, True): (".flaps",),
    (0.0, 1.0, False, True): ("lever",),
}  # fmt: skip


def test_a_number_is_taken_up_to_its_limits_and_no_further() -> None:
    """No divisor may be 0, and a gain may; each number ends where no aircraft has it any more."""
    whole = json.loads(library.find("aircraft", "737").read_text())
    places = [place for place in numbers(whole) if place[0] not in ("dimensions", "mesh", "rates")]
    limits = {}
    for place in places:
        name = ".".join(map(str, place))
        (limits[place],) = (bounds for bounds, ends in LIMITS.items() if name.endswith(ends))

    def is_taken(place: tuple[str | int, ...], given: float) -> bool:
        content = json.loads(json.dumps(whole))
        inner = content
        for name in place[:-1]:
            inner = inner[name]
        inner[place[-1]] = given
        try:
            AircraftType.model_validate(content)
        except pydantic.ValidationError as error:
            return [each["loc"] for each in error.errors()] != [place]
        return True

    for place, (least, greatest, has_least, has_greatest) in limits.items():
        taken = [is_taken(place, each) for each in (least, least + 1e-6, least - 1e-6)]
        assert (place, taken) == (place, [has_least, True, False])
        taken = [is_taken(place, each) for each in (greatest, greatest - 1e-6, greatest + 1e-6)]
        assert (place, taken) == (place, [has_greatest, True, False])


def test_a_file_that_is_nested_too_deeply_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "wrong.json").write_text("[" * 100_000)
    monkeypatch.setattr(library, "folder", lambda kind: tmp_path)
    with pytest.raises(ScenarioError, match="nested too deeply"):
        load_aircraft_type("wrong")
