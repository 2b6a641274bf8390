"""JSBSim says nothing, listens nowhere and writes nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import jsbsim
import pytest

from airhilt.host import library
from airhilt.world.flight import ModelError
from airhilt.world.flight.model import load_model
from paths import SUPPORT

PROGRAM = """
import os, sys, tempfile
sys.path.insert(0, {support!r})
from flights import CRUISE, in_cruise, states
before = set(os.listdir("/proc/self/fd"))
aircraft = [in_cruise(name) for name in CRUISE]
for one in aircraft:
    *_, _ = states(one, 2)
opened = set(os.listdir("/proc/self/fd")) - before
sockets = [fd for fd in opened if os.path.exists(f"/proc/self/fd/{{fd}}")
           and "socket" in os.readlink(f"/proc/self/fd/{{fd}}")]
print("sockets", sockets, "left", os.listdir(tempfile.gettempdir()), file=sys.stderr)
"""


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="needs /proc")
def test_four_types_fly_in_silence_without_a_socket_or_a_file(tmp_path: Path) -> None:
    installed = Path(jsbsim.get_default_root_dir())
    before = listing(installed)
    scratch = tmp_path / "scratch"
    work = tmp_path / "work"
    scratch.mkdir()
    work.mkdir()
    answer = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(support=str(SUPPORT))],
        cwd=work,
        env={
            **os.environ,
            "TMPDIR": str(scratch),
            "PYTHONPATH": str(Path(library.__file__).parents[2]),
        },
        capture_output=True,
        text=True,
        check=True,
    )
    assert answer.stdout == ""
    assert answer.stderr == "sockets [] left []\n"
    assert list(work.iterdir()) == []
    assert listing(installed) == before


def test_the_models_own_inputs_and_outputs_are_gone() -> None:
    fdm = load_model("737", 1 / 120)
    assert fdm.get_output_filename(0) == ""


def test_a_model_that_jsbsim_does_not_have_is_named() -> None:
    with pytest.raises(ModelError, match="no model 'Zeppelin'"):
        load_model("Zeppelin", 1 / 120)


def listing(folder: Path) -> dict[Path, tuple[int, int]]:
    return {
        path: (path.stat().st_size, path.stat().st_mtime_ns)
        for path in folder.rglob("*")
        if path.suffix != ".pyc" and path.name != "__pycache__"
    }
