"""The way from nothing to the recogniser that ships."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("torch", reason="no torch or onnx: pip install torch onnx")
pytest.importorskip("onnx", reason="no torch or onnx: pip install torch onnx")

import make_recogniser  # noqa: E402
from synthesisers import FAMILY  # noqa: E402

pytestmark = pytest.mark.filterwarnings("default")  # torch's own


def test_no_voice_that_is_for_tests_alone_is_trained() -> None:
    for spoken in make_recogniser.SPOKEN:
        voices = FAMILY.load(spoken.synthesiser).choose(spoken.voices)
        assert voices
        assert not any(voice.is_test_only for voice in voices)


def test_every_lineage_that_may_be_trained_is() -> None:
    def lineages(names: list[str]) -> set[str]:
        voices = (voice for name in names for voice in FAMILY.load(name).voices)
        return {voice.lineage for voice in voices if not voice.is_test_only}

    assert lineages([each.synthesiser for each in make_recogniser.SPOKEN]) == lineages(
        list(FAMILY.names())
    )


def test_shards_of_a_synthesiser_have_seeds_of_their_own_and_none_of_confidence() -> None:
    seeds = [
        (each.synthesiser, each.first_seed + number)
        for each in make_recogniser.SPOKEN
        for number in range(each.shards)
    ]
    assert len(set(seeds)) == len(seeds)
    assert {make_recogniser.DEV_SEED, make_recogniser.DEV_EXAM_SEED}.isdisjoint(
        seed for _, seed in seeds
    )


def test_it_ends_at_a_tool_that_fails(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with pytest.raises(SystemExit, match=r"mel_shards\.py failed"):
        make_recogniser.run("mel_shards.py", "--no-such-option", tmp_path)
    printed = capfd.readouterr().out
    assert printed.startswith("$ python tools/asr/mel_shards.py --no-such-option")
