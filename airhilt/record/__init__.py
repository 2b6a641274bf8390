"""The run folder: what is written while a run goes on, and read afterwards."""

from airhilt.record.folder import RunFolder, RunInfo
from airhilt.record.latency import LatencyLog, Loss, read_latencies
from airhilt.record.log import Logged, LogWriter, read_log

__all__ = [
    "LatencyLog",
    "LogWriter",
    "Logged",
    "Loss",
    "RunFolder",
    "RunInfo",
    "read_latencies",
    "read_log",
]
