"""A hub of models on loopback: the part of Hugging Face's API that a download asks for."""

from __future__ import annotations

import hashlib
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

REPOSITORY = "somebody/tiny-whisper"
COMMIT = "0123456789abcdef0123456789abcdef01234567"


@dataclass
class Hub:
    """One repository, and what was asked of it.

    Attributes
    ----------
    sent
        Content that is sent in the place of that of a file.
    """

    files: dict[str, bytes]
    sent: dict[str, bytes] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)
    url: str = ""

    def answer(self, path: str) -> tuple[bytes, dict[str, str]] | None:
        """Return body and headers for a path; None if there is nothing."""
        self.asked.append(path)
        route = path.partition("?")[0]
        api = f"/api/models/{REPOSITORY}"
        if route in (f"{api}/revision/main", f"{api}/revision/{COMMIT}"):
            return _json({"id": REPOSITORY, "modelId": REPOSITORY, "sha": COMMIT, "tags": []})
        if route == f"{api}/tree/{COMMIT}":
            return _json([self._entry(name) for name in self.files])
        name = route.removeprefix(f"/{REPOSITORY}/resolve/{COMMIT}/")
        if name not in self.files:
            return None
        headers = {"ETag": f'"{_sha256(self.files[name])}"', "X-Repo-Commit": COMMIT}
        return self.sent.get(name, self.files[name]), headers

    def _entry(self, name: str) -> dict[str, Any]:
        oid, size = _sha256(self.files[name]), len(self.files[name])
        lfs = {"oid": oid, "size": size, "pointerSize": 134}
        return {"type": "file", "path": name, "size": size, "oid": oid[:40], "lfs": lfs}


@contextmanager
def hub_of(folder: Path) -> Iterator[Hub]:
    """Yield a hub whose repository has the files of a folder, and a page that nobody needs."""
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    hub = Hub(files | {"README.md": b"# Tiny"})

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            found = hub.answer(self.path)
            body, headers = found or (b'{"error": "Repository not found"}', {})
            self.send_response(200 if found else 404)
            if not found:
                self.send_header("X-Error-Code", "RepoNotFound")
            for name, value in ({"Content-Length": str(len(body))} | headers).items():
                self.send_header(name, value)
            self.end_headers()
            if self.command == "GET":
                self.wfile.write(body)

        do_HEAD = do_GET  # noqa: N815

        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, args=(0.02,))
    thread.start()
    hub.url = f"http://127.0.0.1:{server.server_port}"
    try:
        yield hub
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def _json(document: Any) -> tuple[bytes, dict[str, str]]:
    return json.dumps(document).encode(), {"Content-Type": "application/json"}


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
