"""Compares the reference assistant with and without its guard against words in doubt.

    python tools/compare_guard.py --out runs/guard
    python tools/compare_guard.py --scenarios s01a_bad_readback --snr=clean,-3 --out runs/guard
    python tools/compare_guard.py --tts http://127.0.0.1:8765 --out runs/guard

Runs have speech, fixed latencies and no cameras. Of each run it counts whether the conflict was
avoided, the questions that were asked, the nuisance alerts, and the beliefs about clearances and
levels: wrong ones, which nobody could have by what was said, and missing ones.
"""

from __future__ import annotations

import argparse
import re
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from pydantic import BaseModel
from rich.console import Console
from rich.progress import track
from rich.table import Table

import airhilt
import standard_output
from airhilt.assistant.decision.engines.reference import ReferenceConfig, ReferenceEngine
from airhilt.assistant.decision.worker import DecisionWorker
from airhilt.assistant.wording.engines.template import Template
from airhilt.engine_families import VOICES
from airhilt.phraseology import TAU_ASR
from guard.beliefs import beliefs_of, wrong

SCENARIOS = (
    "s01a_bad_readback,s01a_cancel_not_received,s01a_misaddressed,s01b_dropped_hold,"
    "s01b_misaddressed_hold,s02a_vertical,s01a_nominal,s01b_nominal,s02a_nominal"
)


class Row(BaseModel):
    """Outcome of one run."""

    scenario: str
    seed: int
    snr: str
    tau_asr: float
    has_conflict: bool
    avoided: bool
    questions: int
    nuisances: int
    wrong: int
    missing: int
    right: int

    @property
    def group(self) -> tuple[str, str, float]:
        """Kind of scenario, noise, and threshold."""
        return "conflict" if self.has_conflict else "nominal", self.snr, self.tau_asr


def main() -> None:
    """Run what is missing, and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenarios", default=SCENARIOS, help="names, separated by commas")
    parser.add_argument("--snr", default="clean,10,0", help="ratios in dB, separated by commas")
    parser.add_argument("--seeds", type=int, default=2, help="number of seeds, from 0 on")
    parser.add_argument(
        "--tts", default=VOICES.default, help="what speaks: an engine, or an address"
    )
    parser.add_argument("--out", type=Path, required=True, help="folder for the rows")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    cases = [
        (scenario, seed, snr, tau_asr)
        for snr in given.snr.split(",")
        for scenario in given.scenarios.split(",")
        for seed in range(given.seeds)
        for tau_asr in (TAU_ASR, 0.0)
    ]
    console = Console(stderr=True)
    rows = [_row(given.out, given.tts, *case) for case in track(cases, "running", console=console)]
    Console().print(_table(rows))


def _row(folder: Path, tts: str, scenario: str, seed: int, snr: str, tau_asr: float) -> Row:
    """Return the row of a run; one that the folder has already is not run again."""
    path = folder / f"{scenario}-{seed}-{snr}-{tau_asr:g}-{re.sub(r'[^a-z0-9]+', '_', tts)}.json"
    if path.exists():
        return Row.model_validate_json(path.read_text())
    engine = ReferenceEngine(ReferenceConfig(tau_asr=tau_asr))
    with tempfile.TemporaryDirectory() as scratch:
        result = airhilt.run(
            scenario,
            out=Path(scratch) / "run",
            workers=[DecisionWorker(engine, Template())],
            seed=seed,
            latency="fixed",
            cameras=False,
            tts=tts,
            snr_db=None if snr == "clean" else float(snr),
        )
        loaded = airhilt.load(scenario)
        callsigns = [actor.callsign for actor in loaded.actors]
        heard, said = beliefs_of(result.folder, tau_asr, callsigns)
    summary = result.summary
    row = Row(
        scenario=scenario,
        seed=seed,
        snr=snr,
        tau_asr=tau_asr,
        has_conflict=loaded.conflict is not None,
        avoided=summary.avoided is True,
        questions=summary.clarifications,
        nuisances=summary.nuisance_alerts or 0,  # None only where exposures are left out.
        wrong=len(wrong(heard.held, said.held)),
        missing=len(said.held - heard.held),
        right=len(said.held & heard.held),
    )
    path.write_text(row.model_dump_json())
    return row


def _table(rows: Sequence[Row]) -> Table:
    table = Table("runs", "SNR", "tau_ASR", "number", "avoided", "questions", "nuisance alerts")
    for title in ("wrong beliefs", "missing beliefs", "right beliefs"):
        table.add_column(title)
    for line in _lines(rows):
        table.add_row(*line)
    return table


def _lines(rows: Sequence[Row]) -> Iterator[tuple[str, ...]]:
    for group in dict.fromkeys(row.group for row in rows):
        own = [row for row in rows if row.group == group]
        kind, snr, tau_asr = group
        avoided = str(sum(row.avoided for row in own)) if kind == "conflict" else "-"
        counts = (
            sum(getattr(row, name) for row in own)
            for name in ("questions", "nuisances", "wrong", "missing", "right")
        )
        yield kind, snr, f"{tau_asr:g}", str(len(own)), avoided, *map(str, counts)


if __name__ == "__main__":
    standard_output.run(main)
