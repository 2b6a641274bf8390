"""A decision worker in about thirty lines, with AIRHILT's SDK.

    airhilt cosim --scenario s02a_headon --endpoint tcp/127.0.0.1:7447 --attach simple
    python examples/sdk_worker.py tcp/127.0.0.1:7447

It warns the controller once when two aircraft at the same level are within 0.45 degrees (about
40 km) of each other.
"""

import sys
from collections.abc import Sequence
from itertools import combinations

from airhilt.messages import AdsbReport, Advisory, Evidence, InputSpec, Severity, WorkerDescription
from airhilt.sim import Input, Output
from airhilt.workers import Step, serve


class SimpleWorker:
    description = WorkerDescription(
        name="simple", modality="decision", inputs=(InputSpec(key="adsb/*", policy="batch"),)
    )

    def __init__(self) -> None:
        self.reports: dict[str, tuple[AdsbReport, float]] = {}
        self.warned: set[str] = set()

    def step(self, t_ns: int, inputs: Sequence[Input]) -> Step:
        for item in inputs:
            report = AdsbReport.model_validate_json(item.payload)
            if report.altitude_ft is not None:
                self.reports[report.icao24] = report, report.altitude_ft
        outputs = []
        for (a, a_ft), (b, b_ft) in combinations(self.reports.values(), 2):
            pair = "-".join(sorted((a.icao24, b.icao24)))
            near = abs(a.latitude_deg - b.latitude_deg) + abs(a.longitude_deg - b.longitude_deg)
            if near < 0.45 and abs(a_ft - b_ft) < 1000 and pair not in self.warned:
                self.warned.add(pair)
                outputs.append(self.advisory(pair, a, b, t_ns))
        return Step(tuple(outputs))

    def advisory(self, pair: str, a: AdsbReport, b: AdsbReport, t_ns: int) -> Output:
        traffic = (a.callsign or a.icao24, b.callsign or b.icao24)
        advisory = Advisory(
            id=f"simple-{pair}", revision=0, recipient="ATC", recipients=("ATC",),
            kind="loss_of_separation",
            severity=Severity.CAUTION, traffic=traffic, message="traffic at the same level",
            evidence=Evidence(sources=("adsb",)), t_ready_ns=t_ns,
        )  # fmt: skip
        return Output("advisory/ATC", advisory.model_dump_json().encode())


if __name__ == "__main__":
    serve(SimpleWorker(), connect=sys.argv[1])
