"""The command that serves an engine of AIRHILT to runs, of this project or others."""

from __future__ import annotations

from pathlib import Path

import click

from airhilt.cli.output import tell, tell_page
from airhilt.cli.parameters import PATH

LARGEST_REQUEST_BYTES = 32_000_000
"""Greatest size of a request: a picture of 8 megapixels, or 16 minutes of a call."""


@click.command(
    epilog="""\b
Examples:
  airhilt serve asr --port 9001
  airhilt serve tts --engine flite --port 9002
  airhilt cosim --scenario s01a_nominal --asr http://127.0.0.1:9001/v1/audio/transcriptions
"""
)
@click.argument("kind", type=click.Choice(["asr", "tts", "vision", "decision"]))
@click.option("--engine", metavar="ENGINE", help="Engine, as for `airhilt cosim`.")
@click.option("--port", type=click.IntRange(0, 65535), default=0, help="Port.  [default: free]")
@click.option(
    "--host",
    default="127.0.0.1",
    show_default=True,
    help="Address to listen at. Any but loopback needs TLS and a token.",
)
@click.option("--certificate", type=PATH, metavar="FILE", help="TLS certificate, PEM.")
@click.option("--key", type=PATH, metavar="FILE", help="Key of the certificate, PEM.")
@click.option(
    "--token-file",
    type=PATH,
    metavar="FILE",
    help="File with the token that requests must have as their bearer token.",
)
def serve(
    kind: str,
    engine: str | None,
    port: int,
    host: str,
    certificate: Path | None,
    key: Path | None,
    token_file: Path | None,
) -> None:
    """Serve an engine at an address, until it is interrupted."""
    from airhilt.assistant.service_kinds import FAMILY, KINDS, PATHS
    from airhilt.assistant.serving import service_app
    from airhilt.cli.station_flags import PageOptions
    from airhilt.station.server import serve as serve_app

    address = PageOptions(port, host, certificate, key, token_file, no_browser=True).address()
    chosen = next(each for each in KINDS if each == kind)
    app = service_app(chosen, engine or FAMILY[chosen].default)
    serve_app(
        app,
        address,
        opened=lambda url: tell_page(url.partition("?")[0].rstrip("/") + PATHS[chosen]),
        notice=tell,
        browser=False,
        largest_bytes=LARGEST_REQUEST_BYTES,
    )


COMMAND = serve
