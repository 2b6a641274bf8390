"""A run talks to nobody but itself."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from airhilt import load
from paths import DATA
from shortened import shortened
from tiny_models import write_xtts, write_yolo

REQUIRED = "AIRHILT_REQUIRE_NETWORK_TESTS"
"""Environment variable with which these tests fail where they cannot be done."""
LOOPBACK_UP = """
import fcntl, os, socket, struct, sys
with socket.socket() as any_socket:
    fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh", b"lo", 1))  # SIOCSIFFLAGS, IFF_UP
os.execvp(sys.argv[1], sys.argv[1:])
"""
OTHER_ENGINES = (
    "--no-cameras", "--snr", "10", "--topology", "asr_first", "--enhancer", "spectral",
    "--assistant", "paper", "--equipment", "conflict_alert",
)  # fmt: skip
"""Engines that ship, and that a run does not have unless it is told so."""
NEEDS_FLITE = pytest.mark.skipif(shutil.which("flite") is None, reason="needs flite")
SPEAKS_TO = re.compile(
    r'(?:connect|sendto|sendm?msg)\(.*(?:inet_addr\(|inet_pton\(AF_INET6, )"([^"]+)"'
)

LOOPBACK = re.compile(r"127\.\d+\.\d+\.\d+|::1|::ffff:127\.\d+\.\d+\.\d+")


def _namespace_problem() -> str:
    """Return why a program cannot be traced in a network of its own here, empty if it can."""
    for name in ("unshare", "strace"):
        if shutil.which(name) is None:
            return f"needs {name}"
    tried = ["unshare", "--map-root-user", "--net", sys.executable, "-c", LOOPBACK_UP]
    done = subprocess.run([*tried, "strace", "-o", "/dev/null", "true"], capture_output=True)
    return "" if done.returncode == 0 else "network namespaces or traces are not allowed here"


def require_namespaces() -> None:
    """Skip a test that cannot be done here, or fail it where all have to be done."""
    if problem := _namespace_problem():
        if os.environ.get(REQUIRED):
            pytest.fail(f"{problem}, and {REQUIRED} is set")
        pytest.skip(problem)


def talked_to(scenario: dict[str, Any], folder: Path, home: Path, *flags: str) -> set[str]:
    """Return the addresses to which a run sends.

    It runs in a network that has its loopback interface alone, with a home of its own.
    """
    file, trace = folder / "scenario.json", folder / "trace.txt"
    file.write_text(json.dumps(scenario))
    command = [
        "unshare", "--map-root-user", "--net", sys.executable, "-c", LOOPBACK_UP,
        "strace", "-f", "--seccomp-bpf", "-e", "trace=connect,sendto,sendmsg,sendmmsg",
        "-o", str(trace),
        sys.executable, "-m", "airhilt", "cosim", "--scenario", str(file),
        "--latency", "fixed", "--no-report", "--out", str(folder / "run"), *flags,
    ]  # fmt: skip
    variables = {"HOME": str(home), "XDG_CACHE_HOME": str(home / ".cache"), "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        command, env={**os.environ, **variables}, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    lines = trace.read_text(errors="replace").splitlines()
    return {found[1] for line in lines if (found := SPEAKS_TO.search(line))}


def few_pictures(scenario: dict[str, Any]) -> dict[str, Any]:
    """Return a scenario with one small camera that takes two pictures a second."""
    camera = {**scenario["cameras"][0], "rate_hz": 2.0, "width_px": 320, "height_px": 180}
    return scenario | {"cameras": [camera]}


def kept_by_others(home: Path) -> list[str]:
    """Return the files below a home that are not of AIRHILT's own cache."""
    return [
        str(path.relative_to(home))
        for path in home.rglob("*")
        if path.is_file() and "airhilt" not in path.relative_to(home).parts
    ]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="needs network namespaces")
