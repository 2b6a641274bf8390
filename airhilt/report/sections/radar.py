"""The surveillance radars: their plots on a plan with range rings, and the actors detected."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from airhilt.geodesy.wgs84 import MEAN_RADIUS_M
from airhilt.messages import PlotKind, RadarInfo, RadarPlot
from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section
from airhilt.report.tracks import Track, Values
from airhilt.surveillance.radar import plot_place
from airhilt.units import DEGREE, NAUTICAL_MILE, SECOND_NS

Json = dict[str, Any]

MOST_PLOTS = 4_000
"""Largest number of plots of one radar in the page."""
OF_RADAR = ("site", "kind", "rotation_s", "primary_range_m", "secondary_range_m")
"""Fields of `RadarInfo` in the page."""
NEAR_M = 1_500.0
"""A plot is of an actor if it lies within this of the actor's true place, in m, ..."""
NEAR_RAD = 0.02
"""... and within this, in rad, as the radar sees it: more than five errors of any radar here."""


class Targets(NamedTuple):
    """The true places of one actor at the times of a radar's plots, as the radar sees them."""

    actor: str
    range_m: Values
    azimuth_rad: Values
    is_known: NDArray[np.bool_]

    @classmethod
    def of(
        cls, actor: str, track: Track, info: RadarInfo, run: RunData, t_ns: list[int]
    ) -> Targets:
        """Return slant ranges and azimuths at some times."""
        east_m, north_m, up_m = track.positions_m(t_ns)
        site_east_nm, site_north_nm = run.locate(_place(info), info.altitude_m)
        east_m -= site_east_nm * NAUTICAL_MILE
        north_m -= site_north_nm * NAUTICAL_MILE
        # The ground curves away below the antenna's horizontal plane.
        ground_m = np.hypot(east_m, north_m)
        below_m = ground_m**2 / (2.0 * MEAN_RADIUS_M)
        times = np.asarray(t_ns)
        return cls(
            actor,
            np.hypot(ground_m, up_m - info.altitude_m - below_m),
            np.arctan2(east_m, north_m),
            (times >= track.states[0].t_ns) & (times <= track.states[-1].t_ns + SECOND_NS),
        )

    def distances_m(self, range_m: Values, azimuth_rad: Values) -> Values:
        """Return the distance of each plot from the actor; infinity for plots of others."""
        turn = (azimuth_rad - self.azimuth_rad + math.pi) % math.tau - math.pi
        across_m = np.abs(turn) * self.range_m
        along_m = np.abs(range_m - self.range_m)
        near = (along_m < NEAR_M) & ((across_m < NEAR_M) | (np.abs(turn) < NEAR_RAD))
        found: Values = np.where(near & self.is_known, np.hypot(along_m, across_m), np.inf)
        return found


