"""Hooks of MkDocs: pages that are made from the code, and links to files outside docs/.

pip install -e '.[docs]' && mkdocs serve
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import Files
from mkdocs.structure.pages import Page

sys.path.insert(0, str(Path(__file__).parent))
from site_pages import GENERATED

OUTSIDE = re.compile(r"\]\(\.\./([^)\s]+)\)")
"""Link to a file of the repository that is no page."""


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001
    """Return a page with its generated part, and with links into the repository."""
    if generate := GENERATED.get(page.file.src_uri):
        markdown += f"\n\n{generate()}\n"
    return OUTSIDE.sub(rf"]({config.repo_url}/blob/main/\1)", markdown)
