"""The reference TTS worker: advisories in, the assistant's voice out."""

from airhilt.assistant.tts.worker import TtsWorker

__all__ = ["TtsWorker"]
