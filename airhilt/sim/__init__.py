"""Virtual time: events, paces, and workers as servers that are as slow as they are.

This package knows nothing of aviation. The two names that matter are `Director`, the
discrete-event loop, and `Server`, one worker in virtual time.
"""

from airhilt.sim.director import Director, Priority, Scheduler
from airhilt.sim.interruption import interruptible
from airhilt.sim.latency import LatencySpec, parse_latency
from airhilt.sim.pace import Pace, Paused, RealTime, Virtual, parse_pace
from airhilt.sim.server import Server, StepRecord
from airhilt.sim.worker import Endpoint, Input, Output, Pending, Policy, Reply, StepDone, WorkerLost

__all__ = [
    "Director",
    "Endpoint",
    "Input",
    "LatencySpec",
    "Output",
    "Pace",
    "Paused",
    "Pending",
    "Policy",
    "Priority",
    "RealTime",
    "Reply",
    "Scheduler",
    "Server",
    "StepDone",
    "StepRecord",
    "Virtual",
    "WorkerLost",
    "interruptible",
    "parse_latency",
    "parse_pace",
]
