"""Requests to a worker and their outcomes: JSON, from process to process."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from shutil import rmtree
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue

Keep = Literal["none", "failed", "all"]
"""Runs whose folders stay: none, those that failed, or all."""
Status = Literal["finished", "failed", "over_time", "over_memory", "crashed"]
"""Ways in which a run ends.

finished: with a summary. failed: it raised an error, which any machine would. The others depend on
the machine: its process was ended by the limit of time or of memory, or died, or could not write.
"""
OF_THE_MACHINE: tuple[Status, ...] = ("over_time", "over_memory", "crashed")


class Request(BaseModel):
    """One run for a worker."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    key: str
    scenario: dict[str, JsonValue]
    options: dict[str, JsonValue]
    keep: Keep
    folder: str
    """Place of the run folder if it stays."""
    files: Mapping[str, str] = {}
    """SHA-256 of each file that scenario or options name, as the key has them."""

    @property
    def partial_folder(self) -> Path:
        """Place of the run folder while the run goes on, if it may stay."""
        return Path(f"{self.folder}.partial")

    def settle(self, folder: Path, status: Status) -> bool:
        """Move a run folder to where it stays, or delete it; return whether it stays."""
        is_kept = self.keep == "all" or (self.keep == "failed" and status != "finished")
        if is_kept and folder.is_dir():
            with suppress(FileNotFoundError):
                rmtree(self.folder)
            folder.replace(self.folder)
            return True
        rmtree(folder, ignore_errors=True)
        return False


class Machine(BaseModel):
    """Cost of a run on the machine that ran it."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    wall_s: float = Field(description="wall time of the run, without the start of its process")
    cpu_s: float | None = Field(description="CPU time of its process and of the renderer's")
    peak_memory_mb: Annotated[float, Field(ge=0.0)] = Field(
        description="most memory of these processes together (resident set), sampled"
    )
    host: str = Field(description="name of the machine")
    process: int = Field(description="process number there")


class Outcome(BaseModel):
    """Outcome of one run."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    key: str
    status: Status
    cause: str = ""
    """Cause of its end, in one line; empty if it finished."""
    is_kept: bool = False
    metrics: dict[str, Any] = {}
    """`airhilt.metrics.columns`, by name; empty unless it finished."""
    machine: Machine
