"""Varies the calls of shards: the same words in other voices, rooms, microphones and codecs.

    python tools/asr/vary_speech.py build/asr/train build/asr/train --share 0.8 --seed 1

Each shard of the first folder gets a copy in the second, named ``NAME-varied-SEED``. What is taken
from another call (its timbre, or its babble) is of the same shard and lineage of voices, so that no
lineage that is left out of training comes in by that way.

Needs the extra ``resynthesis`` (pyworld).
"""

from __future__ import annotations

import argparse
import json
import sys
import time
import zlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

import rooms
from airhilt.audio.pcm import Audio
from linear_prediction import predicted
from resynthesis import analyse, draw_manner, resynthesise, timbre_of

LEAST_RMS, MOST_RMS = 0.02, 0.2
"""Levels of the calls that come out, relative to full scale."""
TIMBRE_SAMPLES = 32_000
"""Samples of a call that tell a timbre: 2 s."""
WORLD_SHARE = 0.8
LPC_SHARE = 0.04
"""Shares of the calls in another voice by WORLD, and by linear prediction."""
LINEAGE = "lineage"
Change = Callable[[Audio, Generator], Audio]
CHANGES: tuple[tuple[float, str, Change], ...] = (
    (0.10, "pauses", lambda speech, rng: rooms.hesitating(speech, int(rng.integers(1, 4)), rng)),
    (0.30, "key", rooms.keyed),
    (0.35, "room", lambda speech, rng: rooms.in_room(
        speech, float(rng.uniform(0.05, 0.4)), float(rng.uniform(0.0, 15.0)), rng)),
    (0.12, "engine", lambda speech, rng: rooms.with_engine(
        speech, float(rng.uniform(-32.0, -12.0)), rng)),
    (0.60, "microphone", rooms.through_microphone),
    (0.30, "resonance", lambda speech, rng: rooms.with_resonance(
        speech, float(rng.uniform(600.0, 3600.0)), float(rng.uniform(3.0, 12.0)),
        float(rng.uniform(1.0, 8.0)))),
    (0.10, "hum", lambda speech, rng: rooms.with_hum(
        speech, float(rng.choice((50.0, 60.0, 400.0))), float(rng.uniform(-40.0, -20.0)), rng)),
    (0.20, "clipping", lambda speech, rng: rooms.clipped(speech, float(rng.uniform(3.0, 18.0)))),
    (0.20, "gain control", lambda speech, rng: rooms.pumped(
        speech, float(rng.uniform(0.05, 0.5)), float(rng.uniform(0.2, 0.8)))),
    (0.08, "mu-law", lambda speech, _: rooms.mu_law(speech)),
    (0.05, "a-law", lambda speech, _: rooms.a_law(speech)),
    (0.05, "adpcm", lambda speech, _: rooms.adpcm(speech)),
    (0.05, "open microphone", rooms.with_hot_microphone),
)  # fmt: skip
"""Share of the calls, name and function of each change, in the order of the signal."""
BABBLE_SHARE = 0.06


def vary(
    speech: Audio,
    rng: Generator,
    others: Sequence[Audio] = (),
    world_share: float = WORLD_SHARE,
    done: list[str] | None = None,
) -> Audio:
    """Return speech in another voice, at another place, through other equipment.

    Parameters
    ----------
    others
        Other calls, of which one may lend its timbre and one may be heard beneath.
    done
        Takes the names of what was done, if it is given.
    """
    names = [] if done is None else done
    speech = _in_another_voice(speech, rng, others, world_share, names)
    for share, name, change in CHANGES:
        if rng.random() < share:
            speech = change(speech, rng)
            names.append(name)
    if others and rng.random() < BABBLE_SHARE:
        other = others[int(rng.integers(len(others)))]
        speech = rooms.with_babble(speech, other, float(rng.uniform(-28.0, -12.0)), rng)
        names.append("babble")
    level = float(np.exp(rng.uniform(np.log(LEAST_RMS), np.log(MOST_RMS))))
    return np.asarray(np.clip(speech * (level / rooms.rms(speech)), -1.0, 1.0), np.float32)


def _in_another_voice(
    speech: Audio, rng: Generator, others: Sequence[Audio], world_share: float, names: list[str]
) -> Audio:
    kind = rng.random()
    if kind < world_share:
        manner = draw_manner(rng)
        timbre = None
        if others and manner.borrowed:
            timbre = timbre_of(others[int(rng.integers(len(others)))][:TIMBRE_SAMPLES])
        names.append("whisper" if manner.whispered else "world")
        return rooms.at_level_of(resynthesise(analyse(speech), manner, rng, timbre), speech)
    if kind < world_share + LPC_SHARE:
        names.append("linear prediction")
        pitch = float(rng.uniform(0.7, 1.4))
        return rooms.at_level_of(predicted(speech, rng, pitch), speech)
    return speech


# --- shards --------------------------------------------------------------------------------


def varied(
    lines: list[dict[str, Any]], samples: NDArray[np.int16], seed: int, share: float
) -> Iterator[tuple[dict[str, Any], NDArray[np.int16]]]:
    """Yield the calls of a shard, varied, each with its line."""
    ends = np.cumsum([line["samples"] for line in lines])
    of_lineage: dict[str, list[int]] = {}
    for index, line in enumerate(lines):
        of_lineage.setdefault(line.get(LINEAGE, line["voice"]), []).append(index)

    def speech_of(index: int) -> Audio:
        pcm = samples[ends[index] - lines[index]["samples"] : ends[index]]
        return np.asarray(pcm, np.float32) / np.float32(32767.0)

    for index, line in enumerate(lines):
        rng = np.random.default_rng([seed, index])
        akin = of_lineage[line.get(LINEAGE, line["voice"])]
        others = [speech_of(int(each)) for each in rng.choice(akin, 2)]
        done: list[str] = []
        speech = vary(speech_of(index), rng, others, share, done)
        pcm = np.asarray(np.rint(speech * 32767.0), np.int16)
        yield line | {"samples": len(pcm), "varied": done}, pcm


def write_varied(path: Path, folder: Path, seed: int, share: float) -> None:
    """Write the varied copy of a shard."""
    name = f"{path.stem}-varied-{seed}"
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    samples = np.load(path.with_suffix(".npy"), mmap_mode="r")
    calls = list(varied(lines, samples, zlib.crc32(name.encode()), share))
    np.save(folder / f"{name}.tmp.npy", np.concatenate([pcm for _, pcm in calls]))
    text = "".join(f"{json.dumps(about)}\n" for about, _ in calls)
    (folder / f"{name}.jsonl").write_text(text)
    (folder / f"{name}.tmp.npy").rename(folder / f"{name}.npy")


def main() -> None:
    """Vary the shards of a folder that have no varied copy yet."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path, help="folder of shards, or one shard (.jsonl)")
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--share", type=float, default=WORLD_SHARE, help="share of the calls in another voice"
    )
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    paths = [given.source] if given.source.is_file() else sorted(given.source.glob("*.jsonl"))
    if not paths:
        sys.exit(f"{given.source}: no shard (.jsonl with .npy); see tools/asr/asr_speech.py")
    given.folder.mkdir(parents=True, exist_ok=True)
    for path in paths:
        target = given.folder / f"{path.stem}-varied-{given.seed}.npy"
        if "-varied-" in path.stem or target.exists() or not path.with_suffix(".npy").exists():
            continue
        begun = time.process_time()
        write_varied(path, given.folder, given.seed, given.share)
        print(f"{target.stem}: {time.process_time() - begun:.0f} s of CPU", flush=True)


if __name__ == "__main__":
    main()
