"""What job queues and Kubernetes are given, as text; none of them runs here."""

from __future__ import annotations

import json
import re
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest

from airhilt.errors import AirhiltError
from airhilt.sweep.clusters import FAMILY, ClusterError
from airhilt.sweep.clusters.kubernetes import KubernetesConfiguration, manifest
from airhilt.sweep.job_queue import JobQueue
from paths import DOCS

from ...conftest import Cli


def job_file(name: str, **configuration: Any) -> list[str]:
    """Return the lines of a job file that are not empty."""
    pytest.importorskip("dask_jobqueue")
    queue = FAMILY.create(name, configuration=configuration)
    assert isinstance(queue, JobQueue)
    with queue.scheduler(None) as cluster:
        return [line for line in cluster.job_script().splitlines() if line]


def test_a_job_of_slurm_has_what_is_configured() -> None:
    *lines, worker = job_file(
        "slurm",
        queue="long",
        account="physics",
        cores=4,
        memory_per_core_gb=1.5,
        walltime="08:30:00",
        job_extra_directives=["--constraint=avx2"],
        job_script_prologue=["module load python"],
    )
    assert lines == [
        "#!/usr/bin/env bash",
        "#SBATCH -J airhilt",
        "#SBATCH -p long",
        "#SBATCH -A physics",
        "#SBATCH -n 1",
        "#SBATCH --cpus-per-task=4",
        "#SBATCH --mem=6G",
        "#SBATCH -t 08:30:00",
        "#SBATCH --constraint=avx2",
        "module load python",
    ]
    words = shlex.split(worker)
    assert words[:3] == [sys.executable, "-m", "distributed.cli.dask_worker"]
    assert words[words.index("--nthreads") + 1] == "4"
    assert "--no-dashboard" in words


def test_a_job_of_pbs_has_what_is_configured() -> None:
    lines = job_file(
        "pbs",
        queue="long",
        account="physics",
        cores=2,
        memory_per_core_gb=10.0,
        walltime="01:00:00",
    )
    assert lines[1:-1] == [
        "#PBS -N airhilt",
        "#PBS -q long",
        "#PBS -A physics",
        "#PBS -l select=1:ncpus=2:mem=19GB",
        "#PBS -l walltime=01:00:00",
    ]
    assert "#PBS -l nodes=1" in job_file("pbs", resource_spec="nodes=1")


def test_a_job_of_lsf_has_hours_and_minutes_and_its_own_unit_of_memory() -> None:
    lines = job_file(
        "lsf", queue="long", project="physics", walltime="01:30:00", lsf_units="mb", cores=2
    )
    assert lines[1:-1] == [
        "#BSUB -J airhilt",
        "#BSUB -q long",
        '#BSUB -P "physics"',
        "#BSUB -n 2",
        '#BSUB -R "span[hosts=1]"',
        "#BSUB -M 4000",
        "#BSUB -W 01:30",
    ]


def test_scheduler_and_workers_listen_where_they_are_told() -> None:
    worker = shlex.split(job_file("slurm", interface="lo", python="/opt/python")[-1])
    assert worker[0] == "/opt/python"
    assert worker[worker.index("--interface") + 1] == "lo"
    assert worker[3].startswith("tcp://127.0.0.1:")


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ({"queu": "long"}, "queu: there is nothing of that name; did you mean 'queue'?"),
        ({"walltime": "2 h"}, "walltime: string should match pattern"),
        ({"cores": 0}, "cores: input should be greater than or equal to 1, found 0"),
    ],
)
def test_a_configuration_that_is_wrong_says_what(given: dict[str, Any], problem: str) -> None:
    with pytest.raises(AirhiltError, match="configuration of 'slurm': ") as raised:
        FAMILY.create("slurm", configuration=given)
    assert problem in str(raised.value)


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        ("echo 'sbatch: error: no such partition' >&2; exit 1", "sbatch: error: no such partition"),
        ("", "FileNotFoundError: .*'sbatch'"),
    ],
)
def test_a_queue_that_does_not_take_a_job_says_why(
    program: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("dask_jobqueue")
    if program:
        (tmp_path / "sbatch").write_text(f"#!/bin/sh\n{program}\n")
        (tmp_path / "sbatch").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with (
        pytest.raises(ClusterError, match=f"the queue does not take a job: {reason}"),
        FAMILY.create("slurm").connect(2, None),
    ):
        pass


@pytest.mark.parametrize("name", ["slurm", "pbs", "lsf"])
def test_a_missing_package_is_named_with_its_remedy(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "dask_jobqueue", None)
    with pytest.raises(ClusterError, match=r"dask-jobqueue is missing.*airhilt\[cluster\]"):
        FAMILY.create(name)


def test_kubernetes_needs_an_image_and_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ClusterError, match="no image; expected a container image with AIRHILT"):
        FAMILY.create("kubernetes")
    monkeypatch.setitem(sys.modules, "dask_kubernetes", None)
    monkeypatch.setitem(sys.modules, "dask_kubernetes.operator", None)
    with pytest.raises(ClusterError, match=r"dask-kubernetes is missing.*airhilt\[kubernetes\]"):
        FAMILY.create("kubernetes", configuration={"image": "airhilt:1"})


