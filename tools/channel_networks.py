"""The networks of `train_channel`: a generator of channel speech, and what it is trained against.

The generator gives each bin of the short-time spectrum of clean speech a gain. It is what becomes
an ONNX file. The discriminator tells recorded channel speech from generated speech by their log-mel
spectra. The frame encoder keeps the words: a generated frame must be more like the clean frame that
it was made of than like others (contrastive loss of Simu-GAN, arXiv 2203.15321).
"""

from __future__ import annotations

import math

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from airhilt.audio.pcm import SAMPLE_RATE_HZ

FRAME = 512
"""Samples of a frame: 32 ms."""
HOP = FRAME // 2
"""Samples from one frame to the next: 16 ms. Hann windows add up to 1 then."""
BINS = FRAME // 2 + 1
BANDS = 64
WIDTH = 96
"""Channels of the hidden layers."""
FILTER_DB = 40.0
"""Greatest gain and loss of a bin that does not change with time, in dB."""
DYNAMICS_DB = 6.0
"""Greatest change of that with time, in dB: what limiters and gain control do. An assumption; with
more, words get lost."""
RANGE_DB = 60.0
"""Range of the log-mel spectra, in dB: what is further below the loudest band counts as silence."""
TEMPERATURE = 0.07
"""Temperature of the contrastive loss (van den Oord et al. 2018; as in arXiv 2203.15321)."""


class Spectrum(nn.Module):
    """Short-time Fourier transform and its inverse as convolutions, which ONNX has."""

    def __init__(self) -> None:
        super().__init__()
        samples, bins = torch.arange(FRAME), torch.arange(BINS)
        angles = 2.0 * math.pi * bins[:, None] * samples[None, :] / FRAME
        window = torch.hann_window(FRAME).sqrt()  # Once before the gains, and once after.
        basis = torch.cat([torch.cos(angles), torch.sin(angles)]) * window
        weights = torch.full((BINS,), 2.0)
        weights[0] = weights[-1] = 1.0
        scale = weights.repeat(2)[:, None] / FRAME
        self.register_buffer("forwards", basis[:, None, :])
        self.register_buffer("backwards", (basis * scale)[:, None, :])

    def forward(self, audio: torch.Tensor) -> torch.Tensor:
        """Return cosine and sine parts, shape (calls, 2 x bins, frames), of (calls, samples)."""
        padded = nn.functional.pad(audio[:, None, :], (FRAME, FRAME + HOP))
        return nn.functional.conv1d(padded, self.forwards, stride=HOP)

    def inverse(self, parts: torch.Tensor, like: torch.Tensor) -> torch.Tensor:
        """Return audio, shape (calls, samples), as long as the one given."""
        audio = nn.functional.conv_transpose1d(parts, self.backwards, stride=HOP)
        return audio[:, 0, FRAME : FRAME + like.shape[1]]


def magnitudes(parts: torch.Tensor) -> torch.Tensor:
    """Return the magnitudes of a spectrum, shape (calls, bins, frames)."""
    return torch.sqrt(parts[:, :BINS] ** 2 + parts[:, BINS:] ** 2 + 1e-10)


class Generator(nn.Module):
    """Gives each bin of the spectrum of speech a gain; before training it changes nothing.

    The gain has a part that is the same at all times, a filter, and one that the spectrum decides.
    """

    def __init__(self) -> None:
        super().__init__()
        self.spectrum = Spectrum()
        self.filter = nn.Parameter(torch.zeros(BINS, 1))
        last = nn.Conv1d(WIDTH, BINS, 1)
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)
        self.layers = nn.Sequential(
            nn.Conv1d(BINS, WIDTH, 5, padding=2),
            nn.LeakyReLU(0.2),
            nn.Conv1d(WIDTH, WIDTH, 5, padding=2),
            nn.LeakyReLU(0.2),
            last,
        )

    def forward(self, audio: torch.Tensor) -> torch.Tensor:
        """Return channel speech of clean speech, both of shape (calls, samples)."""
        parts = self.spectrum(audio)
        levels = torch.log10(magnitudes(parts)) + 1.0
        dynamics_db = DYNAMICS_DB * torch.tanh(self.layers(levels))
        gains = 10.0 ** ((FILTER_DB * torch.tanh(self.filter) + dynamics_db) / 20.0)
        return self.spectrum.inverse(parts * torch.cat([gains, gains], 1), audio)


class LogMel(nn.Module):
    """Log-mel spectra below the loudest band of each call, in [-1, 0] for `RANGE_DB`."""

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("window", torch.hann_window(FRAME))
        self.register_buffer("filters", torch.from_numpy(mel_filters()))

    def forward(self, audio: torch.Tensor) -> torch.Tensor:
        """Return the spectra of calls, shape (calls, bands, frames)."""
        spectra = torch.stft(
            audio, FRAME, HOP, window=self.window, pad_mode="constant", return_complex=True
        )
        power = torch.matmul(self.filters, spectra.real**2 + spectra.imag**2)
        loudest = power.amax(dim=(1, 2), keepdim=True)
        level_db = 10.0 * torch.log10(power / loudest + 1e-12)
        return torch.clamp(level_db, min=-RANGE_DB) / RANGE_DB


def discriminator() -> nn.Sequential:
    """Return a network that judges pieces of log-mel spectra: 1 for recorded, 0 for generated."""
    return nn.Sequential(
        nn.Conv1d(BANDS, WIDTH, 5, stride=2, padding=2),
        nn.LeakyReLU(0.2),
        nn.Conv1d(WIDTH, WIDTH, 5, stride=2, padding=2),
        nn.LeakyReLU(0.2),
        nn.Conv1d(WIDTH, 1, 3, padding=1),
    )


def frame_encoder() -> nn.Sequential:
    """Return a network that makes a code of each frame of a log-mel spectrum."""
    return nn.Sequential(
        nn.Conv1d(BANDS, WIDTH, 5, padding=2), nn.LeakyReLU(0.2), nn.Conv1d(WIDTH, 32, 1)
    )


def contrastive_loss(clean: torch.Tensor, made: torch.Tensor) -> torch.Tensor:
    """Return the loss that is least if each made frame is most like its own clean frame.

    Both have the codes of some frames, shape (calls, codes, frames).
    """
    first = nn.functional.normalize(made, dim=1)
    second = nn.functional.normalize(clean, dim=1)
    alike = torch.matmul(first.transpose(1, 2), second) / TEMPERATURE
    own = torch.arange(alike.shape[1], device=alike.device).expand(alike.shape[0], -1)
    return nn.functional.cross_entropy(alike.transpose(1, 2), own)


def mel_filters() -> NDArray[np.float32]:
    """Return triangular filters from 50 Hz to half the sample rate, shape (bands, bins).

    Mel is 2595 log10(1 + f / 700 Hz) (O'Shaughnessy, Speech Communication, 1987).
    """
    low, high = (2595.0 * np.log10(1.0 + f / 700.0) for f in (50.0, SAMPLE_RATE_HZ / 2.0))
    edges = 700.0 * (10.0 ** (np.linspace(low, high, BANDS + 2) / 2595.0) - 1.0)
    hz = np.linspace(0.0, SAMPLE_RATE_HZ / 2.0, BINS)
    rising = (hz - edges[:-2, None]) / np.diff(edges)[:-1, None]
    falling = (edges[2:, None] - hz) / np.diff(edges)[1:, None]
    filters = np.clip(np.minimum(rising, falling), 0.0, None)
    return np.asarray(filters + 1e-6, np.float32)
