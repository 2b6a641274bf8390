"""One worker as a server in virtual time."""

from __future__ import annotations

from array import array
from collections import Counter, deque
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from airhilt.errors import WorkerError
from airhilt.sim.director import Director, Priority
from airhilt.sim.latency import LatencySource
from airhilt.sim.worker import Endpoint, Input, Output, Pending, Policy, Reply, WorkerLost


class StepRecord(NamedTuple):
    """One step for the latency log; ``finished`` is false if the run ended before the step.

    A tuple, because every report and every step makes some.
    """

    worker: str
    seq: int
    t_in_ns: int
    t_start_ns: int
    latency_ns: int
    compute_s: float
    outputs: int
    wake_ns: int | None = None
    """Time at which the worker asked to be called again; None if it did not."""
    finished: bool = True
    missed: str = ""
    """Why an input has no result; empty if all have one."""


class Server:
    """Queues what reaches a worker, calls it when it is free, delivers its results late.

    An input that comes at t_in starts at max(t_in, busy until) and its results leave one latency
    later. With a latency that is known beforehand the result is only collected when it is due,
    so the simulation goes on while the worker computes.

    ``deliver`` is called with each output at the time it leaves the worker, ``done`` with the
    record of each finished step, and ``lost`` once when the worker is lost, with the cause, and
    true if that is of the machine; the worker is never called again.
    """

    def __init__(
        self,
        name: str,
        director: Director,
        endpoint: Endpoint,
        latency: LatencySource,
        *,
        deliver: Callable[[Output], None],
        done: Callable[[StepRecord], None],
        lost: Callable[[str, bool], None],
    ) -> None:
        self.name = name
        self.dropped: Counter[str] = Counter()
        self.offered: Counter[str] = Counter()
        self.latencies_ns = array("q")
        self.missed = 0
        """Number of steps in which an input has no result."""
        self.is_lost = False
        self.in_hand: StepRecord | None = None
        """Step that is not finished yet."""
        self._director = director
        self._endpoint = endpoint
        self._latency = latency
        self._deliver = deliver
        self._done = done
        self._lost = lost
        self._waiting: deque[tuple[Policy, Input]] = deque()
        self._busy = False
        self._seq = 0
        self._wake_ns: int | None = None

    def offer(self, item: Input, policy: Policy) -> None:
        """Queue an input that has reached the worker now."""
        if self.is_lost:
            return
        self.offered[item.key] += bool(item.size)
        if policy != "latest" or not self._replace_older(item):
            self._waiting.append((policy, item))
        if not self._busy:
            self._busy = True
            self._director.at(self._director.now_ns, self._start, Priority.START)

    def lose(self, cause: str, is_of_machine: bool = False) -> None:
        """Give the worker up: what waits for it is dropped, and nothing more is sent."""
        if not self.is_lost:
            self.is_lost = True
            self._waiting.clear()
            self._lost(cause, is_of_machine)

    def _replace_older(self, item: Input) -> bool:
        """Put an input in the place of the one of its key that waits, if there is one.

        It keeps the place, so that of several keys none waits for ever behind the others. An input
        without a payload, such as an exposure that was left out, replaces none that has one; and
        it does not count as dropped.
        """
        for index, (policy, older) in enumerate(self._waiting):
            if older.key == item.key:
                if item.size or not older.size:
                    self._waiting[index] = (policy, item)
                    self.dropped[item.key] += bool(older.size)
                return True
        return False

    def _take(self) -> tuple[Input, ...]:
        """Take the oldest input, and with a batched one all other batched ones."""
        if not self._waiting:
            return ()
        policy, first = self._waiting.popleft()
        if policy != "batch":
            return (first,)
        batch = [first, *(item for other, item in self._waiting if other == "batch")]
        self._waiting = deque(entry for entry in self._waiting if entry[0] != "batch")
        return tuple(batch)

    def _start(self) -> None:
        if self.is_lost:
            return
        inputs = self._take()
        now_ns, seq = self._director.now_ns, self._seq
        self._seq += 1
        self._wake_ns = None
        pending = self._endpoint.dispatch(seq, now_ns, inputs)
        begun_ns = inputs[0].begun_ns if inputs else None
        lasted_ns = None if begun_ns is None else now_ns - begun_ns
        known_ns = self._latency.known_ns(seq, lasted_ns)
        t_in_ns = inputs[0].t_in_ns if inputs else now_ns
        self.in_hand = step = StepRecord(
            self.name, seq, t_in_ns, now_ns, known_ns or 0, 0.0, 0, finished=False
        )
        if known_ns is None:
            due_ns, priority = now_ns, Priority.SETTLE
        else:
            due_ns, priority = now_ns + known_ns, Priority.RESULT
        collect = partial(self._collect, pending, step, is_known=known_ns is not None)
        self._director.at(due_ns, collect, priority)

    def _collect(self, pending: Pending, step: StepRecord, *, is_known: bool) -> None:
        """Wait for the result of a step, which may be what tells its latency."""
        if self.is_lost:
            return
        try:
            reply = pending.result()
        except WorkerLost as lost:
            self.lose(str(lost), lost.is_of_machine)
            return
        if is_known:
            self._finish(reply, step)
            return
        latency_ns = self._latency.settled_ns(reply.compute_s, len(reply.outputs))
        self.in_hand = settled = step._replace(latency_ns=latency_ns)
        due_ns = step.t_start_ns + latency_ns
        self._director.at(due_ns, partial(self._finish, reply, settled), Priority.RESULT)

    def _finish(self, reply: Reply, step: StepRecord) -> None:
        if self.is_lost:
            return
        now_ns = self._director.now_ns
        done = step._replace(
            compute_s=reply.compute_s,
            outputs=len(reply.outputs),
            wake_ns=reply.wake_ns,
            finished=True,
            missed=reply.missed,
        )
        self.missed += bool(reply.missed)
        self.latencies_ns.append(done.latency_ns)
        self._done(done)
        self.in_hand = None
        for output in reply.outputs:
            self._send(output, step.t_start_ns)
        if self._waiting:
            self._director.at(now_ns, self._start, Priority.START)
            return
        self._busy = False
        if reply.wake_ns is not None:
            self._set_alarm(reply.wake_ns, step.t_start_ns)

    def _set_alarm(self, wake_ns: int, start_ns: int) -> None:
        if wake_ns <= start_ns:
            raise WorkerError(
                f"worker {self.name!r} asked to be woken at {wake_ns} ns in a step that began at "
                f"{start_ns} ns; expected a later time or null"
            )
        self._wake_ns = max(wake_ns, self._director.now_ns)
        self._director.at(self._wake_ns, self._wake_up, Priority.START)

    def _send(self, output: Output, start_ns: int) -> None:
        if output.t_out_ns is None or start_ns <= output.t_out_ns <= self._director.now_ns:
            self._deliver(output)
        elif output.t_out_ns < start_ns:
            raise WorkerError(
                f"worker {self.name!r} sent {output.key!r} with t_out_ns {output.t_out_ns}, before "
                f"its step began at {start_ns} ns; expected a time from then on, or null"
            )
        else:
            self._director.at(output.t_out_ns, lambda: self._send_held(output), Priority.RESULT)

    def _send_held(self, output: Output) -> None:
        """Send an output that was held back until its own time."""
        if not self.is_lost:
            self._deliver(output)

    def _wake_up(self) -> None:
        if not self._busy and not self.is_lost and self._wake_ns == self._director.now_ns:
            self._busy = True
            self._start()
