"""Judges the recipe of the embedded recogniser on voices that it has not met.

    python tools/asr/leave_one_out.py build/asr --steps 6000
    python tools/asr/leave_one_out.py build/asr --steps 6000 --lineage pico

For each lineage of voices a network is trained without it, and without all other voices of its
speakers, and is scored on the calls of that lineage: those of ``test`` and, if there are any, those
of ``exam``, which say what they mean. ``build/asr`` has ``pieces.txt``, the language model
``language.npz`` (`learn_language`), and the prepared shards in ``train``. The models stay in
``build/asr/without/LINEAGE/model``, their scores beside them. Their confidence and the weight of
their language model are those of a model that was calibrated. A training that was interrupted goes
on.
"""

from __future__ import annotations

import argparse
import json
import shutil
from collections.abc import Iterable
from pathlib import Path
from statistics import mean
from typing import Any

import airhilt.assistant.asr.engines.embedded
from calibrate_asr import write_into_card
from eval_asr import evaluate
from synthesisers import FAMILY
from train_asr import export, train
from training import Training, add_options

SHIPPED = Path(airhilt.assistant.asr.engines.embedded.__file__).parents[1] / "model"
CALIBRATED = (
    "word_curve", "lost_words", "callsign_odds", "call_calibration", "least_word_confidence",
    "best_word_threshold", "language_weight", "piece_reward",
)  # fmt: skip
"""Values of a card that `calibrate_asr` fits."""
MEASURES = ("wer", "callsigns", "items", "acted_upon", "acted_upon_wrongly")


def lineages() -> list[str]:
    """Return the lineages that a model may be trained on."""
    voices = (voice for name in FAMILY.names() for voice in FAMILY.load(name).voices)
    return sorted({voice.lineage for voice in voices if not voice.is_test_only})


def judge(given: Training, limit: int, calibrated: Path) -> list[dict[str, Any]]:
    """Train without a lineage, and return the scores on it."""
    train(given)
    model = given.into / "model"
    export(given.into, model)
    shutil.copy(given.build / "language.npz", model / "language.npz")
    card = json.loads((calibrated / "card.json").read_text())
    write_into_card(model, {name: card[name] for name in CALIBRATED})
    numbers = []
    for calls in ("test", "exam"):
        if (given.build / calls).is_dir():
            rows = evaluate(f"embedded:{model}", given.build / calls, limit, (given.without,))
            numbers += [{"set": calls, **row} for row in rows]
    (given.into / "scores.json").write_text(json.dumps(numbers, indent=1) + "\n")
    return numbers


def means(numbers: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the mean over the lineages of each measure, by set and ratio."""
    groups: dict[tuple[str, float | None], list[dict[str, Any]]] = {}
    for row in numbers:
        groups.setdefault((row["set"], row["snr_db"]), []).append(row)
    found = []
    for (calls, snr_db), rows in groups.items():
        about: dict[str, Any] = {"set": calls, "snr_db": snr_db, "lineages": len(rows)}
        for name in MEASURES:
            known = [row[name] for row in rows if row[name] is not None]
            about[name] = round(mean(known), 2) if known else None
        found.append(about)
    return found


def main() -> None:
    """Print the scores of each lineage and their mean."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--lineage", action="append", help="lineage to leave out; all if not given")
    parser.add_argument("--limit", type=int, default=120, help="calls of a lineage and set")
    parser.add_argument(
        "--calibrated", type=Path, default=SHIPPED,
        help="model whose confidence and weight of the language model all have; that of AIRHILT",
    )  # fmt: skip
    add_options(parser, steps=6_000)
    given = vars(parser.parse_args())
    build, limit, chosen = given.pop("build"), given.pop("limit"), given.pop("lineage")
    calibrated = given.pop("calibrated")
    numbers = [
        row
        for lineage in chosen or lineages()
        for row in judge(
            Training(build, build / "without" / lineage, without=lineage, **given),
            limit,
            calibrated,
        )
    ]
    for row in means(numbers):
        print(json.dumps(row))


if __name__ == "__main__":
    main()
