"""The head of the page: title, outcome, what is missing, and how the run was made."""

from __future__ import annotations

from typing import Any

from airhilt.report.data import RunData
from airhilt.report.sections import Content, Section


class Origin(Content):
    """The workers, versions and hashes that it takes to run the same again."""

    def as_json(self, run: RunData) -> dict[str, Any]:
        """Return names and values."""
        info = run.info
        return {
            "workers": [
                {
                    "name": worker.description.name,
                    "modality": worker.description.modality,
                    "where": worker.where,
                }
                for worker in info.workers
            ],
            "about": [
                *((f"version of {name}", version) for name, version in info.versions.items()),
                *((f"platform, {name}", value) for name, value in info.platform.items()),
                ("started at", info.started_at),
                *((f"SHA-256 of {name}", file.sha256) for name, file in info.files.items()),
            ],
        }


SECTION = Section("header", order=10, module=__file__, content=Origin)
