"""The Zenoh session of a run: keys, publications, workers in other processes."""

from airhilt.bus.frames import pack, unpack
from airhilt.bus.session import Bus, free_endpoint
from airhilt.bus.workers import RemoteWorker

__all__ = ["Bus", "RemoteWorker", "free_endpoint", "pack", "unpack"]
