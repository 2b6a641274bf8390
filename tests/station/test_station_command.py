"""`airhilt station`: everything is chosen on its page, and its runs need it no more."""

from __future__ import annotations

import json
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import httpx
import pytest

from airhilt.record import open_run
from airhilt.scenario import Scenario
from airhilt.station.home import options_of_page
from airhilt.station.started_runs import StartedRuns
from devtools import Page
from stations import TOKEN, reachable, stationed

PATIENCE_S = 90.0
CHOOSE = """
    for (const [id, value] of [['scenario', 'own/mine.json'], ['radar', 'en_route'],
                               ['crews', 'observed']]) {
        document.getElementById(id).value = value;
        document.getElementById(id).dispatchEvent(new Event('change'));
    }
    for (const box of ['#seats [value=AAL123]', '#voice-recording', '#equipment [value=tcas]'])
        document.querySelector(box).click();
"""
NOTE_WISH = """(() => {
    const fetched = window.fetch;
    window.fetch = (path, how) => {
        if (how?.method !== 'POST') return fetched(path, how);
        window.asked = JSON.parse(how.body);
        return new Promise(() => {});
    };
})()"""
Cli = Callable[..., subprocess.CompletedProcess[str]]


def answer(client: httpx.Client, path: str, **wish: Any) -> Any:
    found = client.post(path, json=wish) if wish else client.get(path)
    return found.json()


def started(client: httpx.Client, state: str) -> Any:
    """Return the only run that was started, once it is in a state."""
    due = time.monotonic() + PATIENCE_S
    while (run := answer(client, "api/runs")["started"][0])["state"] != state:
        assert time.monotonic() < due, run
        time.sleep(0.2)
    return run


@pytest.fixture
def own_scenarios(encounter: Scenario, tmp_path: Path) -> Path:
    """A folder with a scenario of three minutes, and a link out of it."""
    folder = tmp_path / "own"
    folder.mkdir()
    long = encounter.model_copy(update={"duration_s": 180.0})
    (folder / "mine.json").write_text(long.model_dump_json())
    (tmp_path / "secret.json").write_text(encounter.model_dump_json())
    (folder / "link.json").symlink_to(tmp_path / "secret.json")
    (folder / "wrong.json").write_text("{}")
    return folder


@pytest.mark.slow
def test_a_run_goes_on_without_the_station_and_another_station_stops_it(
    own_scenarios: Path, tmp_path: Path
) -> None:
    runs = tmp_path / "runs"
    options = {"seat": ["tower"], "speech": False, "seed": 3}
    with stationed(runs, "--scenarios", str(own_scenarios)) as (process, client):
        name = answer(client, "api/runs", scenario="own/mine.json", options=options)["name"]
        started(client, "running")
        process.kill()
        process.wait(timeout=PATIENCE_S)
    with stationed(runs) as (_, client):
        run = started(client, "running")
        assert run["name"] == name
        assert run["seats"] == ["Washington Center"]
        while not [one for one in answer(client, "api/runs")["recorded"] if one["name"] == name]:
            time.sleep(0.2)
        refused = client.post("api/debriefs", json={"runs": [name]})
        assert "people at seats" in refused.json()["error"]
        with httpx.Client(trust_env=False) as other:
            assert "AIRHILT" in other.get(run["url"]).text
        client.post(f"api/runs/{name}/stop", json={})
        started(client, "ended")
    info = open_run(runs / name).info
    assert info.phase == "stopped"
    assert info.options.seed == 3


def test_what_is_not_offered_is_refused_in_words(
    own_scenarios: Path, recorded_run: Path, tmp_path: Path
) -> None:
    runs = tmp_path / "runs"
    shutil.copytree(recorded_run, runs / "one")
    with stationed(runs, "--scenarios", str(own_scenarios)) as (_, client):
        offered = {row["id"]: row for row in answer(client, "api/station")["scenarios"]}
        assert "own/mine.json" in offered
        assert "own/link.json" not in offered
        assert "problem" in offered["own/wrong.json"]

        def refused(path: str, **wish: Any) -> str:
            found = client.post(path, json=wish)
            assert found.status_code == 400
            error: str = found.json()["error"]
            return error

        assert "not offered" in refused("api/runs", scenario="../secret.json")
        assert "does not offer" in refused(
            "api/runs", scenario="s02a_headon", options={"out": "/tmp/x"}
        )
        assert "nobody of that name" in refused(
            "api/runs", scenario="s02a_headon", options={"seat": ["nobody"]}
        )
        assert "snr_db" in refused("api/runs", scenario="s02a_headon", options={"snr_db": 900})
        assert "not in" in refused("api/debriefs", runs=["../own"])
        assert "not started here" in refused("api/runs/one/stop", x=1)
        stranger = {"Origin": "http://evil.example"}
        assert client.post("api/runs", json={}, headers=stranger).status_code == 403
        assert not (runs / ".station").exists()
        assert [row["name"] for row in answer(client, "api/runs")["recorded"]] == ["one"]


