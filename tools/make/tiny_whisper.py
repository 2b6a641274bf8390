"""Make the tiny Whisper model of the tests: the real architecture, and one sentence.

    python tools/make/tiny_whisper.py tests/data/tiny_whisper
    python tools/make/tiny_whisper.py build/untrained --untrained

Needs ``transformers``, ``ctranslate2``, ``tokenizers`` and ``torch``: the extra ``finetune``.
The first is what `ct2-transformers-converter` would write of a real model. Whatever it is
given, it has learned to hear the same, in the spelling of a general recogniser. The second is a
folder as transformers saves it, of random weights, for ``tools/finetune_whisper.py``.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path

import torch
from ctranslate2.converters import TransformersConverter
from tokenizers import AddedToken, Tokenizer, decoders, models, pre_tokenizers
from transformers import (
    GenerationConfig,
    PreTrainedTokenizerFast,
    WhisperConfig,
    WhisperFeatureExtractor,
    WhisperForConditionalGeneration,
)

WIDTH = 32
LAYERS = 1
UNTRAINED_WIDTH = 64
UNTRAINED_LAYERS = 2
WINDOW_S = 10
"""Shorter than Whisper's 30 s, so that tests see that windows are cut to it."""
TIMESTAMPS = 1501
"""Number of time stamps, 0.02 s apart, up to 30 s."""
SENTENCE = (" Tower", ",", " run", " way", " 01", "L", " cleared", " to", " land", ".")
BEGIN, END = "<|0.00|>", "<|2.00|>"
STEPS = 300
SPECIAL = (
    "<|endoftext|>", "<|startoftranscript|>", "<|en|>", "<|translate|>", "<|transcribe|>",
    "<|startoflm|>", "<|startofprev|>", "<|nospeech|>", "<|notimestamps|>",
)  # fmt: skip


def tokenizer() -> Tokenizer:
    """Return a byte-level tokenizer without merges: bytes, parts of the sentence, special ones."""
    letters = sorted(pre_tokenizers.ByteLevel.alphabet())
    parts = [part.replace(" ", "\u0120") for part in SENTENCE if len(part) > 1]
    made = Tokenizer(models.BPE({text: i for i, text in enumerate(letters + parts)}, []))
    made.pre_tokenizer = pre_tokenizers.ByteLevel(add_prefix_space=False)
    made.decoder = decoders.ByteLevel()
    made.add_special_tokens([AddedToken(token, special=True) for token in SPECIAL])
    stamps = (f"<|{0.02 * i:.2f}|>" for i in range(TIMESTAMPS))
    made.add_tokens([AddedToken(stamp, special=False) for stamp in stamps])
    return made


def teach(model: WhisperForConditionalGeneration, made: Tokenizer) -> None:
    """Make the model hear the sentence in everything, after any prompt."""
    number = made.token_to_id
    start = [number(name) for name in ("<|startoftranscript|>", "<|en|>", "<|transcribe|>")]
    words = [number(part.replace(" ", "\u0120")) for part in SENTENCE]
    said = [*start, number(BEGIN), *words, number(END), number("<|endoftext|>")]
    optimiser = torch.optim.AdamW(model.parameters(), 3e-3)
    for _ in range(STEPS):
        size = int(torch.randint(1, 80, ()))
        prompt = torch.randint(0, 256, (8, size))
        prompt[:, 0] = number("<|startofprev|>")
        tokens = torch.cat([prompt, torch.tensor(said).expand(8, -1)], 1)
        labels = tokens[:, 1:].clone()
        labels[:, : size - 1] = -100
        loss = model(
            input_features=torch.randn(8, 80, 100 * WINDOW_S),
            decoder_input_ids=tokens[:, :-1],
            labels=labels,
        ).loss
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    print(f"loss {loss.item():.4f}", file=sys.stderr)


def random_model(made: Tokenizer, width: int, layers: int) -> WhisperForConditionalGeneration:
    """Return a model of the architecture of Whisper, with random weights."""
    torch.manual_seed(0)
    token = {name: made.token_to_id(name) for name in SPECIAL}
    model = WhisperForConditionalGeneration(configuration(made, token, width, layers))
    model.generation_config = GenerationConfig(
        eos_token_id=token["<|endoftext|>"],
        decoder_start_token_id=token["<|startoftranscript|>"],
        no_timestamps_token_id=token["<|notimestamps|>"],
        lang_to_id={"<|en|>": token["<|en|>"]},
        alignment_heads=[[0, 0]],
        suppress_tokens=[],
        begin_suppress_tokens=[],
    )
    return model


def configuration(made: Tokenizer, token: dict[str, int], width: int, layers: int) -> WhisperConfig:
    """Return the architecture of Whisper, of a size."""
    return WhisperConfig(
        vocab_size=made.get_vocab_size(),
        num_mel_bins=80,
        d_model=width,
        encoder_layers=layers,
        decoder_layers=layers,
        encoder_attention_heads=2,
        decoder_attention_heads=2,
        encoder_ffn_dim=width,
        decoder_ffn_dim=width,
        max_source_positions=WINDOW_S * 50,
        max_target_positions=448,
        bos_token_id=token["<|endoftext|>"],
        eos_token_id=token["<|endoftext|>"],
        pad_token_id=token["<|endoftext|>"],
        decoder_start_token_id=token["<|startoftranscript|>"],
        suppress_tokens=None,
        begin_suppress_tokens=None,
    )


def save(model: WhisperForConditionalGeneration, made: Tokenizer, folder: Path) -> None:
    """Write a model as transformers saves it."""
    model.save_pretrained(folder)
    roles = dict.fromkeys(("unk_token", "eos_token", "bos_token"), "<|endoftext|>")
    PreTrainedTokenizerFast(tokenizer_object=made, **roles).save_pretrained(folder)
    WhisperFeatureExtractor(chunk_length=WINDOW_S).save_pretrained(folder)
    made.save(str(folder / "tokenizer.json"), pretty=False)
    settings = folder / "preprocessor_config.json"
    kept = json.loads(settings.read_text())
    kept.pop("mel_filters", None)
    settings.write_text(json.dumps(kept, indent=1))


def convert(model: WhisperForConditionalGeneration, made: Tokenizer, out: Path) -> None:
    """Write a model as faster-whisper reads it."""
    with tempfile.TemporaryDirectory() as folder:
        save(model, made, Path(folder))
        TransformersConverter(
            folder, copy_files=["tokenizer.json", "preprocessor_config.json"]
        ).convert(str(out), quantization="int8", force=True)


def main() -> None:
    """Train the model and convert it, or save it untrained."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--untrained", action="store_true", help="random weights, not converted")
    given = parser.parse_args()
    out: Path = given.out
    made = tokenizer()
    if given.untrained:
        save(random_model(made, UNTRAINED_WIDTH, UNTRAINED_LAYERS), made, out)
    else:
        model = random_model(made, WIDTH, LAYERS)
        teach(model, made)
        convert(model, made, out)
    for path in sorted(out.iterdir()):
        print(f"{path.stat().st_size:9d} {path}", file=sys.stderr)


if __name__ == "__main__":
    main()
