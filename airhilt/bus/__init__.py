"""The Zenoh session of a run: keys, publications, workers in other processes."""

from airhilt.bus.session import Bus, free_endpoint

__all__ = ["Bus", "free_endpoint"]
