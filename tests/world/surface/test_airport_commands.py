"""The commands of ``airhilt airport``, and the diagram that they draw."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from PIL import Image
from shapely import LineString, Point

from airhilt.errors import ScenarioError
from airhilt.world.surface.airport import load_airport
from airhilt.world.surface.chart import draw
from airhilt.world.surface.layout import Layout

Cli = Callable[..., subprocess.CompletedProcess[str]]
FOLDER = Path(__file__).parent / "ourairports"
FILES = (
    "--runways",
    FOLDER / "runways.csv",
    "--frequencies",
    FOLDER / "airport-frequencies.csv",
)
SVG = "{http://www.w3.org/2000/svg}"
PLACE = re.compile(r"(?:translate\(|rotate\([^ ]+ )([-\d.]+) ([-\d.]+)\)")


@pytest.fixture(scope="module")
def washington() -> Layout:
    return Layout(load_airport("KDCA"))


def test_list_names_the_airports_with_their_runways(airhilt_command: Cli) -> None:
    done = airhilt_command("airport", "list")
    assert "KDCA  Ronald Reagan Washington National  01/19  04/22  15/33" in done.stdout
    rows = json.loads(airhilt_command("airport", "list", "--json").stdout)
    assert [row["icao"] for row in rows] == ["EHAM", "KDCA", "KSFO", "LSZH", "RJTT"]


def test_show_says_what_scenarios_can_name(airhilt_command: Cli) -> None:
    facts = json.loads(airhilt_command("airport", "show", "kdca", "--json").stdout)
    assert {"runway": "01/19", "taxiway": "A", "node": "01/19 A"} in facts["holds"]
    assert "gate_b12" in facts["stands"]
    assert ["01/19", "15/33"] in facts["intersections"]
    assert "01/19 crosses 15/33" in airhilt_command("airport", "show", "KDCA").stdout


def test_show_of_an_unknown_airport_gives_the_nearest(airhilt_command: Cli) -> None:
    done = airhilt_command("airport", "show", "KDCX")
    assert done.returncode == 2
    assert "did you mean 'kdca'" in done.stderr


def test_import_writes_a_file_that_show_reads(airhilt_command: Cli, tmp_path: Path) -> None:
    done = airhilt_command("airport", "import", "kpao", *FILES, "--name", "Palo Alto")
    assert (done.returncode, done.stdout) == (0, "kpao.json\n")
    assert "note: 13/31 is 2598 ft long by its coordinates" in done.stderr
    shown = airhilt_command("airport", "show", "kpao.json", "--out", "kpao.svg")
    assert shown.stdout == "kpao.svg\n"
    assert "Palo Alto" in (tmp_path / "kpao.svg").read_text(encoding="utf-8")


def test_import_replaces_a_file_only_when_told(airhilt_command: Cli, tmp_path: Path) -> None:
    (tmp_path / "kpao.json").write_text("mine")
    refused = airhilt_command("airport", "import", "KPAO", *FILES)
    assert refused.returncode == 2
    assert "kpao.json exists already; --overwrite replaces it" in refused.stderr
    assert (tmp_path / "kpao.json").read_text() == "mine"
    assert airhilt_command("airport", "import", "KPAO", *FILES, "--overwrite").returncode == 0


def test_help_does_not_wait_for_the_geometry_libraries() -> None:
    code = (
        "import sys, airhilt.cli.main; "
        "print([name for name in ('shapely', 'networkx', 'pygeomag') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


# --- the diagram ------------------------------------------------------------------------------


def drawn(layout: Layout, folder: Path) -> ET.Element:
    return ET.fromstring(draw(layout, folder / "drawn.svg").read_bytes())


def texts_of(diagram: ET.Element) -> dict[str | None, tuple[float, float]]:
    """Return where each text stands."""
    return {
        text.text: (float(at[1]), float(at[2]))
        for text in diagram.iter(f"{SVG}text")
        if (at := PLACE.search("".join(text.attrib.values())))
    }


def test_the_diagram_names_runways_taxiways_holds_and_cameras(
    washington: Layout, tmp_path: Path
) -> None:
    diagram = drawn(washington, tmp_path)
    texts = set(texts_of(diagram))
    titles = {element.text for element in diagram.iter(f"{SVG}title")}
    assert {"01", "19", "15", "33", "04", "22", "J", "K", "A", "500 m, 1640 ft", "N"} <= texts
    assert {"Potomac River", "Terminal 2", "gate_b12", "tower", "tower_east"} <= texts | titles
    assert {f"hold {name}" for name in washington.holds} <= titles
    assert "01/19 crosses 15/33" in titles
    assert any("drawn or generated: buildings, cameras, holds, taxiways" in (text or "")
               for text in texts)  # fmt: skip


def test_north_is_up_and_the_terminal_is_west_of_runway_01(
    washington: Layout, tmp_path: Path
) -> None:
    at = texts_of(drawn(washington, tmp_path))
    assert at["19"][1] < at["01"][1]
    assert at["Terminal 1"][0] < at["01"][0] < at["Potomac River"][0]


def test_every_airport_can_be_drawn(subtests: pytest.Subtests, tmp_path: Path) -> None:
    for icao in ["EHAM", "KSFO", "LSZH", "RJTT"]:
        with subtests.test(icao):
            layout = Layout(load_airport(icao))
            ends = {end.ident for strip in layout.strips.values() for end in strip.ends}
            assert ends <= set(texts_of(drawn(layout, tmp_path)))


def test_a_name_that_ends_in_png_gets_a_picture(washington: Layout, tmp_path: Path) -> None:
    with Image.open(draw(washington, tmp_path / "kdca.png")) as picture:
        assert picture.size == (1720, 2296)
        north = picture.convert("RGB").getpixel((1640, 252))
        assert north == (0x1B, 0x2A, 0x36)


def test_letters_of_taxiways_that_cross_a_runway_stand_beside_it(
    washington: Layout, tmp_path: Path
) -> None:
    at = texts_of(drawn(washington, tmp_path))
    runway = LineString([at["01"], at["19"]])
    assert min(runway.distance(Point(at[name])) for name in "ABDEFMN") > 18.0


def test_other_formats_are_refused(washington: Layout, tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"kdca\.pdf: expected a name that ends in \.svg or"):
        draw(washington, tmp_path / "kdca.pdf")


def test_a_folder_that_does_not_exist_is_named(washington: Layout, tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"kdca\.svg: cannot be written: No such file"):
        draw(washington, tmp_path / "gone" / "kdca.svg")
