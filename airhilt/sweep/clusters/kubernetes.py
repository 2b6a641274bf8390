"""Workers as pods of Kubernetes, by the operator of dask-kubernetes.

The resource is a ``DaskCluster`` (kubernetes.dask.org/v1), as dask-kubernetes documents it under
"Custom Resources". The operator makes pods of it, one for the scheduler and one a worker, and gives
them ``DASK_WORKER_NAME`` and the address of the scheduler.
"""

from __future__ import annotations

import math
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from distributed import Client
from pydantic import Field

from airhilt.configuration import Configuration, Seconds
from airhilt.engines import Engine, Package
from airhilt.errors import first_line
from airhilt.sweep.clusters import Cluster, ClusterError

PACKAGE = Package("dask-kubernetes", extra="kubernetes")
SCHEDULER_PORT, PAGES_PORT = 8786, 8787
"""Ports of the scheduler in its pod: Dask's connections, and its pages with ``/health``."""
COMPONENT, CLUSTER_NAME = "dask.org/component", "dask.org/cluster-name"
"""Labels that the operator gives to pods."""


class KubernetesConfiguration(Configuration):
    """Configuration of ``--scheduler kubernetes``."""

    image: str = Field("", description="container image with AIRHILT, for scheduler and workers")
    namespace: str | None = Field(
        None, description="namespace of the pods; none: that of the current context"
    )
    cores: int = Field(
        1, ge=1, le=4096, description="cores of one pod; it does as many runs at a time"
    )
    memory_per_core_gb: float = Field(
        2.0,
        gt=0.0,
        le=1000.0,
        description="memory of a pod for each of its cores, in GB (10^9 bytes); a run takes 0.6, "
        "with cameras 1.5",
    )
    scheduler_memory_gb: float = Field(
        2.0, gt=0.0, le=1000.0, description="memory of the scheduler's pod, in GB (10^9 bytes)"
    )
    environment: dict[str, str] = Field({}, description="variables of the environment in all pods")
    start_timeout_s: Seconds = Field(
        300.0, description="time that the scheduler's pod has to start, in s"
    )


class KubernetesPods:
    """Scheduler and workers in pods.

    Raises
    ------
    ClusterError
        The package dask-kubernetes is missing, or no image is configured.
    """

    def __init__(self, configuration: KubernetesConfiguration) -> None:
        if not configuration.image:
            raise ClusterError(
                "scheduler kubernetes: no image; expected a container image with AIRHILT in "
                '--scheduler-config FILE, such as {"image": "registry/airhilt:1"}'
            )
        try:
            import kr8s
            from dask_kubernetes.operator import KubeCluster
        except ImportError as error:
            raise ClusterError(
                f"scheduler kubernetes: the package {PACKAGE.name} is missing or does not load "
                f"({first_line(error)}); install it with `{PACKAGE.remedy()}`"
            ) from None
        self._api: Any = kr8s.api
        self._cluster: Any = KubeCluster
        self._configuration = configuration

    def concurrency(self, workers: int) -> int:
        """Return the number of workers: each has a core of its own."""
        return workers

    @contextmanager
    def connect(self, workers: int, dashboard: str | None) -> Iterator[Client]:  # noqa: ARG002
        """Create the resource, and connect by a forwarded port; it is deleted with the context."""
        name = f"airhilt-{uuid.uuid4().hex[:8]}"
        try:
            self._api(namespace=self._configuration.namespace).version()  # It answers us.
            cluster = self._cluster(
                custom_cluster_spec=manifest(self._configuration, name, workers),
                namespace=self._configuration.namespace,
                resource_timeout=math.ceil(self._configuration.start_timeout_s),
                quiet=True,
            )
        except Exception as error:  # Of any of the packages that talk to Kubernetes.
            raise ClusterError(
                f"scheduler kubernetes: cannot be started: {first_line(error)}; expected a current "
                "context (`kubectl config current-context`) whose cluster has Dask's operator"
            ) from None
        with cluster, Client(cluster) as client:
            yield client


def manifest(configuration: KubernetesConfiguration, name: str, workers: int) -> dict[str, Any]:
    """Return the ``DaskCluster`` for a number of workers, each with one thread."""
    worker = ["worker", "--name", "$(DASK_WORKER_NAME)", "--no-dashboard"]
    worker += ["--nthreads", str(configuration.cores)]
    memory_gb = configuration.memory_per_core_gb * configuration.cores
    return {
        "apiVersion": "kubernetes.dask.org/v1",
        "kind": "DaskCluster",
        "metadata": {"name": name},
        "spec": {
            "worker": {
                "replicas": math.ceil(workers / configuration.cores),
                "spec": {
                    "containers": [
                        _container(configuration, "worker", worker, configuration.cores, memory_gb)
                    ]
                },
            },
            "scheduler": {
                "spec": {"containers": [_scheduler_container(configuration)]},
                "service": {
                    "type": "ClusterIP",
                    "selector": {CLUSTER_NAME: name, COMPONENT: "scheduler"},
                    "ports": [
                        {"name": port, "protocol": "TCP", "port": number, "targetPort": port}
                        for port, number in _ports().items()
                    ],
                },
            },
        },
    }


def _scheduler_container(configuration: KubernetesConfiguration) -> dict[str, Any]:
    probe = {"httpGet": {"port": "http-dashboard", "path": "/health"}}
    arguments = ["scheduler", "--host", "0.0.0.0"]  # noqa: S104 - of the pod alone
    return {
        **_container(configuration, "scheduler", arguments, 1, configuration.scheduler_memory_gb),
        "ports": [
            {"name": port, "containerPort": number, "protocol": "TCP"}
            for port, number in _ports().items()
        ],
        "readinessProbe": {**probe, "periodSeconds": 1},
        "livenessProbe": {**probe, "initialDelaySeconds": 15, "periodSeconds": 20},
    }


def _ports() -> dict[str, int]:
    """Return the scheduler's ports by the names that the operator looks for."""
    return {"tcp-comm": SCHEDULER_PORT, "http-dashboard": PAGES_PORT}


def _container(
    configuration: KubernetesConfiguration,
    name: str,
    arguments: list[str],
    cores: int,
    memory_gb: float,
) -> dict[str, Any]:
    resources = {"cpu": str(cores), "memory": f"{memory_gb * 1000.0:.0f}M"}
    environment = configuration.environment
    return {
        "name": name,
        "image": configuration.image,
        "command": ["dask"],  # Whatever the image starts by itself.
        "args": arguments,
        "env": [{"name": key, "value": value} for key, value in environment.items()],
        "resources": {"requests": resources, "limits": resources},
    }


def _create(_argument: str, configuration: KubernetesConfiguration) -> KubernetesPods:
    return KubernetesPods(configuration)


CLUSTER = Engine[Cluster](
    name="kubernetes",
    summary="pods of Kubernetes, by dask-kubernetes",
    create=_create,
    requires=(PACKAGE,),
    configuration=KubernetesConfiguration,
)
