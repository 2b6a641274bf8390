"""Checks of the runs of a sweep, before the first of them; what is costly is done once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from airhilt.cosim.option_checks import check_options
from airhilt.cosim.requested import requested_latency, requested_radio
from airhilt.engine_families import EXTERNAL
from airhilt.errors import AirhiltError
from airhilt.options import Options
from airhilt.scenario import Scenario
from airhilt.sensors.radio.backends.selection import DEFAULT_PROFILE, select_channel
from airhilt.sweep.parameters import Parameter

REPLAY = "replay:"
"""Beginning of the latency sources that are a run, of one scenario and one seed."""


class RunChecks:
    """Says what is wrong with runs; a radio channel is loaded once however many have it."""

    def __init__(self, seeds: Sequence[int]) -> None:
        self._seeds = seeds
        self._channels: dict[str, AirhiltError | None] = {}

    def problems(self, options: Options, scenario: Scenario) -> list[str]:
        """Return all that is wrong with the runs of a scenario with some options."""
        problems = []
        for check in (
            check_options,
            _require_own_assistant,
            self._require_latency,
            self._require_channel,
        ):
            try:
                check(options, scenario)
            except AirhiltError as error:
                problems.append(str(error))
        return problems

    def _require_latency(self, options: Options, scenario: Scenario) -> None:
        is_replay = options.latency is not None and options.latency.startswith(REPLAY)
        seeds = self._seeds if is_replay else self._seeds[:1]
        for seed in seeds:
            requested_latency(options.latency, scenario, seed)

    def _require_channel(self, options: Options, scenario: Scenario) -> None:
        """Complain about a radio channel that cannot be loaded."""
        if not options.speech:
            return
        profile = requested_radio(options, scenario).profile or DEFAULT_PROFILE
        if profile not in self._channels:
            self._channels[profile] = None
            try:
                select_channel(profile)
            except AirhiltError as error:
                self._channels[profile] = error
        if problem := self._channels[profile]:
            raise problem


def require_different_places(parameters: Sequence[Parameter], document: dict[str, Any]) -> None:
    """Complain about two parameters of which one would replace the value of the other.

    Raises
    ------
    AirhiltError
        Both are one place, or one is within the other.
    """
    places = [(each.path, place) for each in parameters if (place := each.place(document))]
    for index, (path, place) in enumerate(places):
        for other, inner in places[:index]:
            shorter = min(len(place), len(inner))
            if place[:shorter] == inner[:shorter]:
                raise AirhiltError(
                    f"parameters {other} and {path}: one would replace the other in "
                    f"{document['name']!r}; expected only one of them"
                )


def _require_own_assistant(options: Options, _scenario: Scenario) -> None:
    if options.assistant == EXTERNAL:
        raise AirhiltError(
            "--assistant external: no worker or program of yours attaches to the runs of a sweep, "
            "so nobody would decide; expected an assistant that `airhilt doctor` names, one of a "
            "package of yours, or the address of a service (docs/decision.md)"
        )
