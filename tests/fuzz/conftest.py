"""More examples for those who ask for them: `pytest tests/fuzz --hypothesis-profile long`."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("long", max_examples=20_000)
