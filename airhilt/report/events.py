"""The events of a run as rows of a timeline: calls, advisories, commands, conflicts, failures."""

from __future__ import annotations

import json
from typing import Any

from airhilt.host.text import readable
from airhilt.record import Logged, RunInfo
from airhilt.units import SECOND_NS

Json = dict[str, Any]

MOST_EVENTS = 1500
"""Largest number of events in the page."""
OF_ADVISORIES = ("id", "revision", "severity", "active", "traffic", "recommendation")
"""Fields of an advisory that its row has."""
OF_CONFLICTS = ("phase", "actors", "horizontal_m", "vertical_m")
"""Fields of a `ConflictTruth` that its row has."""
END = ("finished", "stopped")
"""Kinds of the event that ends a run."""


class Events:
    """The events of a run."""

    def __init__(self) -> None:
        self.rows: list[Json] = []
        """Content of the page on each event, in the order of the log."""
        self.left_out = 0
        """Number of events for which there was no room."""
        self.ended = False
        """True if the log has the end of the run."""

    def take(self, logged: Logged) -> None:
        """Add a message of the log, if it is an event."""
        row = event_row(logged)
        if row is None:
            return
        is_end = row["kind"] in END
        self.ended |= is_end
        if len(self.rows) < MOST_EVENTS or is_end:
            self.rows.append(row)
        else:
            self.left_out += 1

    def as_json(self, info: RunInfo) -> list[Json]:
        """Return the rows; a failure of a radio line has the words of the line with it."""
        lines = {
            line["id"]: {"speaker": line["speaker"], "line": readable(line["text"])}
            for line in info.realised.get("radio", {}).get("lines", ())
        }
        return [
            row | lines.get(row["who"], {}) if row["kind"] == "failure" else row
            for row in self.rows
        ]


def event_row(logged: Logged) -> Json | None:
    """Return the row of a message, or None if it is no event."""
    make = _maker(logged.key)
    row = None if make is None else make(json.loads(logged.data), logged)
    if row is None:
        return None
    short = {
        name: readable(value) if isinstance(value, str) else value for name, value in row.items()
    }
    return {"t": logged.t_ns / SECOND_NS, **short}


def _maker(key: str) -> Any:
    family, _, rest = key.partition("/")
    if family == "asr" and rest.endswith("/partial"):
        return None  # The whole transcript has the same words.
    if family == "truth":
        family = f"truth/{rest.partition('/')[0]}"
    return MAKERS.get(family)


def _advisory(message: Json, _: Logged) -> Json:
    return {
        "kind": "advisory",
        "who": message["recipient"],
        "text": message["message"],
        **{name: message[name] for name in OF_ADVISORIES},
    }


def _equipment(message: Json, logged: Logged) -> Json:
    row = _advisory(message["advisory"], logged)
    name = message["equipment"].replace("_", " ")
    over = "" if row["active"] else "over: "
    return row | {"kind": "equipment", "equipment": name, "text": f"{name}: {over}{row['text']}"}


def _exchange(message: Json, logged: Logged) -> Json | None:
    rejected = [f"{each['subject']}: {each['reason']}" for each in message["rejections"]]
    reasons = [message["failure"]] if message["failure"] else rejected
    if not reasons:
        return None
    return {"kind": "llm", "who": logged.publisher, "text": "; ".join(reasons)}


def _transcript(message: Json, logged: Logged) -> Json:
    words = {name: message[name] for name in ("text", "engine", "confidence")}
    return {"kind": "transcript", "who": logged.publisher, **words}


def _status(message: Json, _: Logged) -> Json:
    what = {"state": message["state"], "text": message["cause"]}
    return {"kind": "status", "who": message["modality"], **what}


def _command(message: Json, logged: Logged) -> Json:
    actor = logged.key.partition("/")[2]
    return {"kind": "command", "who": actor, "text": _command_text(message["command"])}


def _call(message: Json, _: Logged) -> Json:
    return {
        "kind": "radio",
        "who": message["speaker"],
        "to": message["addressed"],
        "text": message["text"],
        "frequency_khz": message["frequency_khz"],
        "t_tx": message["t_tx_ns"] / SECOND_NS,
    }


def _conflict(message: Json, _: Logged) -> Json:
    runway = message["runway"]
    return {
        "kind": "conflict",
        "who": " - ".join(message["actors"]),
        "text": "",
        **{name: message[name] for name in OF_CONFLICTS},
        "runway": None if runway is None else runway_name(runway),
    }


def runway_name(key: str) -> str:
    """Return the name of a runway, such as ``01/19``, for ``01-19`` in a key."""
    return key.replace("-", "/")


def _event(message: Json, _: Logged) -> Json:
    row = {"kind": message["kind"], "who": message["subject"], "text": message["text"]}
    if row["kind"] == "command":
        row["text"] = _command_text(json.loads(row["text"]))
    return row


def _command_text(command: Json) -> str:
    """Return a command as JSON in which a route is the number of its points."""
    points = {
        name: len(value)
        for name, value in command.items()
        if name == "route" or (name == "via" and command["action"] == "land")
    }
    return json.dumps(command | points)


MAKERS = {
    "advisory": _advisory,
    "equipment": _equipment,
    "asr": _transcript,
    "llm": _exchange,
    "status": _status,
    "command": _command,
    "truth/radio": _call,
    "truth/conflict": _conflict,
    "truth/event": _event,
}
"""The function that makes the row of a message, by the first part of the message's key."""
