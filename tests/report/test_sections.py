"""The page is made of sections, and other packages add theirs."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from airhilt.report import write_report
from airhilt.report.assembly import inline
from engine_package import installed
from paths import DOCS
from radio_folder import RadioFolder
from report_pages import shown as data

HOSTILE = "</script><script>alert(1)</script><!-- <img src=x onerror=alert(2)>"
MODULE = """
from airhilt.report.sections import Content, Section


class Speakers(Content):
    def __init__(self, folder):
        super().__init__(folder)
        self._keys = []

    def take(self, logged):
        self._keys.append(logged.key)

    def as_json(self, run):
        run.notes.append("speakers were counted")
        return {"keys": self._keys, "text": %r}


ENGINE = Section(
    "speakers", order=45, module=__file__, content=Speakers, keys=("truth/radio/",)
)
"""
TEMPLATE = "<section id='speakers'>{{ data.text }} in {{ run.run }}</section>"
SCRIPT = """
return {
  draw() {
    byId("speakers").append(html("p", { id: "spoke" }, `${data.keys.length} calls`));
    return (t) => byId("spoke").setAttribute("data-shown", t);
  },
};
"""


@pytest.fixture
def speakers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Install a package with a section, and return its folder."""
    folder = tmp_path / "packages"
    folder.mkdir()
    group = "airhilt.report_sections"
    with installed(folder, monkeypatch, group, "speakers", MODULE % HOSTILE) as package:
        (folder / f"{package}.html").write_text(TEMPLATE)
        (folder / f"{package}.js").write_text(SCRIPT)
        yield folder


@pytest.fixture
def run_folder(tmp_path: Path) -> Path:
    return RadioFolder(tmp_path / "run").call("one", 1.0, "Roger").close()


@pytest.mark.usefixtures("speakers")
def test_a_section_of_another_package_stands_where_its_order_says(run_folder: Path) -> None:
    html = write_report(run_folder).read_text()
    places = [html.index(f"id={name}") for name in ('"calls"', "'speakers'", '"cameras"')]
    assert places == sorted(places)
    assert "in radio-0</section>" in html


@pytest.mark.usefixtures("speakers")
def test_a_section_receives_the_messages_that_it_asks_for(run_folder: Path) -> None:
    page = data(write_report(run_folder))
    assert page["sections"]["speakers"]["keys"] == ["truth/radio/one"]
    assert "speakers were counted" in page["notes"]


@pytest.mark.usefixtures("speakers")
def test_hostile_text_in_a_template_is_escaped(run_folder: Path) -> None:
    html = write_report(run_folder).read_text()
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in html
    assert "<script>alert(1)" not in html
    assert data(run_folder / "report.html")["sections"]["speakers"]["text"] == HOSTILE


@pytest.mark.parametrize("missing", ["outside_speakers.html", "outside_speakers.py"])
def test_a_section_that_cannot_be_loaded_is_named_and_the_rest_is_shown(
    speakers: Path, run_folder: Path, missing: str
) -> None:
    (speakers / missing).unlink()
    sys.modules.pop("outside_speakers", None)
    page = data(write_report(run_folder))
    assert any("'speakers' cannot be shown" in note for note in page["notes"])
    assert len(page["sections"]["radio"]["calls"]) == 1


@pytest.mark.parametrize(
    ("works", "fails"),
    [
        ("self._keys.append(logged.key)", "self.nothing.append(logged)"),
        ("return {", "return 1 / 0, {"),
        ("return {", "return {1, 2}, {"),
        ('"keys": self._keys', '"keys": float("nan")'),
        ('keys=("truth/radio/",)', "keys=5"),
        ("order=45", "order=45, within='nowhere'"),
    ],
)
def test_a_section_that_fails_is_named_and_the_rest_is_shown(
    run_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, works: str, fails: str
) -> None:
    source = (MODULE % HOSTILE).replace(works, fails)
    group = "airhilt.report_sections"
    with installed(tmp_path, monkeypatch, group, "speakers", source) as package:
        (tmp_path / f"{package}.html").write_text(TEMPLATE)
        html = write_report(run_folder).read_text()
    page = data(run_folder / "report.html")
    assert sum("'speakers' cannot be shown" in note for note in page["notes"]) == 1
    assert "<section id='speakers'>" not in html
    assert len(page["sections"]["radio"]["calls"]) == 1


@pytest.mark.parametrize(
    "template",
    [
        "{{ data.nothing.at_all }}",
        "{% if %}",
    ],
)
def test_a_template_that_fails_is_named_and_the_rest_is_shown(
    speakers: Path, run_folder: Path, template: str
) -> None:
    (speakers / "outside_speakers.html").write_text(template)
    page = data(write_report(run_folder))
    assert any("template of section 'speakers' cannot be shown" in note for note in page["notes"])
    assert len(page["sections"]["radio"]["calls"]) == 1


def test_the_example_of_the_documentation_is_a_section(
    run_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (DOCS / "report.md").read_text("utf-8")
    blocks = dict(re.findall(r"```(python|html|js)\n(.*?)```", text, re.DOTALL))
    source = blocks["python"] + "\nENGINE = SECTION\n"
    group = "airhilt.report_sections"
    with installed(tmp_path, monkeypatch, group, "speakers", source) as package:
        (tmp_path / f"{package}.html").write_text(blocks["html"])
        (tmp_path / f"{package}.js").write_text(blocks["js"])
        html = write_report(run_folder).read_text()
    assert "<p>Tower: 1 calls</p>" in html
    assert 'byId("last-speaker")' in html


def test_a_script_cannot_end_its_element() -> None:
    for text in ("</script>", "</SCRIPT >", "<!-- hidden"):
        inlined = inline(f'const text = "{text}";')
        assert text not in inlined
        assert inlined.replace("\\", "") == f'const text = "{text}";'
