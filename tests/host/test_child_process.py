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

from airhilt.host.child_process import ChildProcess, Ended, NoAnswer
from resources import held, linux_only

CHILD = """
import json, os, subprocess, sys, time
from airhilt.host.child_process import serve

def answer(question):
    if question == "hang":
        time.sleep(600.0)
    if question == "flood":
        os.write(1, b"x" * 20_000_000)
    if question == "complain":
        sys.exit("this is\\nwhy")
    if question == "eat":
        raise MemoryError
    if question == "start":
        return str(subprocess.Popen(["sleep", "600"]).pid)
    return json.dumps(question)

serve(int(sys.argv[1]), int(sys.argv[2]), answer)
"""
COMMAND = (sys.executable, "-c", CHILD)
PATIENCE_S = 60.0


@pytest.fixture
def child() -> Iterator[ChildProcess]:
    with closing(ChildProcess(COMMAND)) as started:
        yield started


def test_each_question_has_its_answer_however_long(child: ChildProcess) -> None:
    for question in ("a", {"many": "b" * 1_000_000}, None):
        assert child.ask(question, PATIENCE_S) == question


def test_a_child_that_floods_its_output_still_answers(child: ChildProcess) -> None:
    assert child.ask("flood", PATIENCE_S) == "flood"


def test_a_child_that_hangs_is_killed_and_every_later_question_says_so(
    child: ChildProcess,
) -> None:
    assert child.ask("a", PATIENCE_S)
    with pytest.raises(NoAnswer):
        child.ask("hang", 0.1)
    assert not child.is_alive
    with pytest.raises(Ended, match=r"^\(signal 9\)$"):
        child.ask("a", PATIENCE_S)


@pytest.mark.parametrize("fault", [KeyboardInterrupt, ValueError])
def test_the_answer_to_a_question_that_was_given_up_is_not_taken_for_another(
    child: ChildProcess, fault: type[BaseException]
) -> None:
    def watch() -> None:
        raise fault

    with pytest.raises(fault):
        child.ask("hang", PATIENCE_S, watch)
    with pytest.raises(Ended):
        child.ask("a", PATIENCE_S)


@pytest.mark.parametrize(
    ("question", "told"),
    [("complain", r"\(exit code 1\): why"), ("eat", r"\(exit code 1\): out of memory")],
)
def test_a_child_that_ends_is_told_with_the_last_line_that_it_printed(
    child: ChildProcess, question: str, told: str
) -> None:
    with pytest.raises(Ended, match=f"^{told}$"):
        child.ask(question, PATIENCE_S)


def test_a_child_ends_with_all_that_it_has_started(child: ChildProcess) -> None:
    grandchild = psutil.Process(child.ask("start", PATIENCE_S))
    child.close()
    grandchild.wait(10.0)


def test_a_child_that_is_busy_ends_when_its_parent_is_killed(tmp_path: Path) -> None:
    number = tmp_path / "number"
    source = (
        "import pathlib, sys; from airhilt.host.child_process import ChildProcess; "
        f"child = ChildProcess({COMMAND!r}); child.ask('a', 60.0); "
        "pathlib.Path(sys.argv[1]).write_text(str(child.process_id)); child.ask('hang', 60.0)"
    )
    parent = subprocess.Popen([sys.executable, "-c", source, str(number)])
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
    for question in ("a", "complain"):
        with closing(ChildProcess(COMMAND)) as child:
            try:
                child.ask(question, PATIENCE_S)
            except Ended:
                assert not child.is_alive
    assert held() == before
    assert not psutil.pid_exists(child.process_id)
