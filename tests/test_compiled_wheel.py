"""Modules that a wheel may carry compiled, and what a run of such a wheel logs."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from paths import ROOT


def run(*command: str | Path, folder: Path, **variables: str) -> str:
    done = subprocess.run(
        [str(part) for part in command],
        cwd=folder,
        env=os.environ | variables,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def installed(folder: Path, **variables: str) -> Path:
    """A folder with the package alone, of a wheel made from the source distribution."""
    run(
        sys.executable, "-m", "build", "--outdir", folder / "dist", ROOT, folder=folder, **variables
    )
    (wheel,) = (folder / "dist").glob("*.whl")
    pip = (sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--no-deps")
    run(*pip, "--target", folder / "installed", wheel, folder=folder)
    return folder / "installed"


def logged(package: Path, scenario: str, out: Path) -> bytes:
    command = (sys.executable, "-m", "airhilt", "cosim", "--scenario", scenario, "--no-cameras")
    run(*command, "--out", out, folder=package.parent, PYTHONPATH=str(package))
    return (out / "log.mcap").read_bytes()


def doctored(package: Path) -> str:
    """What the package says of itself."""
    show = "from airhilt.cli.commands.doctor import examine; print(examine()[0])"
    return run(sys.executable, "-c", show, folder=package.parent, PYTHONPATH=str(package))


def test_the_modules_to_compile_exist() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    hook = project["tool"]["hatch"]["build"]["targets"]["wheel"]["hooks"]["mypyc"]
    assert [path for path in hook["include"] if not (ROOT / path[1:]).is_file()] == []


@pytest.mark.slow
def test_a_compiled_wheel_logs_the_same_bytes_as_a_pure_one(tmp_path: Path) -> None:
    for name in ("pure", "compiled"):
        (tmp_path / name).mkdir()
    pure = installed(tmp_path / "pure")
    compiled = installed(tmp_path / "compiled", HATCH_BUILD_HOOK_ENABLE_MYPYC="1")
    assert list(pure.rglob("*.so")) == []
    assert "compiled" not in doctored(pure)
    assert "compiled" in doctored(compiled)
    for scenario in ("s02a_headon", "s01a_bad_readback"):
        logs = [logged(each, scenario, each.parent / scenario) for each in (pure, compiled)]
        assert logs[0] == logs[1]
