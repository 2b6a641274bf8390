"""The documentation says what is so."""

from __future__ import annotations

import json
import re
from pathlib import Path

import click
import pytest
from pydantic import TypeAdapter

from airhilt import __version__
from airhilt.cli.main import cli
from airhilt.messages import json_schemas
from airhilt.scenario import Scenario
from airhilt.scenario.models import Camera, Perturbation, RadioLine
from airhilt.world.loading import load_text
from paths import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def json_blocks(page: str) -> list[str]:
    text = (ROOT / "docs" / page).read_text()
    return re.findall(r"```json\n(.*?)```", text, flags=re.DOTALL)


def test_the_examples_of_the_scenario_guide_are_valid() -> None:
    scenario, line, perturbation, cameras = json_blocks("scenarios.md")
    assert load_text(scenario, "guide").name == "crossing"
    RadioLine.model_validate_json(line)
    Perturbation.model_validate_json(perturbation)
    assert len(TypeAdapter(tuple[Camera, ...]).validate_json(cameras)) == 2


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text()):
        assert (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_and_options_exist(page: Path) -> None:
    context = click.Context(cli)
    names = cli.list_commands(context)
    assert "cosim" in names
    for command, rest in re.findall(r"\bairhilt ([a-z]+)\b([^\n`]*)", page.read_text()):
        found = cli.get_command(context, command) if command in names else None
        if found is None:
            continue
        if isinstance(found, click.Group):
            name, rest = re.match(r"\s*([a-z]*)(.*)", rest).groups()
            assert name in found.commands, f"airhilt {command} {name}"
            found = found.commands[name]
        parameters = found.get_params(click.Context(found))
        options = {option for parameter in parameters for option in parameter.opts}
        assert options, f"airhilt {command} has no options"
        for option in re.findall(r"(?<!\S)--[a-z-]+", rest.split("   ")[0]):
            assert option in options, f"airhilt {command} {option}"


def test_published_schemas_are_those_of_the_code() -> None:
    published = ROOT / "docs" / "schemas"
    assert json.loads((published / "messages.json").read_text()) == json_schemas()
    assert json.loads((published / "scenario.json").read_text()) == Scenario.model_json_schema()


def test_the_citation_is_of_this_version() -> None:
    assert f"\nversion: {__version__}\n" in (ROOT / "CITATION.cff").read_text()


def test_what_the_dockerfile_copies_is_let_through() -> None:
    recipe = (ROOT / "Dockerfile").read_text()
    copied = {
        source
        for line in re.findall(r"^COPY (?!--)(.*) \S+$", recipe, flags=re.MULTILINE)
        for source in line.split()
    } | set(re.findall(r"source=([^/,]+)", recipe))
    ignore = (ROOT / ".dockerignore").read_text()
    assert copied
    assert all((ROOT / name).exists() for name in copied)
    assert copied <= set(re.findall(r"^!(\S+)$", ignore, flags=re.MULTILINE))
