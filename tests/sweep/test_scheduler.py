"""The scheduler of a sweep."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from distributed import LocalCluster

from airhilt.errors import AirhiltError
from airhilt.sweep import scheduler
from airhilt.sweep.scheduler import SchedulerError, connect, openness
from airhilt.sweep.work import require_scheduler


def test_an_existing_one_is_found_by_its_address_or_its_file(tmp_path: Path) -> None:
    file = tmp_path / "scheduler.json"
    with LocalCluster(n_workers=0, processes=False, protocol="tcp", host="127.0.0.1") as cluster:
        file.write_text(json.dumps({"address": cluster.scheduler_address}))
        for where in (cluster.scheduler_address, str(file)):
            require_scheduler(where)
            with connect(where) as client:
                assert client.scheduler.address == cluster.scheduler_address


@pytest.mark.parametrize("content", [None, "no JSON", "{}", '{"address": "tcp://127.0.0.1:1"}'])
def test_one_that_is_not_there_is_told(
    content: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scheduler, "TIMEOUT_S", 0.1)
    where = "tcp://127.0.0.1:1"
    if content is not None:
        where = str(tmp_path / "scheduler.json")
        Path(where).write_text(content)
    with (
        pytest.raises(SchedulerError, match=f"scheduler {where}: not there"),
        connect(where),
    ):
        pass


def test_a_word_that_is_none_is_refused_with_what_is_expected() -> None:
    with pytest.raises(AirhiltError, match=r"slurm: no such file; expected local.*recipes"):
        require_scheduler("slurm")


@pytest.mark.parametrize(
    ("where", "is_told"),
    [
        ("tcp://10.1.2.3:8786", True),
        ("tls://head:8786", False),
        ("tcp://[::1]:8786", False),
    ],
)
def test_one_that_a_whole_network_reaches_is_told(where: str, is_told: bool) -> None:
    assert ("no TLS" in openness(where)) is is_told
