"""The network of the recogniser: what is exported, and what a training begins with."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="no torch or onnx: pip install torch onnx")
onnx = pytest.importorskip("onnx", reason="no torch or onnx: pip install torch onnx")

import onnxruntime  # noqa: E402

import train_asr  # noqa: E402
from airhilt.assistant.asr.engines.embedded import CONTEXT_FRAMES  # noqa: E402
from airhilt.assistant.asr.features import BINS  # noqa: E402
from airhilt.assistant.asr.pieces import Pieces  # noqa: E402
from batches import Batches  # noqa: E402
from mel_shards import MelCalls, load  # noqa: E402
from training import Training  # noqa: E402

pytestmark = pytest.mark.filterwarnings("default")  # torch's own
torch.set_num_threads(1)
PIECES = ("_alfa", "_bravo", "_", "a", "b")


@pytest.fixture
def trained(tmp_path: Path) -> Path:
    """Return the folder of a network that was saved after no step."""
    torch.manual_seed(0)
    network = train_asr.Recogniser(len(PIECES))
    given = Training(tmp_path, tmp_path, 0)
    (tmp_path / "pieces.txt").write_text("\n".join(PIECES))
    train_asr._save(network, train_asr.optimisers_of(network, 1e-3, adamw=False), 0, 0.0, given, 0)
    return tmp_path


def batches_of(lengths: Sequence[int], frames: int, seed: int) -> Batches:
    """Return batches of calls of some lengths, each with a unit of its own."""
    calls = MelCalls(
        torch.randn(sum(lengths), BINS).half().numpy(),
        np.array(lengths),
        [(index,) for index in range(len(lengths))],
        np.zeros(len(lengths), np.bool_),
    )
    return Batches(calls, np.ones((1, 500, BINS), np.float32), frames, seed)


def test_a_batch_follows_from_the_seed_and_its_step() -> None:
    torch.manual_seed(0)
    one = batches_of(range(100, 300, 5), 2_000, 1)
    torch.manual_seed(0)
    again, other = (batches_of(range(100, 300, 5), 2_000, seed) for seed in (1, 2))
    first = one.batch(7, 1.0)
    one.batch(8, 1.0)
    assert all(map(torch.equal, first, again.batch(7, 1.0)))
    assert not torch.equal(first.features[:1, :90], other.batch(7, 1.0).features[:1, :90])


def test_long_calls_are_drawn_as_often_as_short_ones() -> None:
    batches = batches_of([20] * 60 + [80] * 60, 800, 0)
    units = torch.cat([batches.batch(step, 1.0).units for step in range(400)])
    share = float((units < 60).float().mean())
    assert 0.45 < share < 0.55


def test_a_new_training_begins_with_short_calls_only() -> None:
    batches = batches_of([200] * 20 + [800] * 20, 4_000, 0)
    assert all(int(batches.batch(step, 0.01).units.max()) < 20 for step in range(5))
    assert any(int(batches.batch(step, 0.5).units.max()) >= 20 for step in range(5, 15))


def test_some_batches_have_a_call_in_which_nobody_speaks() -> None:
    batches = batches_of([20] * 20, 200, 0)
    silent = [bool((batches.batch(step, 1.0).sizes == 0).any()) for step in range(60)]
    assert 5 < sum(silent) < 35


def prepared(folder: Path, lines: list[dict[str, object]], received: list[int]) -> None:
    """Write a shard whose call of index i has 100 + i frames of the value i, as is received."""
    folder.mkdir()
    (folder / "shard.jsonl").write_text("".join(f"{json.dumps(line)}\n" for line in lines))
    sizes = [100 + index for index in range(len(lines))]
    np.savez(
        folder / "shard.mel.npz",
        clean=np.concatenate([np.full((n, BINS), i, np.float16) for i, n in enumerate(sizes)]),
        lengths=np.array(sizes),
        real=np.concatenate(
            [np.full((50, BINS), index, np.float16) for index in received]
            or [np.empty((0, BINS), np.float16)]
        ),
        real_of=np.array([(index, 50) for index in received], np.int64).reshape(-1, 2),
    )


def line(text: str, lineage: str, speaker: str) -> dict[str, object]:
    """Return what a shard says of a call."""
    return {"text": text, "lineage": lineage, "speaker": speaker}


def test_a_lineage_leaves_with_all_voices_of_its_speakers(tmp_path: Path) -> None:
    lines = [
        line("alfa", "rhvoice", "slt"),
        line("bravo", "festvox", "slt"),
        line("alfa bravo", "festvox", "kal"),
        line("alfa 7", "pico", "a woman"),
        line("b", "pico", "a woman"),
    ]
    prepared(tmp_path / "train", lines, received=[0, 1, 4])
    pieces = Pieces(list(PIECES))
    everything = load(tmp_path / "train", pieces, "")
    left = load(tmp_path / "train", pieces, "rhvoice")
    assert everything.lengths.tolist() == [100, 101, 102, 104, 50, 50, 50]
    assert everything.is_received.tolist() == [False] * 4 + [True] * 3
    assert left.lengths.tolist() == [102, 104, 50]
    assert [len(units) for units in left.units] == [2, 2, 2]
    assert left.logarithms[[0, 101, 102, 205, 206, -1], 0].tolist() == [2, 2, 4, 4, 4, 4]


def test_time_that_an_interrupted_training_took_counts(tmp_path: Path) -> None:
    lines = [line("alfa", "pico", "a woman"), line("bravo", "pico", "a woman")]
    prepared(tmp_path / "train", lines, received=[])
    (tmp_path / "pieces.txt").write_text("\n".join(PIECES))
    given = Training(tmp_path, tmp_path / "full", 2, batch_frames=300, adamw=True)
    train_asr.train(given)
    card = tmp_path / "full" / "training.json"
    assert json.loads(card.read_text())["steps"] == 2
    train_asr.train(replace(given, steps=4, minutes=1e-9))
    assert json.loads(card.read_text())["steps"] == 2
    train_asr.train(replace(given, steps=3))
    assert json.loads(card.read_text())["steps"] == 3


def test_a_training_without_prepared_calls_is_refused_in_words(tmp_path: Path) -> None:
    (tmp_path / "train").mkdir()
    (tmp_path / "pieces.txt").write_text("\n".join(PIECES))
    with pytest.raises(SystemExit, match=r"no prepared calls.*mel_shards\.py"):
        train_asr.train(Training(tmp_path, tmp_path / "full", 2))


def test_what_is_exported_hears_what_the_network_hears_in_steps_of_30_ms(trained: Path) -> None:
    train_asr.export(trained, trained / "model")
    network = train_asr.Recogniser(len(PIECES))
    network.load_state_dict(torch.load(trained / "checkpoint.pt", weights_only=True)["network"])
    network.eval()
    features = np.random.default_rng(0).standard_normal((1, 120, 64)).astype(np.float32)
    session = onnxruntime.InferenceSession(str(trained / "model" / "ctc.onnx"))
    (heard,) = session.run(None, {"features": features})
    with torch.no_grad():
        expected = network(torch.from_numpy(features)).numpy()
    assert heard.shape == (1, 40, len(PIECES) + 1)
    assert np.abs(heard - expected).max() < 0.02 * np.abs(expected).max()


def test_a_training_begins_with_the_weights_that_were_kept(trained: Path) -> None:
    train_asr.keep(trained, trained / "kept")
    network = train_asr.Recogniser(len(PIECES))
    train_asr.begin_with(network, trained / "kept")
    saved = torch.load(trained / "checkpoint.pt", weights_only=True)["network"]
    for name, weight in network.state_dict().items():
        assert torch.allclose(weight.float(), saved[name].float(), atol=1e-3), name


def test_weights_of_another_network_are_refused(trained: Path) -> None:
    train_asr.keep(trained, trained / "kept")
    with pytest.raises(SystemExit, match="weights of another network"):
        train_asr.begin_with(train_asr.Recogniser(len(PIECES) + 1), trained / "kept")


def test_a_step_hears_nothing_that_is_farther_away_than_the_context_of_a_window() -> None:
    torch.manual_seed(0)
    network = train_asr.Recogniser(len(PIECES)).eval()
    features = torch.randn(1, 2 * CONTEXT_FRAMES + 480, 64)
    with torch.no_grad():
        whole = network(features)
        features[:, : -CONTEXT_FRAMES - 240] = 0.0
        part = network(features)
    last = slice(-80, None)
    assert torch.allclose(whole[:, last], part[:, last], atol=1e-5)
    assert not torch.allclose(whole, part, atol=1e-2)
