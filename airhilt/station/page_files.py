"""The files of the page."""

from __future__ import annotations

import hashlib
import re
from functools import cache
from importlib import resources

from jinja2 import Environment, PackageLoader

MEDIA_TYPES = {
    "css": "text/css; charset=utf-8",
    "html": "text/html; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
}
"""Media type of the files, by the end of their names."""
PAGES = ("index.html", "together.html", "home.html", "experiment.html")
"""Pages, which are put together of their parts."""
SHARED = ("series", "words")
"""Scripts of a report that the page takes, as modules."""
DECLARED = re.compile(r"^(?:const|function) (\w+)", re.MULTILINE)
"""Names that such a script declares."""


def media_type(name: str) -> str:
    """Return the media type of a file."""
    return MEDIA_TYPES[name.rpartition(".")[2]]


@cache
def page_version() -> str:
    """Return a name for the files of the page, which is another one if any of them changes."""
    content = b"".join(name.encode() + body for name, body in sorted(page_files().items()))
    return hashlib.sha256(content).hexdigest()[:12]


def page_files() -> dict[str, bytes]:
    """Return the files of the page by their names."""
    folder = resources.files(__package__).joinpath("page")
    files = {
        path.name: path.read_bytes()
        for path in folder.iterdir()
        if path.name.rpartition(".")[2] in MEDIA_TYPES
    }
    pages = Environment(loader=PackageLoader(__package__, "page"), autoescape=True)
    for name in PAGES:
        files[name] = pages.get_template(name).render().encode()
    shared = resources.files("airhilt.report").joinpath("shared")
    for name in SHARED:
        script = shared.joinpath(f"{name}.js").read_text("utf-8")
        exported = ", ".join(DECLARED.findall(script))
        files[f"{name}.js"] = f"{script}\nexport {{ {exported} }};\n".encode()
    return files
