"""One run as a row of a comparison."""

from __future__ import annotations

import tempfile
from pathlib import Path

from pydantic import BaseModel, ConfigDict

import airhilt
from airhilt.files import replace_file


class Case(BaseModel):
    """A run that is compared with others."""

    model_config = ConfigDict(frozen=True)
    scenario: str
    seed: int
    assistant: str
    cameras: bool
    speech: bool
    latency: str

    @property
    def file_name(self) -> str:
        """Name of the file that holds its row."""
        modalities = f"{'c' if self.cameras else ''}{'s' if self.speech else ''}" or "text"
        latency = self.latency.replace(":", "").replace(",", "-").replace("=", "")
        return f"{self.scenario}-{self.seed}-{self.assistant}-{modalities}-{latency}.json"


class Row(Case):
    """Outcome of a run; see docs/metrics.md for the fields."""

    family: str
    outcome: str
    has_conflict: bool
    is_warned: bool
    avoided: bool | None
    loss_of_separation: bool
    nmac: bool
    collision: bool
    runway_incursion_category: str | None
    time_to_first_warning_s: float | None
    nuisance_alerts: int | None
    nuisances: list[str]
    """Kind, severity and traffic of each nuisance."""


def run_case(case: Case, folder: Path) -> None:
    """Run a case, and write its row to a folder."""
    scenario = airhilt.load(case.scenario)
    with tempfile.TemporaryDirectory() as scratch:
        summary = airhilt.run(
            scenario,
            seed=case.seed,
            assistant=case.assistant,
            cameras=case.cameras,
            speech=case.speech,
            latency=case.latency,
            out=Path(scratch) / "run",
        ).summary
    row = Row(
        **case.model_dump(),
        family=scenario.family,
        outcome=summary.outcome,
        has_conflict=scenario.conflict is not None,
        is_warned=summary.t_first_warning_s is not None,
        avoided=summary.avoided,
        loss_of_separation=summary.loss_of_separation,
        nmac=summary.nmac,
        collision=summary.collision,
        runway_incursion_category=summary.runway_incursion_category,
        time_to_first_warning_s=summary.time_to_first_warning_s,
        nuisance_alerts=summary.nuisance_alerts,
        nuisances=[
            f"{each.kind} {each.severity} {' '.join(each.traffic)}"
            for each in summary.advisories
            if each.nuisance
        ],
    )
    replace_file(folder / case.file_name, row.model_dump_json(indent=2).encode())
