"""The site has every page, and what the code says of itself."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import airhilt
from airhilt.messages import json_schemas
from paths import DOCS, ROOT
from site_pages import command_line, commands, messages, python_api


def test_the_command_line_has_every_option_with_its_meaning() -> None:
    page = command_line()
    for context in commands():
        assert f"## {context.command_path}\n" in page
        for parameter in context.command.get_params(context):
            if parameter.param_type_name == "option" and not getattr(parameter, "hidden", False):
                assert parameter.opts[0] in page, context.command_path


def test_the_messages_have_every_key_and_links_that_lead_to_their_parts() -> None:
    page = messages()
    assert all(f"\n\n`{key}`" in page for key in json_schemas())
    anchors = re.findall(r"\{ #([a-z0-9-]+) \}", page)
    assert len(anchors) == len(set(anchors))
    assert set(re.findall(r"\]\(#([a-z0-9-]+)\)", page)) <= set(anchors)


def test_python_has_every_public_name_that_is_a_class_or_a_function() -> None:
    named = {path.rpartition(".")[2] for path in python_api().split("::: ")}
    assert set(airhilt.__all__) - {"__version__", "messages"} <= {name.strip() for name in named}


def test_a_tutorial_is_short() -> None:
    tutorials = [DOCS / "getting-started.md", *DOCS.glob("tutorial-*.md")]
    assert len(tutorials) == 6
    assert all(len(page.read_text().split()) <= 500 for page in tutorials)


@pytest.mark.slow
@pytest.mark.skipif(find_spec("mkdocstrings") is None, reason="needs the extra docs")
def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path)]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