@pytest.mark.slow
@pytest.mark.browser
def test_a_person_opens_a_debrief_from_the_page(
    page: Page, recorded_run: Path, tmp_path: Path
) -> None:
    runs = tmp_path / "runs"
    shutil.copytree(recorded_run, runs / "one")
    with stationed(runs) as (_, client):
        page.open(str(client.base_url), width=1280, height=720)
        page.wait_for("document.body.dataset.ready")
        assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")
        page.evaluate("document.querySelector('#recorded button').click()")
        page.wait_for("document.getElementById('traffic') && document.body.dataset.ready")
        assert "AAL123" in page.evaluate("document.getElementById('traffic').textContent")


@pytest.mark.slow
def test_runs_and_debriefs_of_a_station_admit_those_whom_it_admits(
    own_scenarios: Path, recorded_run: Path, tmp_path: Path
) -> None:
    runs = tmp_path / "runs"
    shutil.copytree(recorded_run, runs / "one")
    options = ["--scenarios", str(own_scenarios), *reachable(tmp_path)]
    with stationed(runs, *options) as (_, client):
        name = answer(client, "api/runs", scenario="own/mine.json", options={"speech": False})[
            "name"
        ]
        debrief = client.base_url.join(answer(client, "api/debriefs", runs=["one"])["url"])
        run = httpx.URL(started(client, "running")["url"]).copy_with(host="127.0.0.1")
        assert (run.scheme, run.params["token"]) == ("https", TOKEN)
        for url in (run, debrief.copy_with(query=f"token={TOKEN}".encode())):
            with httpx.Client(verify=False, trust_env=False, follow_redirects=True) as other:
                assert other.get(url.copy_with(query=None)).status_code == 403
                assert "AIRHILT" in other.get(url).text
        kept = runs / ".station" / f"{name}.txt"
        assert TOKEN in kept.read_text()
        assert kept.stat().st_mode & 0o077 == 0
        client.post(f"api/runs/{name}/stop", json={})
        started(client, "ended")


@pytest.mark.parametrize(
    "command",
    [
        ["station"],
        ["view", "a_run"],
        ["experiment", "plan.json", "--participant", "P01"],
        ["cosim", "--scenario", "s02a_headon", "--seat", "tower"],
    ],
    ids=lambda command: command[0],
)
def test_other_machines_reach_no_page_without_tls_and_a_token(
    airhilt_command: Cli, tmp_path: Path, command: list[str]
) -> None:
    plan = {"participants": ["P01"], "seat": "AAL123", "scenarios": ["s02a_headon"]}
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    done = airhilt_command(*command, "--host", "0.0.0.0", "--no-browser")
    assert done.returncode == 2
    assert "--host 0.0.0.0: other machines can reach it; expected 127.0.0.1, or TLS" in done.stderr


def test_a_page_is_told_nothing_of_the_terminal_of_a_run(tmp_path: Path) -> None:
    kept = tmp_path / ".station"
    kept.mkdir()
    run = {"name": "one", "scenario": "s", "seats": [], "process": 2**22, "created_s": 0.0}
    (kept / "one.json").write_text(json.dumps(run))
    (kept / "one.txt").write_text("60 s simulated\nthe page stays until ... or Ctrl+C\n")
    (row,) = StartedRuns(tmp_path).rows()
    assert (row["state"], row["said"]) == ("ended", "60 s simulated")


@pytest.mark.browser
def test_a_person_chooses_radar_equipment_and_that_voices_are_not_kept(
    page: Page, encounter: Scenario, tmp_path: Path
) -> None:
    """Equipment that the scenario has is ticked, and is not asked for again."""
    folder = tmp_path / "own"
    folder.mkdir()
    equipped = encounter.model_copy(update={"equipment": ("conflict_alert",)})
    (folder / "mine.json").write_text(equipped.model_dump_json())
    with stationed(tmp_path / "runs", "--scenarios", str(folder)) as (_, client):
        page.open(str(client.base_url), width=820, height=1180)
        page.wait_for("document.body.dataset.ready")
        page.evaluate(CHOOSE)
        assert page.evaluate("document.querySelector('#equipment [value=conflict_alert]').checked")
        page.evaluate(NOTE_WISH)
        page.click("start")
        page.wait_for("window.asked")
        asked = page.evaluate("window.asked")
    options = options_of_page(asked["options"])
    assert options.seat == ("AAL123",)
    assert (options.radar, options.equipment) == ("en_route", ("tcas",))
    assert options.crews == "observed"
    assert not options.voice_recording


def test_a_folder_that_is_not_there_is_named(airhilt_command: Cli) -> None:
    done = airhilt_command("station", "--scenarios", "nowhere", "--no-browser")
    assert done.returncode == 2
    assert "nowhere: no such folder" in done.stderr
