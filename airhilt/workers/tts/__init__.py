"""The reference TTS worker: advisories in, the assistant's voice out."""

from airhilt.workers.tts.worker import SPEAK_MIN_LEVEL, TtsWorker

__all__ = ["SPEAK_MIN_LEVEL", "TtsWorker"]
