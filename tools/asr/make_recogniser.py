"""Makes the embedded recogniser from nothing: speech, network, language model and confidence.

    python tools/asr/make_recogniser.py build/asr --processes 16 --device cuda --bfloat16
    python tools/asr/make_recogniser.py build/x --share 0.01 --steps 10 --adamw --batch-frames 4000

It runs the other tools of this folder one after another, prints each command, and ends at the first
one that fails. After an interruption, speech that was made is kept, and the training goes on. All
synthesisers of `SPOKEN` must be installed (`synthesisers/README.md`), and torch, tokenizers, onnx
and pyworld. The model is in ``MODEL`` of the folder at the end.
"""

from __future__ import annotations

import argparse
import shlex
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import partial
from pathlib import Path
from threading import Event
from typing import NamedTuple

from asr_speech import stem
from training import add_options, options_of

HERE = Path(__file__).parent
SECOND_EXAM = HERE.parent / "phraseology_judge" / "second_exam.jsonl"
MODEL = "model"
"""Name of the folder of the model."""
STEPS, RATE, BATCH_FRAMES = 9_000, 2e-3, 48_000
"""Settings of the training, if no others are given."""
VARIED_SHARE = 0.8
"""Share of the calls of a varied shard that are spoken again in another voice."""
LANGUAGE_CALLS = 250_000
"""Texts of the language model."""
DEV_CALLS, DEV_SEED, DEV_EXAM_SEED = 40, 991, 992
"""Calls of each synthesiser that confidence is fitted on: made-up ones, and those of an exam."""


class Spoken(NamedTuple):
    """Shards of a synthesiser.

    Attributes
    ----------
    calls
        Calls of each shard.
    varied
        Shards, the first ones, that are varied too.
    first_seed
        Seed of the first shard; the next one has the next.
    """

    synthesiser: str
    voices: str
    shards: int
    calls: int
    varied: int
    first_seed: int = 100


SPOKEN = (
    Spoken("rhvoice", "all", 14, 400, 4),
    Spoken("festival_hts", "all", 5, 300, 0),
    Spoken("flite", "all", 10, 450, 3),
    Spoken("pico", "all", 12, 450, 3),
    Spoken("festival", "all", 9, 600, 0),
    Spoken("espeak", "all", 9, 800, 0),
    Spoken("piper", "seen", 16, 250, 2, first_seed=200),
)
"""Speech that the model which ships was trained on: 33,600 calls, and 4,800 of them varied."""


class Maker:
    """Runs the tools.

    Parameters
    ----------
    build
        Folder of all that is made.
    share
        Share of the calls that is made, in (0, 1].
    """

    def __init__(self, build: Path, share: float) -> None:
        self._build, self._share = build, share
        self._exam = build / SECOND_EXAM.name

    def speak(self, processes: int) -> None:
        """Make the shards of training, and those that confidence is fitted on."""
        exam = SECOND_EXAM.read_text().splitlines()[: self._scaled(DEV_CALLS)]
        self._exam.write_text("\n".join(exam) + "\n")
        works = [
            partial(self._shard, each, number) for each in SPOKEN for number in range(each.shards)
        ]
        works += [partial(self._dev, each) for each in SPOKEN]
        has_failed = Event()

        def do(work: Callable[[], None]) -> None:
            """Do a work, unless another one has failed."""
            if has_failed.is_set():
                return
            try:
                work()
            except BaseException:
                has_failed.set()
                raise

        with ThreadPoolExecutor(processes) as pool:
            try:
                for done in as_completed([pool.submit(do, work) for work in works]):
                    done.result()
            except BaseException:
                has_failed.set()
                raise

    def train(self, options: list[str]) -> None:
        """Learn the pieces, train the network, learn the language model, fit the confidence."""
        build, model = self._build, self._build / MODEL
        if not (build / "pieces.txt").exists():
            run("learn_pieces.py", build / "pieces.txt")
        run("train_asr.py", "train", build, "--into", build / "full", *options)
        run("train_asr.py", "export", build / "full", model)
        run("learn_language.py", model, "--calls", self._scaled(LANGUAGE_CALLS))
        run("calibrate_asr.py", build / "dev", model)

    def _scaled(self, count: int) -> int:
        return max(4, round(self._share * count))

    def _shard(self, spoken: Spoken, number: int) -> None:
        folder, seed = self._build / "train", spoken.first_seed + number
        path = folder / f"{stem(spoken.synthesiser, spoken.voices)}-{seed}-000.jsonl"
        if not path.with_suffix(".npy").exists():
            speak(folder, spoken, seed, "--count", self._scaled(spoken.calls))
        run("mel_shards.py", path)
        if number < spoken.varied:
            run("vary_speech.py", path, folder, "--share", VARIED_SHARE, "--seed", 1)
            run("mel_shards.py", path.with_name(f"{path.stem}-varied-1.jsonl"))

    def _dev(self, spoken: Spoken) -> None:
        folder, begin = self._build / "dev", stem(spoken.synthesiser, spoken.voices)
        if not (folder / f"{begin}-{DEV_SEED}-000.npy").exists():
            speak(folder, spoken, DEV_SEED, "--count", self._scaled(DEV_CALLS))
        begin = stem(spoken.synthesiser, spoken.voices, self._exam.stem)
        if not (folder / f"{begin}-{DEV_EXAM_SEED}-000.npy").exists():
            speak(folder, spoken, DEV_EXAM_SEED, "--calls", self._exam)


def speak(folder: Path, spoken: Spoken, seed: int, *options: object) -> None:
    """Make a shard of speech."""
    voices = ("--voices", spoken.voices, "--seed", seed)
    run("asr_speech.py", folder, spoken.synthesiser, *voices, *options)


def run(tool: str, *arguments: object) -> None:
    """Run a tool of this folder; end if it fails."""
    command = [sys.executable, str(HERE / tool), *map(str, arguments)]
    print(f"$ {shlex.join(['python', str(Path('tools/asr') / tool), *command[2:]])}", flush=True)
    if subprocess.run(command).returncode:
        raise SystemExit(f"make_recogniser: {tool} failed with the command above")


def main() -> None:
    """Make the model."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--processes", type=int, default=2, help="synthesisers at the same time")
    parser.add_argument("--share", type=float, default=1.0, help="share of the calls, to try it")
    add_options(parser, STEPS, rate=RATE, batch_frames=BATCH_FRAMES)
    given = vars(parser.parse_args())
    build: Path = given.pop("build")
    build.mkdir(parents=True, exist_ok=True)
    maker = Maker(build, given.pop("share"))
    maker.speak(given.pop("processes"))
    maker.train(options_of(given))


if __name__ == "__main__":
    main()
