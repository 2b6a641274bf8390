"""The network of the recogniser: what is exported, and what a training begins with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="no torch or onnx: pip install torch onnx")
onnx = pytest.importorskip("onnx", reason="no torch or onnx: pip install torch onnx")

import onnxruntime  # noqa: E402

import train_asr  # noqa: E402
from airhilt.assistant.asr.engines.embedded import CONTEXT_FRAMES  # noqa: E402
from airhilt.assistant.asr.features import BINS  # noqa: E402
from batches import Batches  # noqa: E402
from mel_shards import MelCalls  # noqa: E402

pytestmark = pytest.mark.filterwarnings("default")  # torch's own
torch.set_num_threads(1)
PIECES = ("_alfa", "_bravo", "_", "a", "b")


@pytest.fixture
def trained(tmp_path: Path) -> Path:
    """Return the folder of a network that was saved after no step."""
    torch.manual_seed(0)
    network = train_asr.Recogniser(len(PIECES))
    given = train_asr.Training(tmp_path, tmp_path, 0)
    (tmp_path / "pieces.txt").write_text("\n".join(PIECES))
    train_asr._save(network, train_asr.optimisers_of(network, 1e-3, adamw=False), 0, given, 0)
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


def test_large_weights_are_kept_in_half_precision(trained: Path) -> None:
    train_asr.export(trained, trained / "model")
    parameters = sum(each.numel() for each in train_asr.Recogniser(len(PIECES)).parameters())
    assert (trained / "model" / "ctc.onnx").stat().st_size < 2.2 * parameters


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


@pytest.mark.parametrize("adamw", [False, True])
def test_all_weights_have_one_optimiser(adamw: bool) -> None:
    network = train_asr.Recogniser(len(PIECES))
    given = [
        id(weight)
        for optimiser in train_asr.optimisers_of(network, 1e-3, adamw=adamw)
        for group in optimiser.param_groups
        for weight in group["params"]
    ]
    assert sorted(given) == sorted(id(weight) for weight in network.parameters())


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
