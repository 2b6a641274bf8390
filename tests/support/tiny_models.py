"""Tiny models that have learned nothing, for the engines that bring none of their own."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

from paths import DATA

XTTS_SPEAKERS = ("Ana Florence", "Craig Gutsy", "Viktor Eka")
_WIDTH, _TIMBRE = 32, 16
_WEIGHT_HEADER_BYTES = 14
"""CTranslate2 has rank, two dimensions, type and size between a weight's name and its numbers."""
YOLO_NAMES = {4: "airplane", 2: "car", 5: "bus", 7: "truck", 14: "bird", 16: "dog", 17: "horse"}
"""Some of COCO's."""


def write_xtts(folder: Path, longest_text: int = 60) -> None:
    """Write what XTTS-v2's publisher gives out, tiny, though its vocoder has but one size.

    Parameters
    ----------
    longest_text
        Number of letters above which a text is refused.
    """
    import torch
    from tokenizers import Tokenizer, models
    from TTS.tts.configs.xtts_config import XttsArgs, XttsConfig
    from TTS.tts.layers.xtts.tokenizer import VoiceBpeTokenizer
    from TTS.tts.models.xtts import Xtts

    letters = {letter: i for i, letter in enumerate("abcdefghijklmnopqrstuvwxyz.,'-")}
    tokenizer = Tokenizer(models.BPE(letters, []))
    tokenizer.add_special_tokens(["[STOP]", "[UNK]", "[SPACE]", "[START]", "[en]"])
    tokenizer.save(str(folder / "vocab.json"))
    config = XttsConfig(
        model_args=XttsArgs(
            gpt_layers=1,
            gpt_n_heads=2,
            gpt_n_model_channels=_WIDTH,
            gpt_max_text_tokens=longest_text,
            gpt_max_audio_tokens=12,
            gpt_num_audio_tokens=66,
            gpt_start_audio_token=64,
            gpt_stop_audio_token=65,
            gpt_use_perceiver_resampler=True,
            decoder_input_dim=_WIDTH,
            d_vector_dim=_TIMBRE,
        )
    )
    config.save_json(str(folder / "config.json"))
    with torch.random.fork_rng():
        torch.manual_seed(1)
        model = Xtts(config)
        model.tokenizer = VoiceBpeTokenizer(folder / "vocab.json")
        model.init_models()
        model.hifigan_decoder.waveform_decoder.conv_post.weight.data *= 30  # up to full scale
        voices = {
            name: {
                "gpt_cond_latent": torch.randn(1, 32, _WIDTH),
                "speaker_embedding": torch.randn(1, _TIMBRE, 1),
            }
            for name in XTTS_SPEAKERS
        }
    torch.save({"model": model.state_dict()}, folder / "model.pth")
    torch.save(voices, folder / "speakers_xtts.pth")


def write_yolo(folder: Path) -> None:
    """Write YOLOv10 of COCO's classes, as .pt and as .onnx, and one of other classes.

    Its layers are scaled to noise, and its last one finds airplanes and dogs here and there.
    """
    import torch
    from ultralytics import YOLO

    torch.manual_seed(1)
    model = YOLO("yolov10n.yaml")
    model.model.names = {index: YOLO_NAMES.get(index, f"class{index}") for index in range(80)}
    for layer in model.model.modules():
        if isinstance(layer, torch.nn.BatchNorm2d):
            layer.momentum = 1.0
    with torch.no_grad():
        model.model.train()(torch.rand(4, 3, 128, 128))
    model.model.eval()
    head = model.model.model[-1]
    for branch in (*head.cv3, *head.one2one_cv3):
        torch.nn.init.normal_(branch[-1].weight, std=0.01)
        branch[-1].bias.data[[4, 16]] = -2.0
    model.save(folder / "yolov10n.pt")
    YOLO(folder / "yolov10n.pt").export(format="onnx", imgsz=320, simplify=False)
    (folder / "yolov10n.onnx").rename(folder / "fixed.onnx")
    YOLO(folder / "yolov10n.pt").export(format="onnx", dynamic=True, simplify=False)
    model.model.names = {index: f"class{index}" for index in range(80)}
    model.save(folder / "others.pt")


def write_looping_whisper(folder: Path) -> None:
    """Write the tiny Whisper of the tests with shuffled weights, which says one word for ever."""
    shutil.copytree(DATA / "tiny_whisper", folder, dirs_exist_ok=True)
    path = folder / "model.bin"
    data = bytearray(path.read_bytes())
    drawn = np.random.default_rng(0)
    for layer in ("linear_0", "linear_1"):
        name = f"decoder/layer_0/ffn/{layer}/weight\0".encode()
        at = data.index(name) + len(name) + _WEIGHT_HEADER_BYTES
        weights = data[at : at + _WIDTH * _WIDTH]
        data[at : at + _WIDTH * _WIDTH] = drawn.permutation(np.frombuffer(weights, "u1")).tobytes()
    path.write_bytes(data)
