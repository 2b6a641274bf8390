"""The shell completes commands, options and their choices."""

from __future__ import annotations

import pytest
from click.shell_completion import get_completion_class

from airhilt.cli.main import cli


@pytest.mark.parametrize(
    ("typed", "last", "offered"),
    [
        ([], "rep", {"replay", "report"}),
        (["cosim", "--topology"], "", {"asr_first", "parallel", "gated_fusion"}),
    ],
)
def test_what_is_typed_is_completed(typed: list[str], last: str, offered: set[str]) -> None:
    bash = get_completion_class("bash")
    assert bash is not None
    completion = bash(cli, {}, "airhilt", "_AIRHILT_COMPLETE")
    assert {item.value for item in completion.get_completions(typed, last)} == offered
