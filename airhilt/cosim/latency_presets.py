"""Latency sources that have a name: published times of all stages of an assistant."""

from __future__ import annotations

ASR_S = 5.88
"""t_asr - t_tx of the AIRHILT paper (arXiv 2511.18718), in s: from the start of a call."""
VISION_S = 0.415
"""t_vision - t_frame of the paper, in s."""
TTS_S = 0.9
"""t_tts - t_dec of the paper, in s."""
GENERATED_TOKENS_PER_S = 298.2
"""Generation rate of GPT-OSS-20B in MXFP4 on one RTX 5090 at a context of 4,096 tokens, as
published on smeltcore.com ("gpt-oss-20b on RTX 5090")."""
PROMPT_TOKENS_PER_S = 9443.8
"""Rate at which the same model reads a prompt, from the same source."""
GENERATED_TOKENS = 100
"""Tokens that the model generates to word an advisory, its reasoning included. An assumption: a
short answer of it has 93 tokens in the issue 11815 of Ollama."""
PROMPT_TOKENS = 500
"""Tokens of the prompt. An assumption: instructions, the alert and its evidence."""
DECISION_S = round(
    PROMPT_TOKENS / PROMPT_TOKENS_PER_S + GENERATED_TOKENS / GENERATED_TOKENS_PER_S, 2
)
"""Time of a decision that publishes something, in s. The paper names its language model;
no published time of its decision was found. The rules themselves take about 1 ms, which is left
out."""

PRESETS = {
    "paper": f"fixed,asr=since_start:{ASR_S},vision=fixed:{VISION_S},"
    f"decision=on_output:{DECISION_S},tts=fixed:{TTS_S}",
}
"""Latency sources by the names that ``--latency`` takes for them."""
