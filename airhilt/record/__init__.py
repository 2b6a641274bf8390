"""The run folder: what is written while a run goes on, and read afterwards."""

from airhilt.record.folder import RunFolder, RunInfo
from airhilt.record.latency import LatencyLog, Loss, read_latencies
from airhilt.record.log import LogWriter
from airhilt.record.log_reader import Logged, read_log
from airhilt.record.run import Run, open_run

__all__ = [
    "LatencyLog",
    "LogWriter",
    "Logged",
    "Loss",
    "Run",
    "RunFolder",
    "RunInfo",
    "open_run",
    "read_latencies",
    "read_log",
]
