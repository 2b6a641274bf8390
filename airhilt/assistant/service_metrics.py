"""Measurements of a service in the format of Prometheus."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from prometheus_client import (
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    Info,
    ProcessCollector,
    generate_latest,
)

from airhilt._version import __version__

BUCKETS_S = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0)
"""Upper bounds of the buckets of times: the last are the times that a run waits for an answer."""


class ServiceMetrics:
    """Counts and times the requests of one service."""

    def __init__(self, kind: str, engine: str) -> None:
        self._registry = registry = CollectorRegistry()
        ProcessCollector(registry=registry)
        service = Info("airhilt_service", "What is served.", registry=registry)
        service.info({"kind": kind, "engine": engine, "version": __version__})
        self._answers = Counter(
            "airhilt_answers", "Answers, by HTTP status.", ["status"], registry=registry
        )
        self._engine = Histogram(
            "airhilt_engine_seconds",
            "Wall time of the engine for an answer.",
            buckets=BUCKETS_S,
            registry=registry,
        )
        self._in_progress = Gauge(
            "airhilt_requests_in_progress",
            "Requests that wait for the engine, or are with it.",
            registry=registry,
        )

    @contextmanager
    def in_progress(self) -> Iterator[None]:
        """Count a request that waits for the engine, or is with it."""
        with self._in_progress.track_inprogress():
            yield

    @contextmanager
    def engine_time(self) -> Iterator[None]:
        """Time the engine."""
        with self._engine.time():
            yield

    def answered(self, status: int) -> None:
        """Count an answer."""
        self._answers.labels(str(status)).inc()

    def text(self) -> bytes:
        """Return all measurements in the text format."""
        return generate_latest(self._registry)
