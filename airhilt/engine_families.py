"""The families of engines of a run: what each is, needs, defaults to and records.

`FAMILIES` is the only list of them. The options of a run, their checks, ``run.json``, replays,
notices of other machines, ``airhilt doctor`` and ``airhilt worker`` read it. A new family is an
`EngineFamily` here, its field in `airhilt.options.Options`, and the worker in
`airhilt.assistant.reference` that uses its engines.
"""

from __future__ import annotations

from typing import Any

from airhilt.engines import EngineFamily
from airhilt.errors import SpeechError, VisionError

NONE = "none"
"""Word that stands for no engine: nobody does what engines of the family do."""
EXTERNAL = "external"
"""Word that stands for a worker or program of the user, which decides."""

ENHANCERS = EngineFamily[Any](
    "enhancer",
    "airhilt.enhancers",
    "airhilt.assistant.enhancement.engines",
    error=SpeechError,
    product="airhilt.assistant.enhancement.engine:Enhancer",
    modality="enhancement",
    option="enhancer",
    help="What reduces noise before speech is recognised, with --topology asr_first: spectral, an "
    "enhancer of another package, or none.",
    default=NONE,
    words=(NONE,),
    needs=("speech",),
    sends="radio calls",
)
RECOGNISERS = EngineFamily[Any](
    "recogniser",
    "airhilt.asr",
    "airhilt.assistant.asr.engines",
    error=SpeechError,
    product="airhilt.assistant.asr.engine:AsrEngine",
    modality="asr",
    option="asr",
    help="What recognises speech: embedded, whisper:FOLDER_OR_NAME, or the address of a service.",
    default="embedded",
    needs=("speech", "assistant"),
    sends="radio calls",
)
VOICES = EngineFamily[Any](
    "voice",
    "airhilt.tts",
    "airhilt.voices.engines",
    error=SpeechError,
    product="airhilt.voices.engine:TtsEngine",
    modality="tts",
    option="tts",
    help="What speaks: espeak, flite, coqui:FOLDER, or the address of a service.",
    default="espeak",
    needs=("speech",),
    sends="texts to be spoken",
)
DETECTORS = EngineFamily[Any](
    "detector",
    "airhilt.detectors",
    "airhilt.assistant.vision.detectors",
    error=VisionError,
    product="airhilt.assistant.vision.detector:Detector",
    modality="vision",
    option="detector",
    help="What looks at pictures: embedded, embedded:FILE.onnx, onnx:FILE, yolo:FILE, the "
    "address of a service, or none.",
    default="embedded",
    words=(NONE,),
    needs=("cameras", "assistant"),
    sends="pictures",
)
ASSISTANTS = EngineFamily[Any](
    "assistant",
    "airhilt.assistants",
    "airhilt.assistant.decision.engines",
    product="airhilt.assistant.decision.engine:DecisionEngine",
    modality="decision",
    option="assistant",
    help="Who decides: reference, paper, another assistant that `airhilt doctor` names, the "
    "address of a service, or none.",
    default="reference",
    words=(NONE, EXTERNAL),
    sends="radio calls, tracks and detections",
)
WORDINGS = EngineFamily[Any](
    "wording",
    "airhilt.wording",
    "airhilt.assistant.wording.engines",
    product="airhilt.assistant.wording.engine:AdvisoryWording",
    modality="decision",
    option="wording",
    help="What turns an advisory into words.",
    default="template",
    needs=("assistant",),
    sends="advisories",
)
FAMILIES = (ENHANCERS, RECOGNISERS, VOICES, DETECTORS, ASSISTANTS, WORDINGS)
"""All families of engines of a run, in the order in which its data flow."""
