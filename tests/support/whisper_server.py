"""OpenAI's transcriptions by faster-whisper in FastAPI: ``whisper_server.py PORT MODEL_FOLDER``.

It takes the form of OpenAI's API and nothing else, and answers its ``verbose_json``, where words
have neither blanks nor probabilities.
"""

from __future__ import annotations

import io
import json
import sys
from typing import Annotated, Any

import uvicorn
from fastapi import FastAPI, File, Form, HTTPException, Request, UploadFile
from faster_whisper import WhisperModel

FIELDS = {
    "file", "model", "language", "prompt", "response_format", "temperature",
    "timestamp_granularities[]",
}  # fmt: skip
app = FastAPI()


@app.post("/v1/audio/transcriptions")
async def transcriptions(
    request: Request,
    file: Annotated[UploadFile, File()],
    model: Annotated[str, Form()],
    language: Annotated[str | None, Form()] = None,
    prompt: Annotated[str | None, Form()] = None,
    response_format: Annotated[str, Form()] = "json",
    temperature: Annotated[float, Form(ge=0.0, le=1.0)] = 0.0,
) -> dict[str, Any]:
    """Answer a form."""
    form = await request.form()
    if unknown := set(form) - FIELDS:
        raise HTTPException(400, f"Unrecognized request argument: {', '.join(sorted(unknown))}")
    if model != "tiny":
        raise HTTPException(404, f"The model '{model}' does not exist")
    granularities = form.getlist("timestamp_granularities[]")
    if granularities and response_format != "verbose_json":
        raise HTTPException(400, "timestamp_granularities needs verbose_json")
    log({"form": {name: str(form[name]) for name in form if name != "file"},
         "headers": dict(request.headers)})  # fmt: skip
    whisper: Any = app.state.whisper
    found, info = whisper.transcribe(
        io.BytesIO(await file.read()),
        language=language,
        initial_prompt=prompt,
        temperature=temperature,
        word_timestamps="word" in granularities,
    )
    segments = list(found)
    text = "".join(each.text for each in segments).strip()
    if response_format == "json":
        return {"text": text}
    answer = {
        "task": "transcribe",
        "language": "english",
        "duration": info.duration,
        "text": text,
        "segments": [
            {
                "id": each.id,
                "seek": each.seek,
                "start": each.start,
                "end": each.end,
                "text": each.text,
                "tokens": each.tokens,
                "temperature": each.temperature,
                "avg_logprob": each.avg_logprob,
                "compression_ratio": each.compression_ratio,
                "no_speech_prob": each.no_speech_prob,
            }
            for each in segments
        ],
    }
    if "word" in granularities:
        answer["words"] = [
            {"word": word.word.strip(), "start": word.start, "end": word.end}
            for each in segments
            for word in each.words
        ]
    return answer


def log(asked: dict[str, Any]) -> None:
    """Write what was asked for the test."""
    print(json.dumps(asked), flush=True)  # noqa: T201


def loaded(folder: str) -> WhisperModel:
    """Return a model; the tests' one has a shorter window than those of OpenAI."""
    model = WhisperModel(folder, compute_type="float32")
    encode, frames = model.encode, model.feature_extractor.nb_max_frames
    model.encode = lambda features: encode(features[..., :frames])
    return model


if __name__ == "__main__":
    app.state.whisper = loaded(sys.argv[2])
    uvicorn.run(app, host="127.0.0.1", port=int(sys.argv[1]), log_level="warning")
