"""Workers that are jobs of a queue such as SLURM, by dask-jobqueue; one module a kind of queue.

The scheduler lives in the process of the sweep, and each job is one worker of Dask. A job that ends
early, by its wall time or with its machine, is replaced by a new one.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import dask
from distributed import Client, Security
from distributed.deploy.spec import ProcessInterface
from pydantic import Field

from airhilt.configuration import Configuration, Seconds
from airhilt.engines import Package
from airhilt.errors import first_line
from airhilt.sweep.clusters import ClusterError

if TYPE_CHECKING:
    from dask_jobqueue.core import JobQueueCluster

JOBQUEUE = Package("dask-jobqueue", extra="cluster")
LOOPBACK = "127.0.0.1:0"
"""Address of the scheduler's own pages if no dashboard is asked for: a free port."""
TLS = "distributed.comm.tls.ca-file"
"""Setting of Dask that names the authority of certificates; connections are encrypted if it is
there."""
Walltime = Annotated[str, Field(pattern=r"^\d{1,4}:[0-5]\d:[0-5]\d$")]


class JobQueueConfiguration(Configuration):
    """Configuration that all job queues have in common."""

    queue: str | None = Field(
        None, description="queue of the jobs (SLURM: partition); none: the queue's own default"
    )
    cores: int = Field(
        1, ge=1, le=4096, description="cores of one job; it does as many runs at a time"
    )
    memory_per_core_gb: float = Field(
        2.0,
        gt=0.0,
        le=1000.0,
        description="memory of a job for each of its cores, in GB (10^9 bytes); a run takes 0.6, "
        "with cameras 1.5",
    )
    walltime: Walltime = Field(
        "04:00:00",
        description="time after which the queue ends a job, as hours:minutes:seconds; a new job "
        "takes its place",
    )
    python: str | None = Field(
        None, description="Python with AIRHILT on the machines of the jobs; none: the path of ours"
    )
    job_script_prologue: tuple[str, ...] = Field(
        (), description="lines of shell before the worker starts, such as `module load python`"
    )
    job_extra_directives: tuple[str, ...] = Field(
        (), description="further directives of the queue, without #SBATCH, #PBS or #BSUB"
    )
    interface: str | None = Field(
        None,
        description="network interface on which scheduler and workers listen, such as ib0; none: "
        "all interfaces",
    )
    local_directory: str | None = Field(
        None, description="folder on the machines of the jobs for what workers put aside"
    )
    log_directory: str | None = Field(
        None, description="folder for the output of the jobs; none: where the queue puts it"
    )
    death_timeout_s: Seconds = Field(
        60.0, description="time that a worker looks for the scheduler before it ends, in s"
    )


class JobQueue:
    """Workers in jobs of a queue.

    Parameters
    ----------
    name
        Name of the queue's class in dask-jobqueue, such as ``SLURMCluster``.
    configuration
        Its part that all queues have in common.
    further
        Arguments of that class for this kind of queue only.

    Raises
    ------
    ClusterError
        The package dask-jobqueue is missing.
    """

    def __init__(self, name: str, configuration: JobQueueConfiguration, **further: Any) -> None:
        try:
            import dask_jobqueue
        except ImportError as error:
            raise ClusterError(
                f"scheduler: the package {JOBQUEUE.name} is missing or does not load "
                f"({first_line(error)}); install it with `{JOBQUEUE.remedy()}`"
            ) from None
        self._cluster: Any = getattr(dask_jobqueue, name)
        self._configuration = configuration
        self._further = further
        self._refusals: list[str] = []

    @contextmanager
    def connect(self, workers: int, dashboard: str | None) -> Iterator[Client]:
        """Start the scheduler, and give the queue as many jobs as it takes for the workers.

        Raises
        ------
        ClusterError
            The scheduler cannot be started, or the queue does not take a job.
        """
        jobs = math.ceil(workers / self._configuration.cores)
        with self.scheduler(dashboard) as cluster, Client(cluster) as client:
            cluster.scale(jobs=jobs)
            cluster.sync(_settled, cluster)
            if self._refusals:
                raise ClusterError(
                    f"scheduler: the queue does not take a job: {self._refusals[0]}; what a job "
                    "asks for is in --scheduler-config (docs/clusters.md)"
                )
            cluster.adapt(minimum_jobs=jobs, maximum_jobs=jobs)  # Puts new ones for those that end.
            yield client

    def concurrency(self, workers: int) -> int:
        """Return the number of workers: each has a core of its own."""
        return workers

    @contextmanager
    def scheduler(self, dashboard: str | None) -> Iterator[JobQueueCluster]:
        """Start the scheduler, without jobs.

        Raises
        ------
        ClusterError
            It cannot listen, or a setting is wrong.
        """
        try:
            cluster = self._cluster(
                **self._arguments(),
                **self._further,
                job_cls=_telling(self._cluster.job_cls, self._refusals),
                scheduler_options={"dashboard_address": dashboard or LOOPBACK},
                security=Security() if dask.config.get(TLS, None) else None,
            )
        except (OSError, RuntimeError, ValueError) as error:
            raise ClusterError(f"scheduler: cannot be started: {first_line(error)}") from None
        with cluster:
            yield cluster

    def _arguments(self) -> dict[str, Any]:
        """Return the arguments that all classes of dask-jobqueue take."""
        given = self._configuration
        return {
            "queue": given.queue,
            "cores": given.cores,
            "processes": 1,
            "memory": f"{given.memory_per_core_gb * given.cores:g} GB",
            "python": given.python,
            "job_name": "airhilt",
            "job_script_prologue": list(given.job_script_prologue),
            "job_extra_directives": list(given.job_extra_directives),
            "interface": given.interface,
            "local_directory": given.local_directory,
            "log_directory": given.log_directory,
            "death_timeout": given.death_timeout_s,
            "worker_extra_args": ["--no-dashboard"],
        }


async def _settled(cluster: JobQueueCluster) -> None:
    """Wait until the queue has taken or refused all jobs."""
    await cluster


def _telling(job: type[Any], refusals: list[str]) -> type[Any]:
    """Return a class of jobs that notes why the queue does not take one; Dask only logs it."""

    async def start(self: Any) -> None:
        try:
            await job.start(self)
        except (OSError, RuntimeError, ValueError) as error:
            _, _, printed = str(error).partition("stderr:\n")
            refusals.append(" ".join(printed.split()) or first_line(error))
            await ProcessInterface.start(self)

    return type(job.__name__, (job,), {"start": start})
