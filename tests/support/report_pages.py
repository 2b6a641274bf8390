"""Pages of reports, as tests read them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any


def shown(page: Path) -> dict[str, Any]:
    """Return what the page of a run was given to show."""
    (script,) = re.findall(
        r'<script type="application/json" id="run">(.*?)</script>', page.read_text(), re.DOTALL
    )
    data: dict[str, Any] = json.loads(script)
    return data
