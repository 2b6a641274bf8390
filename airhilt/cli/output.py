"""Output of the commands, which may have text in it from a file that somebody sent."""

from __future__ import annotations

import sys

import click

from airhilt.host.text import LONGEST_LINE, readable


def echo(text: object, err: bool = False) -> None:
    """Print lines, none of which can command the terminal or is very long."""
    for line in str(text).splitlines():
        click.echo(readable(line, LONGEST_LINE), err=err)


def tell(text: str) -> None:
    """Print a line for a person that is no result of a command, on standard error."""
    echo(f"airhilt: {text}", err=True)


def tell_page(url: str) -> None:
    """Print where a page is, once it can be opened."""
    click.echo(f"{url}   (end with Ctrl+C)")


def echo_json(document: str) -> None:
    """Print a JSON document whole, with escapes for what cannot be printed."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    click.echo("".join(_escaped(character, encoding) for character in document))


def _escaped(character: str, encoding: str) -> str:
    is_in_charset = character.encode(encoding, "ignore") != b""
    if character == "\n" or (character.isprintable() and is_in_charset):
        return character
    pairs = character.encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{pairs[at : at + 4]}" for at in range(0, len(pairs), 4))
