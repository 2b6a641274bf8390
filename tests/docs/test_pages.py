"""The documentation says what is so."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import click
import pytest
from pydantic import TypeAdapter, ValidationError

from airhilt import __version__
from airhilt.cli.main import cli
from airhilt.commands import Command
from airhilt.messages import Advisory, json_schemas
from airhilt.scenario import Scenario
from airhilt.scenario.models import Camera, Perturbation, RadioLine
from airhilt.world.loading import load_text
from paths import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def json_blocks(page: str) -> list[str]:
    text = (ROOT / "docs" / page).read_text()
    return re.findall(r"```json\n(.*?)```", text, flags=re.DOTALL)


def test_the_examples_of_the_scenario_pages_are_valid() -> None:
    scenario, line, cameras = json_blocks("scenarios.md")
    (perturbation,) = json_blocks("perturbations.md")
    (equipment,) = json_blocks("equipment.md")
    (command,) = json_blocks("commands.md")
    assert load_text(scenario, "guide").name == "crossing"
    equipped = json.loads(scenario) | {"equipment": json.loads(equipment)["equipment"]}
    assert load_text(json.dumps(equipped), "guide").equipment == ("tcas", "conflict_alert")
    RadioLine.model_validate_json(line)
    Perturbation.model_validate_json(perturbation)
    TypeAdapter(Command).validate_json(command)
    assert len(TypeAdapter(tuple[Camera, ...]).validate_json(cameras)) == 2


def test_the_advisory_of_the_page_of_workers_is_valid_and_the_smallest() -> None:
    (block,) = json_blocks("workers.md")
    advisory = json.loads(block)
    Advisory.model_validate(advisory)
    for field in advisory:
        with pytest.raises(ValidationError, match="Field required"):
            Advisory.model_validate({name: advisory[name] for name in advisory if name != field})


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text()):
        assert (page.parent / target).exists(), target


def commands(text: str) -> list[tuple[str, str]]:
    """Return each command in the code of a page, with the rest of its line."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"\s*\\\n\s*", " ", text)
    code = re.findall(r"^ {4}(.*)|`([^`\n]+)`", text, flags=re.MULTILINE)
    lines = [block or inline for block, inline in code]
    return [found for line in lines for found in re.findall(r"\bairhilt ([a-z]+)\b(.*)", line)]


def problems(text: str) -> list[str]:
    """Return the commands and the options on a page that do not exist."""
    context = click.Context(cli)
    found = []
    for name, rest in commands(text):
        spelling, command = f"airhilt {name}", cli.get_command(context, name)
        if isinstance(command, click.Group):
            words = rest.partition("#")[0].split()
            spelling += f" {words[0]}" if words else ""
            alone = command if command.invoke_without_command else None
            command = command.commands.get(words[0]) if words else alone
        if command is None:
            found.append(spelling)
            continue
        parameters = command.get_params(click.Context(command))
        options = {option for parameter in parameters for option in parameter.opts}
        given = re.findall(r"(?<!\S)--[a-z-]+", rest.split("   ")[0])
        found += [f"{spelling} {option}" for option in given if option not in options]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_and_options_exist(page: Path) -> None:
    assert not problems(page.read_text())


def test_commands_and_options_that_do_not_exist_are_found() -> None:
    text = """
`airhilt liszt` is a command that airhilt has not; `airhilt schema --scenario` is one.

    airhilt dataset import --out a        what --images are
    airhilt cosim --scenario s02a_headon \\
        --nosie 3

```python
import airhilt  # airhilt knows
```
"""
    assert problems(text) == ["airhilt liszt", "airhilt dataset import", "airhilt cosim --nosie"]


def test_published_schemas_are_those_of_the_code() -> None:
    published = ROOT / "docs" / "schemas"
    assert json.loads((published / "messages.json").read_text()) == json_schemas()
    assert json.loads((published / "scenario.json").read_text()) == Scenario.model_json_schema()


def test_the_readme_on_a_package_index_has_no_links_into_the_repository() -> None:
    hooks = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["metadata"]
    text = (ROOT / "README.md").read_text()
    for each in hooks["hooks"]["fancy-pypi-readme"]["substitutions"]:
        text = re.sub(each["pattern"], each["replacement"], text)
    assert "Apache-2.0](https://img" in text
    assert "one JSON file |" in text
    assert not re.search(r"\]\((?!https?:)", text)


def test_every_extra_that_a_page_installs_exists() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    pages = [*PAGES, ROOT / "bridges" / "README.md", ROOT / "CONTRIBUTING.md"]
    named = {
        extra
        for page in pages
        for extras in re.findall(
            r"pip install [^\n]*(?:airhilt|\.)\[([a-z0-9,]+)\]", page.read_text()
        )
        for extra in extras.split(",")
    }
    assert named
    assert named <= declared["optional-dependencies"].keys()


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
