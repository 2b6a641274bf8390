"""Reduces a run folder to the one JSON object that the page shows."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from airhilt.record import RunFolder, RunInfo, read_latencies, read_log
from airhilt.surveillance.kinematics import curvature_radii_m
from airhilt.units import DEGREE, FOOT, NAUTICAL_MILE, SECOND_NS

Json = dict[str, Any]

POINTS_A_TRACK = 600
POINTS_A_WORKER = 800
MAXIMUM_EVENTS = 3000


@dataclass
class _Track:
    """True states of one actor, as logged."""

    t_s: list[float] = field(default_factory=list)
    latitude_deg: list[float] = field(default_factory=list)
    longitude_deg: list[float] = field(default_factory=list)
    altitude_ft: list[float] = field(default_factory=list)


@dataclass
class _Log:
    """What the log says, sorted out."""

    tracks: dict[str, _Track] = field(default_factory=dict)
    events: list[Json] = field(default_factory=list)
    phases: list[Json] = field(default_factory=list)
    end_s: float = 0.0


def gather(folder: RunFolder) -> Json:
    """Return everything that the page shows.

    Raises
    ------
    RunFolderError
        ``run.json`` or ``log.mcap`` cannot be read.
    """
    info = folder.info()
    log = _read(folder)
    summary = folder.summary()
    return {
        "meta": _meta(info),
        "summary": summary,
        "separation": _separation(info),
        "pair": _pair(info, log),
        "end_s": log.end_s,
        "actors": _actors(info, log),
        "events": log.events[:MAXIMUM_EVENTS],
        "events_left_out": max(len(log.events) - MAXIMUM_EVENTS, 0),
        "phases": log.phases,
        "latencies": _latencies(folder),
        "draws": info.draws,
    }


def _meta(info: RunInfo) -> Json:
    scenario = info.scenario
    measured = info.options.latency == "measured"
    return {
        "scenario": scenario.get("name", ""),
        "title": scenario.get("title", ""),
        "description": scenario.get("description", ""),
        "family": scenario.get("family", ""),
        "phase": info.phase,
        "cause": info.cause,
        "options": info.options.model_dump(),
        "reproducible": "by airhilt replay only: "
        + ("a program without grants took part" if info.unregistered_programs else "measured")
        if measured or info.unregistered_programs
        else "yes, from scenario, seed and latency source",
        "workers": [
            f"{worker.description.name} ({worker.description.modality}, {worker.where})"
            for worker in info.workers
        ],
        "versions": info.versions,
        "platform": info.platform,
        "started_at": info.started_at,
        "hashes": info.hashes,
    }


def _separation(info: RunInfo) -> Json:
    declared = info.realised.get("separation", {})
    return {
        "horizontal_nm": declared.get("horizontal_nm", 5.0),
        "vertical_ft": declared.get("vertical_ft", 1000.0),
    }


def _pair(info: RunInfo, log: _Log) -> list[str] | None:
    """Return the annotated pair, or of two actors the only one."""
    conflict = info.realised.get("conflict")
    if conflict:
        return list(conflict["actors"])
    return list(log.tracks) if len(log.tracks) == 2 else None


# --- the log ------------------------------------------------------------------------------


def _read(folder: RunFolder) -> _Log:
    log = _Log()
    for logged in read_log(folder.log_path):
        log.end_s = max(log.end_s, logged.t_ns / SECOND_NS)
        first = logged.key.split("/")[0]
        if first == "adsb":
            continue
        message = json.loads(logged.data)
        if logged.key.startswith("truth/state/"):
            _add_state(log, message)
        elif logged.key == "truth/conflict":
            _add_phase(log, message)
        else:
            event = _event(logged.key, message, logged.publisher)
            if event is not None:
                log.events.append({"t": logged.t_ns / SECOND_NS, **event})
    log.events.sort(key=lambda event: event["t"])
    return log


def _add_state(log: _Log, message: Json) -> None:
    track = log.tracks.setdefault(message["actor"], _Track())
    track.t_s.append(message["t_ns"] / SECOND_NS)
    track.latitude_deg.append(message["latitude_deg"])
    track.longitude_deg.append(message["longitude_deg"])
    track.altitude_ft.append(message["altitude_m"] / FOOT)


PHASES = {
    "opened": "conflict window opens",
    "closed": "conflict window closes",
    "loss_of_separation": "loss of separation",
    "nmac": "near mid-air collision",
    "collision": "collision",
    "tcas_ta": "TCAS II would give a traffic advisory",
    "tcas_ra": "TCAS II would give a resolution advisory",
}


def _add_phase(log: _Log, message: Json) -> None:
    t_s = message["t_ns"] / SECOND_NS
    log.phases.append({"t": t_s, "phase": message["phase"], "actors": message["actors"]})
    text = PHASES[message["phase"]]
    if message["horizontal_m"] is not None:
        text = (
            f"{text}, {message['horizontal_m'] / NAUTICAL_MILE:.2f} NM and "
            f"{message['vertical_m'] / FOOT:.0f} ft apart"
        )
    who = ", ".join(message["actors"])
    log.events.append({"t": t_s, "kind": "conflict", "who": who, "text": text})


def _event(key: str, message: Json, publisher: str) -> Json | None:
    """Return a row of the timeline, or None for what has none."""
    match key.split("/")[0]:
        case "advisory":
            advice = message["recommendation"]
            text = message["message"]
            if not message["active"]:
                text += " (over)"
            return {
                "kind": "advisory",
                "who": f"to {message['recipient']}",
                "text": text,
                "level": message["severity"],
                "advice": advice["action"] if advice else "",
                "active": message["active"],
            }
        case "status":
            cause = f": {message['cause']}" if message["cause"] else ""
            kind = "lost" if message["state"] == "lost" else "status"
            return {"kind": kind, "who": message["modality"], "text": message["state"] + cause}
        case "command":
            text = json.dumps(message["command"])
            return {"kind": "command", "who": key.split("/")[1], "text": text}
        case "asr" if message["engine"] != "text":
            text = f"{message['text']} ({message['confidence']:.2f})"
            return {"kind": "transcript", "who": publisher, "text": text}
        case "truth" if key.startswith("truth/radio/"):
            addressed = f" to {message['addressed']}" if message["addressed"] else ""
            who = f"{message['speaker']}{addressed}"
            return {"kind": "radio", "who": who, "text": message["text"]}
        case "truth" if key == "truth/event":
            return {"kind": message["kind"], "who": message["subject"], "text": message["text"]}
        case _:
            return None


# --- what is drawn ------------------------------------------------------------------------


def _actors(info: RunInfo, log: _Log) -> list[Json]:
    types = {actor["callsign"]: actor["aircraft"] for actor in info.realised.get("actors", [])}
    begins = [(track.latitude_deg[0], track.longitude_deg[0]) for track in log.tracks.values()]
    if not begins:
        return []
    latitude = sum(begin[0] for begin in begins) / len(begins)
    longitude = sum(begin[1] for begin in begins) / len(begins)
    longest = max(len(track.t_s) for track in log.tracks.values())
    stride = max(1, math.ceil(longest / POINTS_A_TRACK))
    return [
        {
            "callsign": callsign,
            "type": types.get(callsign, ""),
            "t": [round(value, 3) for value in _thin(track.t_s, stride)],
            "east_nm": _east_nm(_thin(track.longitude_deg, stride), latitude, longitude),
            "north_nm": _north_nm(_thin(track.latitude_deg, stride), latitude),
            "altitude_ft": [round(value, 1) for value in _thin(track.altitude_ft, stride)],
        }
        for callsign, track in log.tracks.items()
    ]


def _thin(values: Sequence[float], stride: int) -> list[float]:
    """Return every so-manieth value, and the last."""
    kept = list(values[::stride])
    if values and (len(values) - 1) % stride:
        kept.append(values[-1])
    return kept


def _east_nm(longitudes_deg: list[float], latitude: float, longitude: float) -> list[float]:
    radius = curvature_radii_m(latitude * DEGREE)[1] * math.cos(latitude * DEGREE)
    return [
        round(((value - longitude + 180.0) % 360.0 - 180.0) * DEGREE * radius / NAUTICAL_MILE, 4)
        for value in longitudes_deg
    ]


def _north_nm(latitudes_deg: list[float], latitude: float) -> list[float]:
    radius = curvature_radii_m(latitude * DEGREE)[0]
    return [
        round((value - latitude) * DEGREE * radius / NAUTICAL_MILE, 4) for value in latitudes_deg
    ]


def _latencies(folder: RunFolder) -> dict[str, list[float]]:
    """Return the simulated latencies of each worker's finished steps, in seconds, thinned out."""
    recorded = read_latencies(folder.latency_path)
    found = {}
    for worker, steps in recorded.latencies_ns.items():
        unfinished = recorded.unfinished.get(worker)
        values = [
            latency_ns / SECOND_NS
            for seq, latency_ns in steps.items()
            if unfinished is None or seq != unfinished.seq
        ]
        found[worker] = _thin(values, max(1, math.ceil(len(values) / POINTS_A_WORKER)))
    return {worker: values for worker, values in found.items() if values}
