"""Loads an aircraft model of the installed JSBSim, stripped of all that reaches outside.

Some models of the wheel open sockets (the 737 listens on TCP 5137) or write CSV files into
site-packages. What is loaded here is derived from the wheel and written to a temporary folder that
is gone when the model is loaded: no ``<input>``, no ``<output>``, and no autopilot of the model's
own, since AIRHILT flies it. Parts that move slowly run in few of the steps.
"""

from __future__ import annotations

import functools
import itertools
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from xml.etree.ElementTree import Element

import jsbsim

from airhilt.errors import AirhiltError

_SILENCE = jsbsim.DefaultLogger(jsbsim.LogLevel.STDOUT)
# Kept here for good: JSBSim drops its reference when a thread ends, without holding the
# interpreter lock, and the process dies of it if that was the last one.


SLOW_PARTS_S = 0.05
"""Time in s between two movements of gear, flaps, speed brakes and spoilers."""


class ModelError(AirhiltError):
    """JSBSim does not have the model, or cannot fly it from the asked condition."""


def load_model(model: str, step_s: float, load: float = 0.0) -> jsbsim.FGFDMExec:
    """Return a fresh FGFDMExec with the model loaded, silent and alone.

    It takes steps of ``step_s``. ``load`` is mass above that of the model, as a part of its empty
    mass, at its centre of gravity.
    JSBSim's logger belongs to a thread: what a model has to say later, in a thread in which none
    was loaded, goes to stdout. `ModelError` says that there is no such model, or it cannot load.
    """
    jsbsim.set_logger(_SILENCE)
    root = Path(jsbsim.get_default_root_dir())
    stripped = _stripped(root, model, round(SLOW_PARTS_S / step_s))
    if load:
        stripped = _laden(stripped, load)
    with tempfile.TemporaryDirectory(prefix="airhilt-jsbsim-") as scratch:
        folder = Path(scratch, model)
        folder.mkdir()
        Path(folder, f"{model}.xml").write_bytes(stripped)
        fdm = jsbsim.FGFDMExec(str(root))
        fdm.set_debug_level(0)
        # Before the model: the parts of its flight control system keep the step that they find.
        fdm.set_dt(step_s)
        try:
            loaded = fdm.load_model_with_paths(
                model, scratch, str(root / "engine"), str(root / "systems")
            )
        except jsbsim.BaseError as error:
            raise ModelError(f"JSBSim cannot load its model {model!r}: {error}") from error
    if not loaded:
        raise ModelError(f"JSBSim cannot load its model {model!r}")
    return fdm


@functools.cache
def _stripped(root: Path, model: str, slow_steps: int) -> bytes:
    """Return the model's file without inputs, outputs and autopilot."""
    path = root / "aircraft" / model / f"{model}.xml"
    if not path.is_file():
        raise ModelError(f"the installed JSBSim has no model {model!r}: no {path}")
    config = ElementTree.fromstring(path.read_bytes())  # noqa: S314 - JSBSim's own file
    for tag in ("input", "output", "autopilot"):
        for element in config.findall(tag):
            config.remove(element)
    for component in config.iterfind("flight_control/channel/*"):
        for source in component.findall("input"):
            if (source.text or "").strip().startswith("ap/"):
                component.remove(source)
    for control in config.iterfind("flight_control"):
        for channel in control.findall("channel"):
            _slow_down(control, channel, slow_steps)
    return ElementTree.tostring(config)


def _slow_down(control: Element, channel: Element, steps: int) -> None:
    """Run the parts of a channel from its first kinematic one on once in some steps.

    Gear, flaps, speed brakes and spoilers are kinematic, and last in their channels.
    """
    parts = list(channel)
    slow = list(itertools.dropwhile(lambda part: part.tag != "kinematic", parts))
    if not slow:
        return
    name = f"{channel.get('name')}, slow"
    ElementTree.SubElement(control, "channel", name=name, execrate=str(steps)).extend(slow)
    for part in slow:
        channel.remove(part)
    if len(slow) == len(parts):
        control.remove(channel)


def _laden(config: bytes, load: float) -> bytes:
    """Return the model's file with another empty mass; the moments of inertia stay."""
    root = ElementTree.fromstring(config)  # noqa: S314 - JSBSim's own file
    for mass in root.iterfind("mass_balance/emptywt"):
        mass.text = str(float(mass.text or 0.0) * (1.0 + load))
    return ElementTree.tostring(root)
