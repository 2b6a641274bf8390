"""``airhilt check`` and ``airhilt serve`` on the command line."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

from services import answering, nobody, service

Cli = Callable[..., subprocess.CompletedProcess[str]]


def test_a_good_service_is_told_so(airhilt_command: Cli) -> None:
    with service(answering(b'{"detections": []}')) as url:
        done = airhilt_command("check", url, "--as", "vision")
    assert done.returncode == 0
    assert done.stdout.splitlines()[-1] == f"{url}: a run takes its answers"


def test_a_bad_one_is_told_in_one_line_and_exit_code_2(airhilt_command: Cli) -> None:
    with service(answering(b'{"detections": null}')) as url:
        wrong = airhilt_command("check", url, "--as", "vision")
    dead = airhilt_command("check", nobody(), "--as", "decision")
    assert (wrong.returncode, dead.returncode) == (2, 2)
    assert "detections: Input should be a valid" in wrong.stderr
    assert "is not there" in dead.stderr
    assert len(wrong.stderr.splitlines()) == len(dead.stderr.splitlines()) == 1


def test_other_machines_need_tls_and_a_token_to_reach_a_served_engine(
    airhilt_command: Cli, tmp_path: Path
) -> None:
    token = tmp_path / "token"
    token.write_text("a-token-of-sixteen-letters-or-more")
    for more in ((), ("--token-file", token)):
        done = airhilt_command("serve", "tts", "--host", "0.0.0.0", *more)
        assert done.returncode == 2
        assert "other machines can reach it; expected 127.0.0.1, or TLS and a token" in done.stderr
    assert "did you mean" in airhilt_command("serve", "tts", "--engine", "espaek").stderr