class Radar:
    """One radar and its plots."""

    def __init__(self, info: RadarInfo) -> None:
        self._info = info
        self._plots: list[RadarPlot] = []
        self._left_out = 0

    def add(self, plot: RadarPlot) -> None:
        """Add the next plot."""
        if len(self._plots) < MOST_PLOTS:
            self._plots.append(plot)
        else:
            self._left_out += 1

    def as_json(self, run: RunData) -> Json:
        """Return the radar, its plots, and how often it detected each actor."""
        info = self._info
        if self._left_out:
            run.notes.append(
                f"The plan of radar {info.site} shows the first {MOST_PLOTS} plots; "
                f"{self._left_out} later ones are in log.mcap only."
            )
        east_nm, north_nm = run.locate(_place(info), info.altitude_m)
        actors = self._actors(run)
        return {
            **{name: getattr(info, name) for name in OF_RADAR},
            "east_nm": round(east_nm, 4),
            "north_nm": round(north_nm, 4),
            "plots": [
                self._plot(plot, actor, run)
                for plot, actor in zip(self._plots, actors, strict=True)
            ],
            "detected": [self._detected(actor, actors, run) for actor in run.tracks],
        }

    def _plot(self, plot: RadarPlot, actor: str | None, run: RunData) -> Json:
        east_nm, north_nm = run.locate(*plot_place(self._info, plot))
        return {
            "t": round(plot.t_plot_ns / SECOND_NS, 2),
            "kind": plot.kind,
            "east_nm": round(east_nm, 4),
            "north_nm": round(north_nm, 4),
            "range_m": round(plot.range_m),
            "azimuth_deg": round(plot.azimuth_deg, 2),
            "mode_a": plot.mode_a,
            "mode_c_ft": plot.mode_c_ft,
            "actor": actor,
        }

    def _actors(self, run: RunData) -> list[str | None]:
        if not self._plots or not run.tracks:
            return [None] * len(self._plots)
        t_ns = [plot.t_plot_ns for plot in self._plots]
        range_m = np.array([plot.range_m for plot in self._plots])
        azimuth_rad = np.array([plot.azimuth_deg * DEGREE for plot in self._plots])
        targets = [
            Targets.of(actor, track, self._info, run, t_ns) for actor, track in run.tracks.items()
        ]
        distances_m = np.array([target.distances_m(range_m, azimuth_rad) for target in targets])
        replies = self._reply_owners(distances_m)
        return [
            targets[index].actor if index is not None else None
            for index in self._owners(distances_m, replies)
        ]

    def _reply_owners(self, distances_m: Values) -> dict[str, int]:
        """Return the actor that each Mode A code is of: that nearest to most of its plots."""
        votes: dict[str, Counter[int]] = {}
        for plot, column in zip(self._plots, distances_m.T, strict=True):
            if plot.mode_a is not None and np.isfinite(column).any():
                votes.setdefault(plot.mode_a, Counter())[int(np.argmin(column))] += 1
        return {code: counts.most_common(1)[0][0] for code, counts in votes.items()}

    def _owners(self, distances_m: Values, replies: dict[str, int]) -> Iterator[int | None]:
        """Yield the actor of each plot; an actor has at most one plot in a turn."""
        last_ns: dict[int, int] = {}
        for plot, column in zip(self._plots, distances_m.T, strict=True):
            least_ns = plot.t_plot_ns - round(self._info.rotation_s * SECOND_NS / 2.0)
            order = [index for index in np.argsort(column) if np.isfinite(column[index])]
            free = (index for index in order if last_ns.get(index, least_ns) <= least_ns)
            if plot.mode_a is not None:
                owner = replies.get(plot.mode_a)
            else:
                owner = next((index for index in free if index not in replies.values()), None)
                owner = next(iter(order), None) if owner is None else owner
            if owner is not None:
                last_ns[owner] = plot.t_plot_ns
            yield owner

    def _detected(self, actor: str, actors: list[str | None], run: RunData) -> Json:
        """Return the number of turns in the life of an actor, and those in which it was found."""
        states = run.tracks[actor].states
        lasted_s = (states[-1].t_ns - states[0].t_ns) / SECOND_NS
        kinds: list[PlotKind] = [
            plot.kind for plot, found in zip(self._plots, actors, strict=True) if found == actor
        ]
        turns = math.floor(lasted_s / self._info.rotation_s)  # or one more, by the first azimuth
        return {
            "actor": actor,
            "turns": max(turns, len(kinds)),
            **{kind: kinds.count(kind) for kind in ("primary", "secondary", "combined")},
        }


class Radars(Content):
    """The radars of a run."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._radars: dict[str, Radar] = {}

    def take(self, logged: Logged) -> None:
        """Receive a `RadarInfo` or a `RadarPlot`."""
        match logged.key.split("/"):
            case ["radar", site, "info"]:
                self._radars[site] = Radar(RadarInfo.model_validate_json(logged.data))
            case ["radar", site] if site in self._radars:
                self._radars[site].add(RadarPlot.model_validate_json(logged.data))

    def as_json(self, run: RunData) -> list[Json]:
        """Return one object for each radar."""
        return [radar.as_json(run) for radar in self._radars.values()]


def _place(info: RadarInfo) -> tuple[float, float]:
    return info.latitude_deg * DEGREE, info.longitude_deg * DEGREE


SECTION = Section("radar", order=60, module=__file__, content=Radars, keys=("radar/",))
