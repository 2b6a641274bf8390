"""Kinds are found by their name: files of the package, and entry points of other packages."""

from __future__ import annotations

import importlib
import math
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

import pytest

from airhilt.errors import ScenarioError
from airhilt.geodesy.local_frame import LocalFrame
from airhilt.world.surface import kinds
from airhilt.world.surface.kinds import FAMILY, load_kind
from paths import DOCS

GUIDE = DOCS / "actors.md"
HERE = (math.radians(38.8521), math.radians(-77.0377))
THERE = LocalFrame(HERE, 0.0).to_place(60.0, 80.0)


@pytest.fixture
def bus_and_drone() -> tuple[str, str]:
    """The files that the guide shows."""
    bus, _, drone = re.findall(r"```python\n(.*?)```", GUIDE.read_text(), flags=re.DOTALL)
    return bus, drone


@pytest.fixture
def added(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder whose files are as good as files of the package."""
    monkeypatch.setattr(kinds, "__path__", [*kinds.__path__, str(tmp_path)])
    yield tmp_path
    for path in tmp_path.glob("*.py"):
        sys.modules.pop(f"{kinds.__name__}.{path.stem}", None)


@pytest.fixture
def other_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder on the path of Python with an installed package that declares a drone."""
    package = tmp_path / "my_package"
    package.mkdir()
    (package / "__init__.py").touch()
    installed = tmp_path / "my_package-1.0.dist-info"
    installed.mkdir()
    (installed / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1.0\n")
    (installed / "entry_points.txt").write_text("[airhilt.kinds]\ndrone = my_package.drone:KIND\n")
    monkeypatch.syspath_prepend(tmp_path)
    yield package
    for name in [name for name in sys.modules if name.split(".")[0] == "my_package"]:
        del sys.modules[name]


def test_all_kinds_have_a_file_and_say_where_their_numbers_come_from() -> None:
    folder = Path(kinds.__path__[0])
    files = {path.stem for path in folder.glob("*.py")} - {"__init__"}
    assert set(FAMILY.names()) >= files
    for name in files:
        kind = load_kind(name)
        assert kind.name == name
        assert "estimate" in cast(Any, kind).source


def test_an_unknown_kind_is_told_with_the_nearest_that_there_is() -> None:
    with pytest.raises(ScenarioError, match="no kind named 'firetruck'; did you mean 'fire_truck'"):
        load_kind("firetruck")


def test_a_deer_is_no_vehicle() -> None:
    with pytest.raises(
        ScenarioError, match="'deer' is a kind of wildlife; expected one of vehicle"
    ):
        load_kind("deer", "vehicle")


def test_a_file_is_all_that_a_new_kind_needs(added: Path, bus_and_drone: tuple[str, str]) -> None:
    (added / "bus.py").write_text(bus_and_drone[0])
    assert "bus" in FAMILY.names()
    bus = load_kind("bus", "vehicle").create(HERE, 0.0, ground_m=0.0, tick_s=0.05)
    bus.drive([THERE])
    for _ in range(2000):
        bus.advance()
    assert bus.phase == "standing"
    assert (bus.state.latitude_rad, bus.state.longitude_rad) == pytest.approx(THERE, abs=1e-10)


def test_what_is_no_kind_is_refused_with_the_reason(
    other_package: Path, subtests: pytest.Subtests
) -> None:
    lacking = """
class Drone:
    name, category, label, emitter_category = 'drone', 'vehicle', 'drone', 'B6'
    radar_cross_section_m2, understands, dimensions = 0.01, (), None
    def create(self): ...
    def mesh_of(self): ...
KIND = Drone()
"""
    for text, told in [
        ("import no_such_module\n", r"my_package\.drone:KIND: ModuleNotFoundError"),
        (lacking, "has no appearance, carry_out, command_for$"),
        ("KIND = 42\n", "no kind named 'drone': 42"),
    ]:
        sys.modules.pop("my_package.drone", None)
        (other_package / "drone.py").write_text(text)
        importlib.invalidate_caches()
        with subtests.test(told), pytest.raises(ScenarioError, match=told):
            load_kind("drone")


def test_a_kind_goes_by_no_other_name_than_its_own(
    added: Path, bus_and_drone: tuple[str, str]
) -> None:
    (added / "coach.py").write_text(bus_and_drone[0])
    with pytest.raises(ScenarioError, match="no kind named 'coach'"):
        load_kind("coach")


def test_two_kinds_of_one_name_are_refused(
    added: Path, other_package: Path, bus_and_drone: tuple[str, str]
) -> None:
    for folder in (added, other_package):
        (folder / "drone.py").write_text(bus_and_drone[1])
    with pytest.raises(ScenarioError, match="more than one kind named 'drone'"):
        load_kind("drone")


def test_the_guide_lists_all_kinds() -> None:
    table = GUIDE.read_text().split("|---|---|", 1)[1].split("\n\n")[0]
    folder = Path(kinds.__path__[0])
    assert set(re.findall(r"`(\w+)`", table)) == {
        path.stem for path in folder.glob("*.py") if path.stem != "__init__"
    }
