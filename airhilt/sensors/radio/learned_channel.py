"""A radio channel that was learned from recordings, as an ONNX file that a user supplies.

The model does to speech what radio and room did to it in its recordings (SimuGAN and its like):
input ``[1, n]``, float32, 16 kHz, mono, in [-1, 1]; output of the same shape. It replaces the
modulation of `VhfChannel`. Noise and other transmissions are added as in the VHF channel, so that a
sweep over SNR means the same with both.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from airhilt.audio.pcm import Audio
from airhilt.errors import SpeechError, first_line
from airhilt.host.onnx import first_look, open_network
from airhilt.scenario.radio_profiles import PROFILES
from airhilt.sensors.radio.channel import LEVEL_RMS, Other, VhfChannel, active, with_voice
from airhilt.sensors.radio.on_air import BackgroundNoise

EXPECTED = "one input and one output, both float32 of shape [1, n] with any n: 16 kHz, mono"
TRIAL_SAMPLES = (1_600, 2_311)
"""Numbers of samples that a model is tried with when it is loaded; the second is odd on purpose."""


class LearnedChannel(VhfChannel):
    """A VHF channel whose modulation is an ONNX model.

    Each trial of the model must end within a limit of wall time in s; by default that of
    `first_look`. A SpeechError says that the file is not a model of this kind, or never ends.
    """

    def __init__(self, path: Path, limit_s: float | None = None) -> None:
        super().__init__(PROFILES["vhf"])
        self.name = path.stem
        self._path = path
        self._session = open_network(path, f"learned channel {path}", EXPECTED)
        inputs, outputs = self._session.get_inputs(), self._session.get_outputs()
        found = [f"{port.type} {port.shape}" for port in (*inputs, *outputs)]
        if len(inputs) != 1 or len(outputs) != 1 or any("(float)" not in text for text in found):
            raise self._wrong(f"has {len(inputs)} inputs and {len(outputs)} outputs: {found}")
        self._input = inputs[0].name
        for count in TRIAL_SAMPLES:
            trial = np.sin(np.arange(count, dtype=np.float32)) * np.float32(LEVEL_RMS)
            self._made(trial, lambda inputs: first_look(self._session, inputs, limit_s))

    def transmit(
        self,
        speech: Audio,
        snr_db: float | None,
        rng: np.random.Generator,
        others: Sequence[Other] = (),
        background: BackgroundNoise = "none",  # noqa: ARG002
        wet: float | None = None,
    ) -> Audio:
        """Return the received audio of ``speech``; the model has a background of its own."""
        noise = self.parts(speech, snr_db, rng).noise
        signal = self._signal(np.asarray(speech, np.float32))
        heard = signal + noise + self.interference(signal, others, rng)
        heard = with_voice(heard, np.asarray(speech, np.float32), 1.0 if wet is None else wet)
        return np.asarray(np.clip(heard, -1.0, 1.0), np.float32)

    def _signal(self, speech: Audio) -> Audio:
        """Return speech after the model, at the usual level; silence stays silence."""
        speaks = active(speech)
        if not speaks.any():
            return np.zeros_like(speech)
        signal = self._apply(speech)
        power = float(np.mean(np.square(signal[speaks], dtype=np.float64)))
        return signal * np.float32(LEVEL_RMS / np.sqrt(power)) if power else signal

    def _apply(self, speech: Audio) -> Audio:
        return self._made(speech, lambda inputs: self._session.run(None, inputs))

    def _made(self, speech: Audio, run: Callable[[dict[str, Audio]], list[Audio]]) -> Audio:
        """Return what the model makes of speech when it is run."""
        try:
            (made,) = run({self._input: speech[np.newaxis]})
        except TimeoutError as error:
            raise self._wrong(str(error)) from None
        except Exception as error:  # onnxruntime raises classes of its own that share no base
            raise self._wrong(f"fails on {len(speech)} samples: {first_line(error)}") from None
        if made.shape != (1, len(speech)):
            raise self._wrong(f"makes {list(made.shape)} of [1, {len(speech)}]")
        if not np.isfinite(made).all():
            raise self._wrong("makes samples that are no numbers (NaN)")
        return np.asarray(made[0], np.float32)

    def _wrong(self, what: str) -> SpeechError:
        return SpeechError(f"learned channel {self._path}: the model {what}; expected {EXPECTED}")
