"""The run folder and its ``run.json``."""

from __future__ import annotations

import functools
import importlib.metadata
import json
import os
import platform
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from airhilt._version import __version__
from airhilt.errors import RunFolderError, first_line, first_problem, shown
from airhilt.host import bounded_json
from airhilt.host.files import read_inside, replace_file
from airhilt.messages import WorkerDescription
from airhilt.options import Options
from airhilt.record.manifest import FileRecord, digest, manifest

FORMAT: Final = 2
RECORDED_VERSIONS = (
    "jsbsim",
    "numpy",
    "scipy",
    "onnxruntime",
    "espeakng-loader",
    "eclipse-zenoh",
    "pydantic",
    "mcap",
    "zstandard",
    "geographiclib",
    "shapely",
    "pygeomag",
)
"""Packages that every run has, whose versions are recorded."""
WHERE_INSTALLED = (
    "embreex",
    "open3d-cpu",
    "open3d",
    "moderngl",
    "pillow",
    "ultralytics",
    "faster-whisper",
    "coqui-tts",
)
"""Packages that not every machine has, whose versions are recorded where they are installed."""


class WorkerRecord(BaseModel):
    """A worker that took part in the run."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    description: WorkerDescription
    where: Literal["in process", "attached", "caller"]
    """Origin of the worker: the run, another process, or the caller of the run."""


class RunInfo(BaseModel):
    """``run.json``: everything needed to run it again, and how it ended."""

    model_config = ConfigDict(extra="forbid")
    format: Literal[2] = FORMAT
    phase: Literal["running", "finished", "stopped"] = "running"
    cause: str = ""
    run: str
    options: Options
    assistant: str
    """Decision engine of the run: the name of a decision engine, ``none`` or ``external``."""
    pace: str
    """Pace at which the run began."""
    scenario: dict[str, Any]
    realised: dict[str, Any]
    draws: list[dict[str, Any]]
    workers: list[WorkerRecord] = []
    unregistered_programs: bool = False
    endpoint: str
    started_at: str
    versions: dict[str, str]
    platform: dict[str, str]
    files: dict[str, FileRecord] = {}
    """Manifest: each file of the run by its path in the folder, once the run has ended. What can be
    made again from them, such as the report, is not in it."""
    renderer: str = ""
    """Renderer that drew, where the options ask for ``auto``; empty if no pictures were drawn."""
    models: dict[str, str] = {}
    """SHA-256 of each file or folder of the user that an engine or a channel uses, by its path."""
    other_packages: dict[str, str] = {}
    """Name and version of the package of each member in use that is not AIRHILT's, such as that of
    ``kind moose``."""
    digest: str = ""
    """Hash of all of the above."""


def versions() -> dict[str, str]:
    """Return the versions of AIRHILT and of the packages that decide its results."""
    found = {name: _version(name) for name in RECORDED_VERSIONS}
    for name in WHERE_INSTALLED:
        with suppress(importlib.metadata.PackageNotFoundError):
            found[name] = _version(name)
    return {"airhilt": __version__, "python": platform.python_version(), **found}


@functools.cache
def _version(package: str) -> str:
    return importlib.metadata.version(package)


def machine() -> dict[str, str]:
    """Return the operating system and the machine."""
    return {
        "system": platform.system(),
        "release": platform.release(),
        "machine": platform.machine(),
        "processors": str(os.cpu_count()),
    }


def refuse_links(*folders: Path) -> None:
    """Raise `RunFolderError` for a folder that is a link: what is written there is elsewhere."""
    for folder in folders:
        if folder.is_symlink():
            raise RunFolderError(
                f"{folder}: a link, which may lead elsewhere; delete it, or choose another folder "
                "with --out"
            )


class RunFolder:
    """The paths in a run folder; reads and writes its `RunInfo`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.info_path = path / "run.json"
        self.signature_path = path / "run.json.sig"
        self.log_path = path / "log.mcap"
        self.latency_path = path / "latency.jsonl"
        self.summary_path = path / "summary.json"
        self.report_path = path / "report.html"
        self.audio_path = path / "audio"
        self.pictures_path = path / "pictures"
        self.video_path = path / "video"

    def require_free(self, overwrite: bool = False) -> None:
        """Check that a run can be written here; nothing is written.

        It raises `RunFolderError` if the folder holds something already, leads elsewhere by a link,
        or cannot be written.
        """
        path = self.path
        refuse_links(self.audio_path, self.pictures_path, self.video_path)
        existing = next(parent for parent in (path, *path.absolute().parents) if parent.exists())
        if not existing.is_dir() or not os.access(existing, os.W_OK | os.X_OK):
            raise RunFolderError(
                f"{path}: cannot be written: {existing} is no folder that you may write in; choose "
                "another with --out"
            )
        if not path.is_dir() or not any(path.iterdir()):
            return
        try:
            self.info()
        except RunFolderError:
            raise RunFolderError(
                f"{path}: holds files that are no run; choose another folder with --out"
            ) from None
        if not overwrite:
            raise RunFolderError(
                f"{path}: holds a run already; choose another folder with --out, or replace it "
                "with --overwrite"
            )

    def create(self, overwrite: bool = False) -> None:
        """Make the folder, or delete the files of an earlier run in it; else as `require_free`."""
        self.require_free(overwrite)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            for path in (*self.results, self.info_path, self.signature_path, self.report_path):
                path.unlink(missing_ok=True)
        except OSError as error:
            raise RunFolderError(
                f"{self.path}: cannot be written: {error.strerror}; choose another folder with "
                "--out"
            ) from None

    @property
    def results(self) -> tuple[Path, ...]:
        """The files that the manifest has: what no other file of the run can give again."""
        kinds = ("audio/*.wav", "pictures/*.png", "pictures/*.jpg", "video/*.mp4")
        media = (path for kind in kinds for path in sorted(self.path.glob(kind)))
        return (*media, self.log_path, self.latency_path, self.summary_path)

    def manifest(self) -> dict[str, FileRecord]:
        """Return SHA-256 and size of each file that the run has written."""
        return manifest(self.path, self.results)

    @classmethod
    def open(cls, path: Path) -> RunFolder:
        """Return an existing run folder; `RunFolderError` if there is no run in it."""
        folder = cls(path)
        if not folder.info_path.is_file():
            raise RunFolderError(f"{path}: no run here; expected a folder with a run.json")
        return folder

    def read(self, path: Path) -> bytes:
        """Return the content of a small file; it raises what `read_inside` does."""
        return read_inside(self.path, path, bounded_json.MOST_BYTES)

    def write_info(self, info: RunInfo) -> None:
        """Write ``run.json`` with the hash of its content, all or nothing."""
        document = json.loads(info.model_dump_json())
        sealed = info.model_copy(update={"digest": digest(document)})
        self._write(self.info_path, sealed.model_dump_json(indent=2))

    def write_summary(self, summary: BaseModel) -> None:
        """Write ``summary.json``, all or nothing."""
        self._write(self.summary_path, summary.model_dump_json(indent=2))

    def _write(self, path: Path, text: str) -> None:
        try:
            replace_file(path, f"{text}\n".encode())
        except OSError as error:
            raise RunFolderError(f"{path}: cannot be written: {error.strerror}") from None

    def info(self) -> RunInfo:
        """Return ``run.json``; `RunFolderError` if it cannot be read or has another format."""
        try:
            data = self.read(self.info_path)
            bounded_json.require_few_values(data)
            return RunInfo.model_validate_json(data)
        except OSError as error:
            raise RunFolderError(f"{self.info_path}: cannot be read: {error.strerror}") from None
        except ValidationError as error:
            raise RunFolderError(
                f"{self.info_path}: {first_problem(error)}; expected a run.json of format {FORMAT}"
            ) from None
        except ValueError as error:
            raise RunFolderError(f"{self.info_path}: {error}") from None

    def summary(self) -> dict[str, Any] | None:
        """Return ``summary.json``, None if the run did not write it.

        It raises `RunFolderError` if it cannot be read, or is no JSON.
        """
        try:
            loaded = bounded_json.parse(self.read(self.summary_path))
            if not isinstance(loaded, dict):
                raise ValueError(f"{shown(loaded)} is no object")
        except FileNotFoundError:
            return None
        except OSError as error:
            raise RunFolderError(f"{self.summary_path}: cannot be read: {error.strerror}") from None
        except ValueError as error:
            raise RunFolderError(
                f"{self.summary_path}: no JSON: {first_line(error)}; expected the summary of a run"
            ) from None
        return loaded
