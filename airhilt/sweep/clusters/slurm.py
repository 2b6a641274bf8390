"""Workers as jobs of SLURM."""

from __future__ import annotations

from pydantic import Field

from airhilt.engines import Command, Engine
from airhilt.sweep.clusters import Cluster
from airhilt.sweep.job_queue import JOBQUEUE, JobQueue, JobQueueConfiguration


class SlurmConfiguration(JobQueueConfiguration):
    """Configuration of ``--scheduler slurm``."""

    account: str | None = Field(None, description="account that the jobs are charged to")


def _create(_argument: str, configuration: SlurmConfiguration) -> JobQueue:
    return JobQueue(
        "SLURMCluster",
        configuration,
        account=configuration.account,
        walltime=configuration.walltime,
    )


CLUSTER = Engine[Cluster](
    name="slurm",
    summary="jobs of SLURM, by dask-jobqueue",
    create=_create,
    requires=(JOBQUEUE, Command("sbatch", debian="slurm-client")),
    configuration=SlurmConfiguration,
)
