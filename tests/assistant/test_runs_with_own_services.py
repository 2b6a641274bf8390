"""Runs that ask AIRHILT's own services, in other processes, have the results of runs alone."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from airhilt import Scenario, run
from airhilt.assistant.service_kinds import PATHS
from airhilt.messages import Transcript
from airhilt.record import read_log

TOKEN = "a-token-of-sixteen-letters-or-more"
pytestmark = pytest.mark.slow


@contextmanager
def served(kind: str, *arguments: str) -> Iterator[str]:
    """Yield the address of an engine in a process of its own."""
    command = [sys.executable, "-m", "airhilt", "serve", kind, *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        try:
            yield child.stdout.readline().split()[0]
        finally:
            child.terminate()


def results(folder: Path) -> list[tuple[str, int, Any]]:
    """Return what was heard and what was told, and when, without the names of engines."""
    found: list[tuple[str, int, Any]] = []
    for one in read_log(folder / "log.mcap"):
        if one.key.startswith("asr/"):
            transcript = Transcript.model_validate_json(one.data)
            found.append((one.key, one.t_ns, transcript.model_copy(update={"engine": ""})))
        elif one.key.partition("/")[0] in ("advisory", "radio", "truth"):
            found.append((one.key, one.t_ns, one.data))
    return found


def test_a_run_with_served_speech_is_the_run_alone(
    encounter: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    token = tmp_path / "token"
    token.write_text(TOKEN)
    monkeypatch.setenv("AIRHILT_ASR_KEY", TOKEN)
    alone = run(encounter, out=tmp_path / "alone", latency="fixed")
    with ExitStack() as stack:
        asr = stack.enter_context(served("asr", "--token-file", str(token)))
        tts = stack.enter_context(served("tts"))
        assert (asr.endswith(PATHS["asr"]), tts.endswith(PATHS["tts"])) == (True, True)
        asked = run(encounter, out=tmp_path / "asked", latency="fixed", asr=asr, tts=tts)
    assert asked.summary.modalities == alone.summary.modalities
    assert results(asked.folder) == results(alone.folder)
    assert len(results(asked.folder)) > 100