def test_the_resource_for_kubernetes_has_what_is_configured() -> None:
    configuration = KubernetesConfiguration(
        image="registry/airhilt:1", cores=4, memory_per_core_gb=1.5, environment={"TZ": "UTC"}
    )
    document = manifest(configuration, "airhilt-1", workers=10)
    assert (document["apiVersion"], document["kind"]) == ("kubernetes.dask.org/v1", "DaskCluster")
    worker, scheduler = document["spec"]["worker"], document["spec"]["scheduler"]
    assert worker["replicas"] == 3, "ten threads in pods of four"
    assert worker["spec"]["containers"] == [
        {
            "name": "worker",
            "image": "registry/airhilt:1",
            "command": ["dask"],
            "args": [
                *("worker", "--name", "$(DASK_WORKER_NAME)", "--no-dashboard"),
                *("--nthreads", "4"),
            ],
            "env": [{"name": "TZ", "value": "UTC"}],
            "resources": {
                "requests": {"cpu": "4", "memory": "6000M"},
                "limits": {"cpu": "4", "memory": "6000M"},
            },
        }
    ]
    assert scheduler["service"]["selector"] == {
        "dask.org/cluster-name": "airhilt-1",
        "dask.org/component": "scheduler",
    }
    assert {port["name"] for port in scheduler["service"]["ports"]} == {
        *("tcp-comm", "http-dashboard")
    }
    json.dumps(document)


def test_the_resource_is_as_dask_kubernetes_makes_it() -> None:
    kubecluster = pytest.importorskip("dask_kubernetes.operator.kubecluster.kubecluster")
    theirs = kubecluster.make_cluster_spec("airhilt-1", image="airhilt:1", n_workers=2)
    ours = manifest(KubernetesConfiguration(image="airhilt:1"), "airhilt-1", workers=2)
    assert ours["spec"]["scheduler"]["service"] == theirs["spec"]["scheduler"]["service"]
    for part in ("worker", "scheduler"):
        (our,) = ours["spec"][part]["spec"]["containers"]
        (their,) = theirs["spec"][part]["spec"]["containers"]
        assert our["name"] == their["name"]
        if part == "scheduler":
            assert our["ports"] == their["ports"]
            assert our["readinessProbe"]["httpGet"] == their["readinessProbe"]["httpGet"]


def test_the_schema_of_a_configuration_is_printed(airhilt_command: Cli) -> None:
    printed = airhilt_command("schema", "--scheduler", "slurm")
    properties = json.loads(printed.stdout)["properties"]
    assert {"queue", "account", "walltime", "cores", "interface"} < properties.keys()
    assert all("description" in each for each in properties.values())
    none = airhilt_command("schema", "--scheduler", "local")
    assert none.returncode == 2
    assert (
        "scheduler 'local' has no configuration; expected one that has: kubernetes" in none.stderr
    )


def test_a_configuration_for_a_scheduler_that_has_none_is_refused(
    airhilt_command: Cli, encounter_file: Path
) -> None:
    Path("settings.json").write_text('{"queue": "long"}')
    refused = airhilt_command(
        *("sweep", "--scenario", encounter_file, "--scheduler-config", "settings.json"),
        *("--out", "sweep", "--no-speech"),
    )
    assert refused.returncode == 2
    assert "configuration of 'local': it has none" in refused.stderr


@pytest.mark.parametrize("name", ["slurm", "pbs", "lsf", "kubernetes"])
def test_the_guide_tells_every_setting(name: str) -> None:
    guide = (DOCS / "clusters.md").read_text()
    told = {*re.findall(r"`(\w+)`", guide), *re.findall(r'"(\w+)": ', guide)}
    assert FAMILY.configuration_model(name).model_fields.keys() <= told