@pytest.mark.parametrize(
    "flags",
    [
        ("--no-cameras", "--snr", "10"),
        (),
        OTHER_ENGINES,
        pytest.param(("--no-cameras", "--tts", "flite"), marks=NEEDS_FLITE),
    ],
)
def test_a_run_connects_to_nobody_and_leaves_nothing_for_others_to_send(
    tmp_path: Path, flags: tuple[str, ...]
) -> None:
    require_namespaces()
    scenario = shortened(load("s01a_bad_readback").model_dump(mode="json"), 2.0)
    home = tmp_path / "home"
    home.mkdir()
    addresses = talked_to(scenario, tmp_path, home, *flags)
    assert {each for each in addresses if not LOOPBACK.fullmatch(each)} == set()
    assert kept_by_others(home) == []


def _whisper(_: Path) -> tuple[str, ...]:
    return ("--no-cameras", "--asr", f"whisper:{DATA / 'tiny_whisper'}")


def _coqui(folder: Path) -> tuple[str, ...]:
    write_xtts(folder, longest_text=400)
    return ("--no-cameras", "--tts", f"coqui:{folder}")


def _yolo(folder: Path, suffix: str) -> tuple[str, ...]:
    write_yolo(folder)
    return ("--no-speech", "--detector", f"yolo:{folder / 'yolov10n'}{suffix}")


def _renderer(_: Path, name: str) -> tuple[str, ...]:
    return ("--no-speech", "--renderer", name)


def engine(
    package: str, flags: Callable[[Path], tuple[str, ...]], *kept: str, marker: str = "slow"
) -> Any:
    """Return a case of an engine that needs a package.

    Parameters
    ----------
    flags
        Returns the flags of its run, and writes a model into a folder if it needs one.
    kept
        Beginnings of the names of files that the package itself keeps in the home.
    """
    needs = pytest.mark.skipif(
        importlib.util.find_spec(package) is None, reason=f"needs the package {package}"
    )
    marks = [needs, pytest.mark.slow, getattr(pytest.mark, marker)]
    return pytest.param(flags, kept, marks=marks)


SETTINGS = ".config/Ultralytics/"
SHADERS = ".cache/mesa_shader_cache"
"""Mesa's, which draws where there is no graphics card."""


@pytest.mark.skipif(sys.platform != "linux", reason="needs network namespaces")
@pytest.mark.filterwarnings("ignore")  # what writes the models has warnings of its own
@pytest.mark.parametrize(
    ("flags", "kept"),
    [
        engine("faster_whisper", _whisper, marker="whisper"),
        engine("TTS", _coqui, marker="coqui"),
        engine("ultralytics", partial(_yolo, suffix=".pt"), SETTINGS, marker="yolo"),
        engine("ultralytics", partial(_yolo, suffix=".onnx"), SETTINGS, marker="yolo"),
        engine("open3d", partial(_renderer, name="open3d")),
        engine("moderngl", partial(_renderer, name="moderngl"), SHADERS),
    ],
    ids=["whisper", "coqui", "yolo.pt", "yolo.onnx", "open3d", "moderngl"],
)
def test_a_run_with_an_engine_of_an_extra_connects_to_nobody(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    flags: Callable[[Path], tuple[str, ...]],
    kept: tuple[str, ...],
) -> None:
    require_namespaces()
    home, model = tmp_path / "home", tmp_path / "model"
    for folder in (home, model):
        folder.mkdir()
    with monkeypatch.context() as writing:
        writing.setenv("YOLO_OFFLINE", "true")
        writing.setenv("YOLO_CONFIG_DIR", str(tmp_path))
        given = flags(model)
    scenario = shortened(load("s01a_bad_readback").model_dump(mode="json"), 2.0)
    addresses = talked_to(few_pictures(scenario), tmp_path, home, *given)
    assert {each for each in addresses if not LOOPBACK.fullmatch(each)} == set()
    assert [path for path in kept_by_others(home) if not path.startswith(kept)] == []


def test_where_the_network_has_to_be_tested_a_missing_tool_is_a_failure(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(shutil, "which", lambda _: None)
    for value, ends in (("", pytest.skip.Exception), ("1", pytest.fail.Exception)):
        monkeypatch.setenv(REQUIRED, value)
        with pytest.raises((pytest.skip.Exception, pytest.fail.Exception)) as ended:
            require_namespaces()
        assert (ended.type, "needs unshare" in str(ended.value)) == (ends, True)
