"""The assistant under test: what a worker is, how it is served, and the reference workers."""

from airhilt.workers.protocol import LocalWorker, Step, Worker
from airhilt.workers.serve import serve

__all__ = ["LocalWorker", "Step", "Worker", "serve"]
