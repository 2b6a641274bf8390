"""Keys of pictures and rays that are kept for other processes: text of all they depend on."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import astuple
from types import ModuleType

import numpy as np
import numpy.typing as npt

import airhilt.imaging
import airhilt.sensors.cameras
from airhilt.host.files import packages_sha256
from airhilt.host.machine import processor_sha256
from airhilt.imaging.view import View


def drawn_by(library: str, *packages: ModuleType) -> list[str]:
    """Return what draws: the code, the libraries and the processor.

    Parameters
    ----------
    library
        Library that casts the rays, with its version.
    packages
        Packages of AIRHILT that have a part in it, besides those of cameras.
    """
    code = packages_sha256(airhilt.imaging, airhilt.sensors.cameras, *packages)
    return [code, library, np.__version__, processor_sha256()]


def view_key(view: View) -> list[float]:
    """Return the lens and the pose of a view."""
    pose = view.pose
    return [*astuple(view.intrinsics), *pose.position_m, *pose.rotation.ravel().tolist()]


def arrays_sha256(arrays: Iterable[npt.NDArray[np.generic]]) -> str:
    """Return the SHA-256 of the content of some arrays."""
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(np.ascontiguousarray(array).data)
    return digest.hexdigest()
