"""faster-whisper for models with windows other than Whisper's 30 s. Needs the extra ``whisper``."""

from __future__ import annotations

from typing import Any

import numpy as np
from faster_whisper import WhisperModel
from numpy.typing import NDArray


class WindowedModel(WhisperModel):  # type: ignore[misc]
    """A `WhisperModel` whose windows are as long as its ``preprocessor_config.json`` says.

    faster-whisper 1.2 pads every window to the 3000 frames of Whisper's own models.
    """

    def encode(self, features: NDArray[np.float32]) -> Any:
        """Return what the encoder makes of one window."""
        return super().encode(features[..., : self.feature_extractor.nb_max_frames])
