"""Workers as jobs of PBS (PBS Professional, OpenPBS)."""

from __future__ import annotations

from pydantic import Field

from airhilt.engines import Command, Engine
from airhilt.sweep.clusters import Cluster
from airhilt.sweep.job_queue import JOBQUEUE, JobQueue, JobQueueConfiguration


class PbsConfiguration(JobQueueConfiguration):
    """Configuration of ``--scheduler pbs``."""

    account: str | None = Field(None, description="account that the jobs are charged to")
    resource_spec: str | None = Field(
        None, description="resources as `qsub -l` takes them; none: made from cores and memory"
    )


def _create(_argument: str, configuration: PbsConfiguration) -> JobQueue:
    return JobQueue(
        "PBSCluster",
        configuration,
        account=configuration.account,
        resource_spec=configuration.resource_spec,
        walltime=configuration.walltime,
    )


CLUSTER = Engine[Cluster](
    name="pbs",
    summary="jobs of PBS, by dask-jobqueue",
    create=_create,
    requires=(JOBQUEUE, Command("qsub", debian="openpbs-client")),
    configuration=PbsConfiguration,
)
