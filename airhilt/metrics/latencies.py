"""The latency of each stage, as the paper defines them."""

from __future__ import annotations

from array import array

from airhilt.messages import (
    AdsbReport,
    AdvisoryAudio,
    Detections,
    EnhancedTransmission,
    Message,
    Transcript,
)
from airhilt.metrics.calls import TEXT
from airhilt.metrics.summary import LatencyStatistics
from airhilt.sim import StepRecord
from airhilt.units import SECOND_NS

STAGES = ("adsb", "asr", "asr_after_end", "vision", "decision", "tts")
"""Stages that every summary has, measured or not."""


class StageLatencies:
    """The samples of each stage, and of each worker's steps."""

    def __init__(self) -> None:
        # Arrays take eight bytes a sample, where lists need 32.
        self._samples_s = {stage: array("d") for stage in STAGES}

    def take(self, message: Message) -> None:
        """Add the latencies that a message tells; those of advisories come by `add`."""
        match message:
            case AdsbReport(t_adsb_in_ns=begin, t_adsb_out_ns=end):
                self.add("adsb", begin, end)
            case AdvisoryAudio(t_dec_ns=begin, t_ns=end):
                self.add("tts", begin, end)
            case EnhancedTransmission(t_end_ns=said, t_ns=end):
                self.add("enhancement", said, end)
            case Detections(t_frame_ns=begin, t_ns=end, missed=""):
                self.add("vision", begin, end)
            case Transcript(t_tx_ns=begin, t_end_ns=said, t_ns=end) if message.engine != TEXT:
                self.add("asr", begin, end)
                self.add("asr_after_end", said, end)

    def add(self, stage: str, begin_ns: int, end_ns: int) -> None:
        """Add one sample."""
        samples_s = self._samples_s.setdefault(stage, array("d"))
        samples_s.append((end_ns - begin_ns) / SECOND_NS)

    def step(self, record: StepRecord) -> None:
        """Add a finished step of a worker, waiting included."""
        end_ns = record.t_start_ns + record.latency_ns
        self.add(f"{record.worker}_step", record.t_in_ns, end_ns)

    def statistics(self) -> dict[str, LatencyStatistics]:
        """Return the statistics of each stage."""
        return {stage: LatencyStatistics.of(own) for stage, own in self._samples_s.items()}
