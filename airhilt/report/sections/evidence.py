"""The evidence of each advisory: what it rests on, and which rules found it."""

from __future__ import annotations

from typing import Any

from airhilt.host.text import readable
from airhilt.messages import Advisory
from airhilt.record import Logged, RunFolder
from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section
from airhilt.units import SECOND_NS

Json = dict[str, Any]
MOST_ROWS = 300
"""Largest number of advisories in the page, counting each revision."""
MOST_NAMES = 12
"""Largest number of names in one cell."""
TIMES = ("time_to_go_s", "time_to_loss_s", "time_to_closest_approach_s")
"""Fields of the evidence that say how urgent it is; the first one that is known is shown."""


class AdvisoryEvidence(Content):
    """The evidence of the advisories, one row for all recipients of a revision."""

    def __init__(self, folder: RunFolder) -> None:
        super().__init__(folder)
        self._rows: dict[tuple[str, int], Json] = {}
        self._left_out = 0

    def take(self, logged: Logged) -> None:
        """Receive an `Advisory`; that a conflict is over has no evidence."""
        advisory = Advisory.model_validate_json(logged.data)
        key = (advisory.id, advisory.revision)
        if not advisory.active or key in self._rows:
            return
        if len(self._rows) >= MOST_ROWS:
            self._left_out += 1
            return
        evidence = advisory.evidence
        times_s = (getattr(evidence, name) for name in TIMES)
        self._rows[key] = {
            "t": logged.t_ns / SECOND_NS,
            "severity": advisory.severity,
            "id": readable(advisory.id),
            "recipients": _names(advisory.recipients),
            "note": readable(evidence.note or advisory.message),
            "rules": _names(evidence.rules),
            "sources": _names(evidence.sources),
            "shares": {
                readable(name): share for name, share in [*evidence.shares.items()][:MOST_NAMES]
            },
            "radio": _names(evidence.radio_ids),
            "cameras": _names(evidence.camera_ids),
            "tracks": _names(evidence.tracks),
            "time_to_go_s": next((time_s for time_s in times_s if time_s is not None), None),
        }

    def as_json(self, run: RunData) -> list[Json]:
        """Return one object for each revision of an advisory."""
        advisories = run.summary.advisories if run.summary else ()
        unfounded = {readable(one.id): _names(one.unfounded) for one in advisories}
        actors = run.info.realised.get("actors", ())
        callsigns = {actor.get("icao24"): actor["callsign"] for actor in actors}
        for row in self._rows.values():
            row["unfounded"] = unfounded.get(row["id"], [])
            row["tracks"] = [callsigns.get(track, track) for track in row["tracks"]]
        if self._left_out:
            run.notes.append(
                f"The evidence shows the first {MOST_ROWS} advisories; {self._left_out} more are "
                "in the log."
            )
        return list(self._rows.values())


def _names(names: tuple[str, ...]) -> list[str]:
    more = len(names) - MOST_NAMES
    shown = [readable(name) for name in names[:MOST_NAMES]]
    return [*shown, f"and {more} more"] if more > 0 else shown


SECTION = Section(
    "evidence", order=27, module=__file__, content=AdvisoryEvidence, keys=("advisory/",)
)
