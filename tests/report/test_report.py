"""The report of a run, as a file."""

from __future__ import annotations

import itertools
import json
import re
import shutil
from contextlib import closing
from importlib import resources
from pathlib import Path
from typing import Any

import pytest

from airhilt.cosim.simulation import run
from airhilt.errors import AirhiltError
from airhilt.host.text import readable
from airhilt.messages import (
    ActorTruth,
    Advisory,
    Arrival,
    Event,
    Evidence,
    Message,
    RunwayTruth,
    Severity,
)
from airhilt.options import Options
from airhilt.record import Logged, LogWriter, RunFolder
from airhilt.report import write_report
from airhilt.report.tracks import ThinnedStates
from airhilt.scenario import Scenario
from airhilt.units import SECOND_NS
from report_pages import shown

HOSTILE = (
    "</script><script>alert(1)</script><!-- <img src=x onerror=alert(2)> &lt;b> \u2028 @@RUN@@"
    "\x1b[2J\u202e"
)


@pytest.fixture(scope="module")
def finished(encounter: Scenario, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that came to its end."""
    out = tmp_path_factory.mktemp("report") / "run"
    return run(encounter, Options(latency="fixed", out=out)).folder


@pytest.fixture
def folder(finished: Path, tmp_path: Path) -> Path:
    """A copy of it to damage."""
    return shutil.copytree(finished, tmp_path / "run")


def rewrite_log(folder: Path, *messages: tuple[str, Message]) -> None:
    with closing(LogWriter(folder / "log.mcap")) as log:
        for key, message in messages:
            data = message.model_dump_json().encode()
            log.write(key, "test", type(message), message.t_ns, data)


def truth(actor: str, t_s: float, **changed: Any) -> ActorTruth:
    state = dict.fromkeys(ActorTruth.model_fields, 0.0) | {
        "actor": actor,
        "category": "aircraft",
        "icao24": "a1b2c3",
        "phase": "en_route",
        "on_ground": False,
        "latitude_deg": 38.9,
        "longitude_deg": -77.0,
        "altitude_m": 10_668.0,
        "t_ns": round(t_s * SECOND_NS),
    }
    return ActorTruth.model_validate(state | changed)


def hostile_advisory() -> Advisory:
    return Advisory(
        t_ns=SECOND_NS, id="hostile-1", revision=0, recipient="ATC", recipients=(HOSTILE,),
        kind="loss_of_separation", severity=Severity.WARNING, traffic=(HOSTILE,), message=HOSTILE,
        evidence=Evidence(sources=("adsb",)), t_ready_ns=0,
    )  # fmt: skip


# --- what it shows --------------------------------------------------------------------------


def test_a_finished_run_is_shown_with_its_numbers_tracks_and_events(folder: Path) -> None:
    page = write_report(folder)
    assert page == folder / "report.html"
    data = shown(page)
    assert data["summary"] == RunFolder(folder).summary()
    assert data["notes"] == []
    assert data["pair"] == ["AAL123", "DAL456"]
    assert [track["callsign"] for track in data["tracks"]] == ["AAL123", "DAL456"]
    assert {"advisory", "conflict", "status", "finished"} <= {e["kind"] for e in data["events"]}
    assert {worker["worker"] for worker in data["sections"]["latencies"]} >= {
        "adsb",
        "asr",
        "decision",
        "tts",
    }


def test_separation_is_that_of_the_two_tracks(folder: Path) -> None:
    data = shown(write_report(folder))
    west, east = data["tracks"]
    apart = data["separations"]
    assert apart["t"] == west["t"]
    assert apart["horizontal_nm"][0] == pytest.approx(
        east["east_nm"][0] - west["east_nm"][0], abs=0.01
    )
    assert apart["vertical_ft"][-1] == pytest.approx(
        abs(east["altitude_ft"][-1] - west["altitude_ft"][-1]), abs=1.5
    )


def test_tracks_across_the_antimeridian_stay_together(folder: Path) -> None:
    rewrite_log(
        folder,
        ("truth/state/AAL123", truth("AAL123", 0.0, longitude_deg=179.95)),
        ("truth/state/DAL456", truth("DAL456", 0.0, longitude_deg=-179.95)),
    )
    data = shown(write_report(folder))
    (west,), (east,) = (track["east_nm"] for track in data["tracks"])
    assert east - west == pytest.approx(data["separations"]["horizontal_nm"][0], rel=0.01)
    assert 4.0 < east - west < 5.0


def test_without_an_annotation_the_pair_is_the_one_of_the_summarys_closest_approach(
    folder: Path,
) -> None:
    info = RunFolder(folder).info()
    info.realised["conflict"] = None
    RunFolder(folder).write_info(info)
    summary = json.loads((folder / "summary.json").read_text())
    summary["closest_approach"] = {"t_s": 5.0, "horizontal_m": 0.0, "vertical_m": 300.0}
    (folder / "summary.json").write_text(json.dumps(summary))
    near: dict[str, float] = {}
    far, above = {"latitude_deg": 39.5}, {"altitude_m": 10_968.0}
    rewrite_log(
        folder,
        *(
            (f"truth/state/{actor}", truth(actor, t_s, **place))
            for t_s in (0.0, 10.0)
            for actor, place in (("FAR", far), ("NEAR", near), ("ABOVE", above))
        ),
    )
    data = shown(write_report(folder))
    assert data["pair"] == ["NEAR", "ABOVE"]
    assert not data["pair_is_annotated"]


# --- at an airport --------------------------------------------------------------------------

THRESHOLD_01, THRESHOLD_19 = (38.8423996, -77.0367966), (38.8611984, -77.0386963)
"""Thresholds of runway 01/19 of KDCA, which is 2096 m long."""


def along_01(part: float) -> dict[str, float]:
    """Return the place at a part of the length of runway 01; negative is on final."""
    latitude, longitude = (
        here + part * (there - here) for here, there in zip(THRESHOLD_01, THRESHOLD_19, strict=True)
    )
    return {"latitude_deg": latitude, "longitude_deg": longitude}


def at_airport(folder: Path, name: str = "KDCA", **realised: Any) -> None:
    """Make the run one at an airport, of an aircraft that lands where a truck stands."""
    info = RunFolder(folder).info()
    (first, _) = info.realised["actors"]
    info.realised |= {
        "scene": {"type": "airport", "airport": name},
        "actors": [first, {"type": "vehicle", "callsign": "OPS1", "kind": "follow_me"}],
        "conflict": {"actors": ["AAL123", "OPS1"]},
        **realised,
    }
    RunFolder(folder).write_info(info)


def landing() -> list[tuple[str, Message]]:
    """Over the threshold 10 s after the begin, down 4 s later, with OPS1 on the runway from 5 s."""
    messages: list[tuple[str, Message]] = []
    for t_s in range(21):
        down = t_s >= 14
        aircraft = truth(
            "AAL123", t_s, phase="rollout" if down else "glide", on_ground=down,
            altitude_m=5.0 if down else 5.0 + 4.0 * (14 - t_s), heading_deg=355.0,
            **along_01((t_s - 10) / 30.0),
        )  # fmt: skip
        truck = truth(
            "OPS1", t_s, category="vehicle", phase="driving" if t_s < 8 else "standing",
            on_ground=True, altitude_m=5.0, heading_deg=85.0, **along_01(0.4),
        )  # fmt: skip
        messages += [("truth/state/AAL123", aircraft), ("truth/state/OPS1", truck)]
    coming = Arrival(actor="AAL123", runway="01", time_to_threshold_s=9.0)
    for t_s, occupants, arrivals in (
        (0, (), (coming,)),
        (5, ("OPS1",), (coming,)),
        (14, ("OPS1", "AAL123"), ()),
        (18, ("OPS1",), ()),
    ):
        changed = RunwayTruth(
            t_ns=t_s * SECOND_NS, runway="01-19", occupants=occupants, arrivals=arrivals
        )
        messages.append(("truth/runway/01-19", changed))
    return sorted(messages, key=lambda message: message[1].t_ns)


def test_the_airport_is_drawn_around_its_reference_point(folder: Path) -> None:
    at_airport(folder)
    rewrite_log(folder, *landing())
    data = shown(write_report(folder))
    airport = data["airport"]
    assert {runway["name"] for runway in airport["runways"]} == {"01/19", "04/22", "15/33"}
    assert all(airport[part] for part in ("taxiways", "holds", "buildings", "water"))
    (runway,) = (runway for runway in airport["runways"] if runway["name"] == "01/19")
    south, north = (end["threshold"] for end in runway["ends"])
    truck = next(track for track in data["tracks"] if track["callsign"] == "OPS1")
    for place, axis in ((truck["east_nm"][0], 0), (truck["north_nm"][0], 1)):
        expected = south[axis] + 0.4 * (north[axis] - south[axis])
        assert place * 1852.0 == pytest.approx(expected, abs=0.5)


def test_an_actor_says_what_it_is_and_how_large(folder: Path) -> None:
    at_airport(folder)
    rewrite_log(folder, *landing())
    aircraft, truck = shown(write_report(folder))["tracks"]
    assert (aircraft["category"], truck["category"]) == ("aircraft", "vehicle")
    assert aircraft["length_m"] > 30.0 > truck["length_m"] > 1.0
    assert aircraft["on_ground"] == [[14.0, 20.0]]
    assert set(aircraft["heading_deg"]) == {355}


def test_an_airport_that_is_gone_is_named_and_the_traffic_drawn(folder: Path) -> None:
    at_airport(folder, name="KDCX")
    rewrite_log(folder, *landing())
    data = shown(write_report(folder))
    assert data["airport"] is None
    assert any("KDCX" in note.upper() for note in data["notes"])
    assert len(data["tracks"]) == 2
    assert data["sections"]["runways"][0]["approaches"][0]["threshold"] is None


def test_runways_show_who_was_there_and_who_came_over_the_threshold_when(folder: Path) -> None:
    at_airport(folder)
    rewrite_log(folder, *landing())
    (runway,) = shown(write_report(folder))["sections"]["runways"]
    assert runway["runway"] == "01/19"
    assert runway["occupants"] == [
        {"what": "OPS1", "from": 5.0, "to": 20.0},
        {"what": "AAL123", "from": 14.0, "to": 18.0},
    ]
    (approach,) = runway["approaches"]
    assert approach["what"] == "AAL123"
    assert (approach["from"], approach["to"]) == (0.0, 14.0)
    assert approach["threshold"] == pytest.approx(10.0, abs=0.1)


def test_a_failed_call_is_told_with_what_it_was_to_say(folder: Path) -> None:
    line = {"id": "hold", "speaker": "Tower", "text": "Ops one, hold position."}
    at_airport(folder, radio={"lines": [line]})
    stopped = Event(t_ns=2, kind="failure", subject="AAL123", text="engine 0 stops")
    dropped = Event(t_ns=1, kind="failure", subject="hold", text="it is never said")
    rewrite_log(folder, ("truth/event", dropped), ("truth/event", stopped))
    call, engine = shown(write_report(folder))["events"]
    assert (call["speaker"], call["line"]) == ("Tower", "Ops one, hold position.")
    assert "line" not in engine


def test_a_command_with_a_long_route_can_still_be_put_in_words(folder: Path) -> None:
    route = [{"type": "geodetic", "lat_deg": 38.0 + n / 100, "lon_deg": -77.0} for n in range(60)]
    text = json.dumps({"action": "route", "route": route})
    event = Event(t_ns=1, kind="command", subject="AAL123", text=text)
    rewrite_log(folder, ("truth/event", event))
    (event,) = shown(write_report(folder))["events"]
    assert json.loads(event["text"]) == {"action": "route", "route": 60}


# --- runs that did not come to their end ----------------------------------------------------


def test_a_killed_run_says_what_is_missing_and_shows_the_rest(folder: Path) -> None:
    (folder / "summary.json").unlink()
    log = folder / "log.mcap"
    log.write_bytes(log.read_bytes()[: log.stat().st_size // 3])
    data = shown(write_report(folder))
    assert data["summary"] is None
    assert any("no summary.json" in note for note in data["notes"])
    assert any("breaks off" in note for note in data["notes"])
    assert len(data["tracks"]) == 2
    assert 0.0 < data["end_s"] < 30.0


def test_latencies_that_break_off_are_counted_up_to_there_and_missing_ones_named(
    folder: Path,
) -> None:
    text = (folder / "latency.jsonl").read_text()
    (folder / "latency.jsonl").write_text(text[: len(text) // 2 + 7])
    assert shown(write_report(folder))["sections"]["latencies"]
    (folder / "latency.jsonl").unlink()
    (folder / "log.mcap").unlink()
    notes = " ".join(shown(write_report(folder))["notes"])
    assert "log.mcap" in notes
    assert "latency.jsonl" in notes


def test_a_summary_of_another_version_is_left_out_and_said(folder: Path) -> None:
    (folder / "summary.json").write_text('{"seed": 0}')
    data = shown(write_report(folder))
    assert data["summary"] is None
    assert any("summary.json" in note for note in data["notes"])


@pytest.mark.parametrize(
    ("key", "data"),
    [
        ("truth/event", b'{"kind": "of another version"}'),
        ("advisory/ATC", b"[]"),
        ("status/asr", b"not JSON"),
        ("truth/runway/01-19", b'{"runway": 1}'),
        ("truth/state/AAL123", b'{"t_ns": 0, "latitude_deg": null, "phase": "\\x"}'),
        ("asr/119100", b'{"id": "one", "slots": {}}'),
    ],
)
def test_a_message_of_another_version_costs_itself_alone(
    folder: Path, key: str, data: bytes
) -> None:
    at_airport(folder)
    with closing(LogWriter(folder / "log.mcap")) as log:
        log.write(key, "test", Event, 0, data)
        for other, message in landing():
            content = message.model_dump_json().encode()
            log.write(other, "test", type(message), message.t_ns, content)
    page = shown(write_report(folder))
    (note,) = (note for note in page["notes"] if "not as this version writes it" in note)
    assert note.startswith("One message")
    assert f"{key} at 0.0 s" in note
    assert [len(track["t"]) for track in page["tracks"]] == [21, 21]
    assert len(page["sections"]["runways"]) == 1
    assert page["sections"]["radio"] == {"calls": [], "advisories": []}


def test_messages_of_another_version_are_counted(folder: Path) -> None:
    with closing(LogWriter(folder / "log.mcap")) as log:
        for t_s in range(3):
            log.write("asr/119100", "test", Event, t_s * SECOND_NS, b"{}")
    notes = shown(write_report(folder))["notes"]
    (note,) = (note for note in notes if "not as this version writes them" in note)
    assert note.startswith("3 messages of the log")
    assert "asr/119100 at 0.0 s" in note


# --- mistakes -------------------------------------------------------------------------------


def test_a_page_that_cannot_be_written_is_an_error(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(AirhiltError, match="cannot be written"):
        write_report(folder, tmp_path / "missing" / "page.html")


# --- the file -------------------------------------------------------------------------------


def test_hostile_text_stays_data(folder: Path) -> None:
    info = RunFolder(folder).info()
    info.realised["title"] = HOSTILE
    RunFolder(folder).write_info(info)
    before = write_report(folder, folder.parent / "before.html").read_text().lower()
    states = [truth("AAL123", t_s, phase=HOSTILE) for t_s in (0.0, 1.0)]
    rewrite_log(
        folder,
        *(("truth/state/AAL123", state) for state in states),
        ("advisory/ATC", hostile_advisory()),
    )
    page = write_report(folder)
    after = page.read_text().lower()
    for markup in ("<script", "</script", "<!--", "<img", "onerror=alert(2)>"):
        assert after.count(markup) == before.count(markup)
    (event,) = shown(page)["events"]
    (track,) = shown(page)["tracks"]
    assert [phase["what"] for phase in track["phases"]] == [readable(HOSTILE)]
    assert event["text"] == readable(HOSTILE)
    assert shown(page)["scenario"]["title"] == readable(HOSTILE)


def parts_of_the_page() -> str:
    """Return all templates, styles and scripts that pages are made of."""
    package = Path(str(resources.files("airhilt.report")))
    files = [file for kind in ("html", "css", "js") for file in package.rglob(f"*.{kind}")]
    assert len(files) > 20
    return "".join(file.read_text("utf-8") for file in files)


def test_nothing_in_the_page_makes_markup_of_data() -> None:
    parts = parts_of_the_page()
    for maker in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval("):
        assert maker not in parts


def test_the_page_needs_nothing_from_outside() -> None:
    parts = parts_of_the_page()
    assert "://" not in parts
    assert not re.search(r"<(img|iframe|object|embed)|\bsrc=|@import|url\((?!#|\$)", parts)
    links = re.findall(r'href="([^"]*)"', parts)
    of_figures = ("{{ figure.svg }}", "{{ figure.pdf }}")  # Files beside the page of a sweep.
    assert [link for link in links if link not in of_figures] == ["data:,"]
    assert "default-src 'none'" in parts


def test_the_same_folder_gives_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    first = write_report(folder, tmp_path / "first.html").read_bytes()
    assert write_report(folder, tmp_path / "second.html").read_bytes() == first
    assert write_report(folder).read_bytes() == first


def test_a_track_is_thinned_out_evenly_and_keeps_its_ends() -> None:
    thinned = ThinnedStates(most=50)
    for tick in range(1234):
        thinned.add(Logged("truth/state/AAL123", "run", round(tick / 5 * SECOND_NS), b""))
    times = [logged.t_ns for logged in thinned.messages()]
    assert 25 <= len(times) <= 51
    assert (times[0], times[-1]) == (0, round(1233 / 5 * SECOND_NS))
    steps = {after - before for before, after in itertools.pairwise(times[:-1])}
    assert len(steps) == 1


def test_fifty_aircraft_and_many_long_messages_stay_below_a_megabyte(folder: Path) -> None:
    at_airport(folder)
    info = RunFolder(folder).info()
    actor = info.realised["actors"][0]
    names = [f"TST{number:03d}" for number in range(50)]
    info.realised["actors"] = [actor | {"callsign": name} for name in names]
    RunFolder(folder).write_info(info)
    talk = "x" * 10_000
    states = (
        (f"truth/state/{name}", truth(name, tick / 5, latitude_deg=38.0 + tick * 1.2345e-3))
        for tick in range(500)
        for name in names
    )
    chatter = (
        ("truth/event", Event(t_ns=tick * SECOND_NS, kind="refused", subject="advisory", text=talk))
        for tick in range(500)
    )
    rewrite_log(folder, *states, *chatter)
    assert write_report(folder).stat().st_size < 1_000_000
