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

OUTSIDE = re.compile(r"\[([^]]+)\]\(\.\./([^)\s]+)\)")
"""Link to a file of the repository that is no page: its words, and the path."""


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001
    """Return a page with its generated part, and with links into the repository.

    Without the address of a repository, ``repo_url`` in mkdocs.yml, the words stay without a link.
    """
    if generate := GENERATED.get(page.file.src_uri):
        markdown += f"\n\n{generate()}\n"
    link = rf"[\1]({config.repo_url}/blob/main/\2)" if config.repo_url else r"\1"
    return OUTSIDE.sub(link, markdown)
