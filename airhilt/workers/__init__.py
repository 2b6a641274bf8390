"""Workers: their authors need what is exported here, and `airhilt.messages`."""

from airhilt.sim.worker import Input, Output
from airhilt.workers.checker import check_worker
from airhilt.workers.protocol import LocalWorker, Step, Worker
from airhilt.workers.serve import serve

__all__ = ["Input", "LocalWorker", "Output", "Step", "Worker", "check_worker", "serve"]
