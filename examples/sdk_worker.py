"""A decision worker in some sixty lines, with AIRHILT's SDK.

    airhilt cosim --scenario s02a_headon --endpoint tcp/127.0.0.1:7447 --attach simple
    python examples/sdk_worker.py tcp/127.0.0.1:7447

Two aircraft at the same level within 40 km of each other are a conflict. The
worker tells one crew to climb and the other to descend, and tells the controller of both. When the
two are further apart again, the conflict is over, and the crews return to their levels.
"""

import sys
from collections.abc import Iterator, Sequence
from itertools import combinations

from airhilt.geodesy.wgs84 import Place, distance_m
from airhilt.messages import (
    AdsbReport,
    Advisory,
    Climb,
    Evidence,
    InputSpec,
    Severity,
    WorkerDescription,
)
from airhilt.sim import Input, Output
from airhilt.units import DEGREE
from airhilt.workers import Step, serve


class SimpleWorker:
    description = WorkerDescription(
        name="simple", modality="decision", inputs=(InputSpec(key="adsb/*", policy="batch"),)
    )

    def __init__(self) -> None:
        self.reports: dict[str, tuple[AdsbReport, float]] = {}
        self.open: dict[str, list[Advisory]] = {}

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        for item in inputs:
            report = AdsbReport.model_validate_json(item.payload)
            if report.altitude_ft is not None:
                self.reports[report.icao24] = report, report.altitude_ft
        outputs: list[Output] = []
        for (a, a_ft), (b, b_ft) in combinations(self.reports.values(), 2):
            pair = "-".join(sorted((a.icao24, b.icao24)))
            near = distance_m(place(a), place(b)) < 40_000.0
            if near and abs(a_ft - b_ft) < 1000 and pair not in self.open:
                self.open[pair] = [*advisories(pair, (a, a_ft), (b, b_ft), t_ns)]
                outputs += [output(advisory) for advisory in self.open[pair]]
            elif not near and pair in self.open:
                over = {"active": False, "revision": 1, "t_ready_ns": t_ns}
                outputs += [output(each.model_copy(update=over)) for each in self.open.pop(pair)]
        return Step(tuple(outputs))


def advisories(
    pair: str, a: tuple[AdsbReport, float], b: tuple[AdsbReport, float], t_ns: int
) -> Iterator[Advisory]:
    """Yield an advisory for each crew, which acts on its recommendation, and for the controller."""
    (upper, upper_ft), (lower, lower_ft) = (a, b) if a[1] >= b[1] else (b, a)
    climbs, descends = upper.callsign or upper.icao24, lower.callsign or lower.icao24
    up = Climb(sense="climb", altitude_ft=upper_ft + 1000, vertical_rate_fpm=1500)
    down = Climb(sense="descend", altitude_ft=lower_ft - 1000, vertical_rate_fpm=1500)
    for recipient, recommendation in ((climbs, up), (descends, down), ("ATC", None)):
        yield Advisory(
            id=f"simple-{pair}", revision=0, recipient=recipient,
            recipients=(climbs, descends, "ATC"), kind="loss_of_separation",
            severity=Severity.CAUTION, traffic=(climbs, descends), recommendation=recommendation,
            message=f"traffic at the same level, {climbs} climb, {descends} descend",
            evidence=Evidence(sources=("adsb",)), t_ready_ns=t_ns,
        )  # fmt: skip


def place(report: AdsbReport) -> Place:
    return report.latitude_deg * DEGREE, report.longitude_deg * DEGREE


def output(advisory: Advisory) -> Output:
    return Output(f"advisory/{advisory.recipient}", advisory.model_dump_json().encode())


if __name__ == "__main__":
    serve(SimpleWorker(), connect=sys.argv[1])
