"""The limits in docs/bus-keys.md are those of the messages."""

from __future__ import annotations

import re

from airhilt.messages import BUS_MESSAGES
from paths import DOCS


def test_the_page_has_the_limit_of_each_key() -> None:
    rows = re.findall(
        r"^\| `([^`]+)` \| ([\d,]+) \| (\d+) \|$", (DOCS / "bus-keys.md").read_text(), re.MULTILINE
    )
    told = {
        re.sub("<[^>]+>", "*", key): (int(size.replace(",", "")), int(rate))
        for key, size, rate in rows
    }
    assert told == {
        re.sub("{[^}]+}", "*", key): tuple(model.limit)
        for key, model in BUS_MESSAGES.items()
        if model.limit is not None
    }
