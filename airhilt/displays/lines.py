"""Calls, advisories and events of a run, as lines of a log."""

from __future__ import annotations

from typing import NamedTuple

from airhilt.messages import (
    Advisory,
    ConflictTruth,
    EquipmentAlert,
    Event,
    Message,
    Severity,
    SpokenTruth,
    Transcript,
)


class Line(NamedTuple):
    """One line: when, how urgent, by whom, and what."""

    t_ns: int
    severity: Severity
    source: str
    text: str


def line_of(message: Message) -> Line | None:
    """Return the line that a message is, None if it is none."""
    match message:
        case Advisory():
            return _told("assistant", message)
        case EquipmentAlert():
            return _told(message.equipment, message.advisory)
        case Transcript() if message.text:
            said = f"{message.speaker or 'unknown'}: {message.text}"
            return Line(message.t_ns, Severity.INFO, megahertz(message.frequency_khz), said)
        case SpokenTruth():
            source = f"{megahertz(message.frequency_khz)}, as spoken"
            said = f"{message.speaker}: {message.text}"
            return Line(message.t_tx_ns, Severity.INFO, source, said)
        case ConflictTruth():
            said = f"{message.phase.replace('_', ' ')}: {', '.join(message.actors)}"
            return Line(message.t_ns, Severity.CAUTION, "conflict", said)
        case Event():
            said = f"{message.subject}: {message.text}"
            return Line(message.t_ns, Severity.INFO, message.kind.replace("_", " "), said)
    return None


def megahertz(frequency_khz: int) -> str:
    """Return a frequency as people write it."""
    return f"{frequency_khz / 1000:.3f} MHz"


def _told(source: str, advisory: Advisory) -> Line:
    text = advisory.message if advisory.active else f"over: {advisory.message}"
    severity = advisory.severity if advisory.active else Severity.INFO
    return Line(advisory.t_ns, severity, f"{source} to {advisory.recipient}", text)
