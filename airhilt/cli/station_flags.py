"""The options of the commands that open a page in the browser."""

from __future__ import annotations

import ssl
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial, wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import click
from click.core import ParameterSource

from airhilt.cli.parameters import GroupedOption
from airhilt.errors import StationError
from airhilt.station.address import DEFAULT_HOST, DEFAULT_PORT, Address

F = TypeVar("F", bound=Callable[..., Any])
FILE = click.Path(path_type=Path, exists=True, dir_okay=False)


@dataclass(frozen=True)
class PageOptions:
    """Options of the command line for the page of a command: its address, and who may open it."""

    port: int
    host: str
    certificate: Path | None
    key: Path | None
    token_file: Path | None
    no_browser: bool

    def address(self) -> Address:
        """Return the address that the page has.

        Raises
        ------
        StationError
            A file cannot be read, or the address is not safe.
        """
        _check_certificate(self.certificate, self.key)
        try:
            token = "" if self.token_file is None else self.token_file.read_text("utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            raise StationError(f"{self.token_file}: cannot be read: {error}") from None
        return Address(self.host, self.port, self.certificate, self.key, token)

    def arguments(self) -> list[str]:
        """Return the arguments that give these options to another command."""
        files = {
            "--certificate": self.certificate,
            "--key": self.key,
            "--token-file": self.token_file,
        }
        given = [f"--port={self.port}", f"--host={self.host}"]
        given += [f"{name}={path.resolve()}" for name, path in files.items() if path is not None]
        return [*given, "--no-browser"] if self.no_browser else given

    def of_another_page(self) -> list[str]:
        """Return the arguments for a page at a free port, with which this one links to it."""
        return replace(self, port=0, no_browser=True).arguments()


def station_options(command: F) -> F:
    """Add the options that say where the page is and who may open it, as a parameter ``page``."""

    @wraps(command)
    def with_page(*arguments: Any, **given: Any) -> Any:
        page = PageOptions(**{field.name: given.pop(field.name) for field in fields(PageOptions)})
        return command(*arguments, page=page, **given)

    decorated: Any = with_page
    option = partial(click.option, cls=GroupedOption, group="Page in the browser")
    for page_option in reversed(
        (
            option("--port", type=click.IntRange(0, 65535), default=DEFAULT_PORT,
                         show_default=True, help="Port of the page."),
            option("--host", default=DEFAULT_HOST, show_default=True, help="Address to "
                         "listen at. Any but loopback needs TLS and a token."),
            option("--certificate", type=FILE, metavar="FILE", help="TLS certificate, PEM."),
            option("--key", type=FILE, metavar="FILE", help="Key of the certificate, PEM."),
            option("--token-file", type=FILE, metavar="FILE", help="File with the token that "
                         "a browser must have; it is in the URL that is printed."),
            option("--no-browser", is_flag=True, help="Print the URL, and open no browser."),
        )
    ):  # fmt: skip
        decorated = page_option(decorated)
    return cast("F", decorated)


def refuse_page_options(missing: str) -> None:
    """Complain about the options of a page that the current command does not open.

    It opens none without the options ``missing``.

    Raises
    ------
    click.UsageError
        One was given.
    """
    context = click.get_current_context()
    for field in fields(PageOptions):
        if context.get_parameter_source(field.name) is ParameterSource.COMMANDLINE:
            flag = f"--{field.name.replace('_', '-')}"
            raise click.UsageError(f"{flag} would do nothing without {missing}")


def _check_certificate(certificate: Path | None, key: Path | None) -> None:
    """Complain about files that are no certificate with its key."""
    if certificate is None or key is None:
        return
    try:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(certificate, key, password=lambda: b"")
    except (OSError, ValueError) as error:
        raise StationError(
            f"{certificate}, {key}: {error}; expected a PEM certificate and its key, without a "
            "password"
        ) from None
