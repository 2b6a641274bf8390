"""Services on other machines to which a run sends something, because an option names them."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.assistant.decision.engines.llm import ENGINE as LLM_ENGINE
from airhilt.assistant.reference import Engines
from airhilt.host.services import is_elsewhere, is_service


def other_machines(assistant: str, engines: Engines) -> Iterator[str]:
    """Yield a sentence for each service in use that is not on this machine."""
    asked = "radio calls, tracks and advisories" if assistant == LLM_ENGINE.name else "advisories"
    addresses = {
        "radio calls": (engines.asr,),
        "texts to be spoken": (engines.tts,),
        "pictures": (engines.detector,),
        "radio calls, tracks and detections": (assistant,),
        asked: (engines.wording, engines.llm.url if engines.llm else None),
    }
    for what, urls in addresses.items():
        for url in urls:
            if url is not None and is_service(url) and is_elsewhere(url):
                yield f"this run sends {what} to another machine: {url}"
