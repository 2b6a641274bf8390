"""A child process answers questions, and whatever becomes of it is told."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import psutil
import pytest

from airhilt.errors import ScenarioError
from airhilt.host.child_process import ChildProcess, Ended, NoAnswer
from resources import held, linux_only

CHILD = """
import os, sys, time
from airhilt.errors import ScenarioError
from airhilt.host.child_process import serve

class Server:
    def repeat(self, text):
        return text

    def flood(self):
        os.write(1, b"x" * 20_000_000)

    def refuse(self):
        raise ScenarioError("no such thing", ("one", "two"))

    def complain(self):
        sys.exit("this is\\nwhy")

    def hang(self):
        time.sleep(600.0)

serve(Server())
"""
PATIENCE_S = 60.0


@pytest.fixture(autouse=True)
def _module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "child_of_tests.py").write_text(CHILD)
    monkeypatch.syspath_prepend(tmp_path)


def started() -> ChildProcess:
    return ChildProcess("child_of_tests", {})


@pytest.fixture
def child() -> Iterator[ChildProcess]:
    with closing(started()) as opened:
        yield opened


def test_each_question_has_its_answer_however_long(child: ChildProcess) -> None:
    for text in ("a", "b" * 10_000_000):
        assert child.ask("repeat", text, patience_s=PATIENCE_S) == text


def test_a_child_that_floods_its_output_still_answers(child: ChildProcess) -> None:
    assert child.ask("flood", patience_s=PATIENCE_S) is None


def test_an_error_is_an_answer(child: ChildProcess) -> None:
    with pytest.raises(ScenarioError, match="no such thing") as caught:
        child.ask("refuse", patience_s=PATIENCE_S)
    assert caught.value.problems == ("one", "two")
    assert child.ask("repeat", "a", patience_s=PATIENCE_S) == "a"


def test_a_child_that_hangs_is_killed_and_every_later_question_says_so(
    child: ChildProcess,
) -> None:
    assert child.ask("repeat", "a", patience_s=PATIENCE_S)
    with pytest.raises(NoAnswer):
        child.ask("hang", patience_s=0.1)
    assert not child.is_alive
    with pytest.raises(Ended, match=r"^\(signal 9\)$"):
        child.ask("repeat", "a", patience_s=PATIENCE_S)


def test_the_answer_to_a_question_that_was_given_up_is_not_taken_for_another(
    child: ChildProcess,
) -> None:
    def watch() -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        child.ask("hang", patience_s=PATIENCE_S, watch=watch)
    with pytest.raises(Ended):
        child.ask("repeat", "a", patience_s=PATIENCE_S)


def test_a_child_that_ends_is_told_with_the_last_line_that_it_printed(
    child: ChildProcess,
) -> None:
    with pytest.raises(Ended, match=r"^\(exit code 1\): why$"):
        child.ask("complain", patience_s=PATIENCE_S)


def test_a_child_that_is_busy_ends_when_its_parent_is_killed(tmp_path: Path) -> None:
    number = tmp_path / "number"
    source = (
        "import pathlib, sys; from airhilt.host.child_process import ChildProcess; "
        "sys.path.append(sys.argv[2]); child = ChildProcess('child_of_tests', {}); "
        "child.ask('repeat', 'a', patience_s=60.0); "
        "pathlib.Path(sys.argv[1]).write_text(str(child.process_id)); "
        "child.ask('hang', patience_s=60.0)"
    )
    parent = subprocess.Popen([sys.executable, "-c", source, str(number), str(tmp_path)])
    while not (number.exists() and number.read_text()):
        assert parent.poll() is None
        time.sleep(0.05)
    child = psutil.Process(int(number.read_text()))
    parent.kill()
    parent.wait()
    child.wait(10.0)


@linux_only
def test_a_child_that_was_closed_leaves_nothing_open() -> None:
    before = held()
    with closing(started()) as child:
        assert child.ask("repeat", "a", patience_s=PATIENCE_S)
    with closing(started()) as child, pytest.raises(Ended):
        child.ask("complain", patience_s=PATIENCE_S)
    assert held() == before
    assert not psutil.pid_exists(child.process_id)
