"""Make a tiny random language model, as llama.cpp reads it: the real architecture, and no sense.

    python tools/make/tiny_language_model.py tiny.gguf
    python -m llama_cpp.server --model tiny.gguf --n_ctx 8192

Needs ``gguf``, which AIRHILT does not need. The weights are random numbers of a fixed seed, so that
what the model says, in whatever grammar a JSON schema gives it, is nonsense, and always the same.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import gguf
import numpy as np
import numpy.typing as npt

WIDTH = 32
HEADS = 2
FEED_FORWARD = 64
CONTEXT = 8192
"""Longest text, in tokens: here in characters, because each is a token."""
SPREAD = 0.5
"""Standard deviation of the weights: so large that one token follows clearly from others."""
BEGIN, END, UNKNOWN = 1, 2, 0
TEMPLATE = (
    "{% for message in messages %}{{ message['role'] }}: {{ message['content'] }}\n{% endfor %}"
    "assistant: "
)


def vocabulary() -> tuple[list[str], list[int]]:
    """Return the tokens, and the kind of each: three special ones, bytes, and single characters."""
    kinds = gguf.TokenType
    special = [("<unk>", kinds.UNKNOWN), ("<s>", kinds.CONTROL), ("</s>", kinds.CONTROL)]
    octets = [(f"<0x{octet:02X}>", kinds.BYTE) for octet in range(256)]
    letters = [(chr(code), kinds.NORMAL) for code in range(ord("!"), ord("~") + 1)]
    spoken = [("\u2581", kinds.NORMAL), *letters]
    tokens = [*special, *octets, *spoken]
    return [text for text, _ in tokens], [int(kind) for _, kind in tokens]


def write(path: Path, seed: int = 0) -> None:
    """Write the model to a file."""
    tokens, kinds = vocabulary()
    writer = gguf.GGUFWriter(path, "llama")
    writer.add_name("tiny random model")
    writer.add_context_length(CONTEXT)
    writer.add_embedding_length(WIDTH)
    writer.add_block_count(1)
    writer.add_feed_forward_length(FEED_FORWARD)
    writer.add_head_count(HEADS)
    writer.add_head_count_kv(HEADS)
    writer.add_rope_dimension_count(WIDTH // HEADS)
    writer.add_layer_norm_rms_eps(1e-5)
    writer.add_vocab_size(len(tokens))
    writer.add_file_type(gguf.LlamaFileType.ALL_F32)
    writer.add_tokenizer_model("llama")
    writer.add_token_list(tokens)
    writer.add_token_scores([-float(number) for number in range(len(tokens))])
    writer.add_token_types(kinds)
    writer.add_bos_token_id(BEGIN)
    writer.add_eos_token_id(END)
    writer.add_unk_token_id(UNKNOWN)
    writer.add_chat_template(TEMPLATE)
    for name, weights in tensors(len(tokens), seed):
        writer.add_tensor(name, weights)
    writer.write_header_to_file()
    writer.write_kv_data_to_file()
    writer.write_tensors_to_file()
    writer.close()


def tensors(vocabulary_size: int, seed: int) -> list[tuple[str, npt.NDArray[np.float32]]]:
    """Return the weights of the model, by llama.cpp's names."""
    random = np.random.default_rng(seed)
    shapes = {
        "token_embd": (vocabulary_size, WIDTH),
        "blk.0.attn_q": (WIDTH, WIDTH),
        "blk.0.attn_k": (WIDTH, WIDTH),
        "blk.0.attn_v": (WIDTH, WIDTH),
        "blk.0.attn_output": (WIDTH, WIDTH),
        "blk.0.ffn_gate": (FEED_FORWARD, WIDTH),
        "blk.0.ffn_up": (FEED_FORWARD, WIDTH),
        "blk.0.ffn_down": (WIDTH, FEED_FORWARD),
        "output": (vocabulary_size, WIDTH),
    }
    weights = {
        name: random.normal(0.0, SPREAD, shape).astype(np.float32) for name, shape in shapes.items()
    }
    norms = ("blk.0.attn_norm", "blk.0.ffn_norm", "output_norm")
    weights |= {name: np.ones(WIDTH, np.float32) for name in norms}
    return [(f"{name}.weight", each) for name, each in weights.items()]


def main() -> None:
    """Write the model."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    out = parser.parse_args().out
    write(out)
    print(f"{out.stat().st_size:9d} {out}", file=sys.stderr)


if __name__ == "__main__":
    main()
