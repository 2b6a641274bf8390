"""Workers as jobs of LSF."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from airhilt.engines import Engine
from airhilt.sweep.clusters import Cluster
from airhilt.sweep.job_queue import JOBQUEUE, JobQueue, JobQueueConfiguration


class LsfConfiguration(JobQueueConfiguration):
    """Configuration of ``--scheduler lsf``."""

    project: str | None = Field(None, description="project that the jobs are charged to")
    lsf_units: Literal["kb", "mb", "gb", "tb"] | None = Field(
        None,
        description="unit of memory limits, LSF_UNIT_FOR_LIMITS of lsf.conf; none: read from there",
    )
    use_stdin: bool = Field(
        True, description="true: the job file is given as `bsub < FILE`, otherwise as `bsub FILE`"
    )


def _create(_argument: str, configuration: LsfConfiguration) -> JobQueue:
    hours_and_minutes, _, _ = configuration.walltime.rpartition(":")  # `bsub -W` takes no seconds.
    return JobQueue(
        "LSFCluster",
        configuration,
        project=configuration.project,
        lsf_units=configuration.lsf_units,
        use_stdin=configuration.use_stdin,
        walltime=hours_and_minutes,
    )


CLUSTER = Engine[Cluster](
    name="lsf",
    summary="jobs of LSF, by dask-jobqueue",
    create=_create,
    requires=(JOBQUEUE,),
    configuration=LsfConfiguration,
)
