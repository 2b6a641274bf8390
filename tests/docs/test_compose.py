"""The compose file starts services, and a run that asks them."""

from __future__ import annotations

from typing import Any

import yaml

from airhilt.assistant.service_kinds import KINDS, PATHS
from airhilt.cli.commands import cosim, serve
from paths import EXAMPLES

SPECIFIED = {
    "image", "build", "command", "network_mode", "healthcheck", "volumes", "depends_on",
}  # fmt: skip
"""Attributes of a service in the Compose Specification that the file uses."""
OPTIONS = {"asr": "asr", "tts": "tts", "vision": "detector", "decision": "assistant"}


def test_the_run_asks_each_service_where_it_listens_once_it_is_healthy() -> None:
    document = yaml.safe_load((EXAMPLES / "compose.yaml").read_text())
    services: dict[str, Any] = document["services"]
    assert set(services) == {*KINDS, "run"}
    assert all(set(each) <= SPECIFIED for each in services.values())
    assert (EXAMPLES / services["run"]["build"] / "Dockerfile").is_file()
    shared = {name: each.get("network_mode") for name, each in services.items()}
    assert shared == dict.fromkeys(services, "service:asr") | {"asr": None}
    name, *arguments = services["run"]["command"]
    asked = cosim.COMMAND.make_context(name, arguments).params
    for kind in KINDS:
        name, *arguments = services[kind]["command"]
        given = serve.COMMAND.make_context(name, arguments).params
        at = f"http://127.0.0.1:{given['port']}"
        assert given["kind"] == kind
        assert asked[OPTIONS[kind]] == f"{at}{PATHS[kind]}"
        assert f"{at}/health" in services[kind]["healthcheck"]["test"][-1]
        assert services["run"]["depends_on"][kind] == {"condition": "service_healthy"}
