"""The Zenoh session of a run: keys, publications, workers in other processes."""

from airhilt.bus.multipart import pack, unpack
from airhilt.bus.remote_workers import RemoteWorker
from airhilt.bus.session import Bus, free_endpoint

__all__ = ["Bus", "RemoteWorker", "free_endpoint", "pack", "unpack"]
