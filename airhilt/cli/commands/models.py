"""The commands of ``airhilt models``: get, list and remove models that are used by name."""

from __future__ import annotations

import click

from airhilt.cli.output import tell


@click.group(
    epilog="""\b
Examples:
  airhilt models get small.en       download a Whisper model, for --asr whisper:small.en
  airhilt models get Systran/faster-whisper-small.en --revision COMMIT
  airhilt models list
  airhilt models remove small.en
"""
)
def models() -> None:
    """Download models for runs, which never download anything themselves."""


@models.command()
@click.argument("name")
@click.option(
    "--revision",
    metavar="REVISION",
    help="Commit, tag or branch at the hub.  [default: what is there, or else the newest]",
)
def get(name: str, revision: str | None) -> None:
    """Download a Whisper model from the Hugging Face hub, or from HF_ENDPOINT.

    NAME is one of faster-whisper's, such as small.en, or OWNER/REPOSITORY.
    """
    from airhilt.assistant.asr.whisper_models import download, source_of

    tell(f"getting {name}; this may take minutes")
    folder = download(name, revision)
    source = source_of(folder)
    click.echo(f"{folder}\n{source.repository} at {source.revision}")
    for file, sha256 in source.files.items():
        click.echo(f"{sha256}  {file}")
    click.echo(f"use it with --asr whisper:{name}")


@models.command("list")
def show() -> None:
    """List the models that were downloaded."""
    from airhilt.assistant.asr.whisper_models import downloaded

    for name, source in downloaded():
        click.echo(f"{name}  {source.repository} at {source.revision}")


@models.command()
@click.argument("name")
def remove(name: str) -> None:
    """Delete a model that was downloaded."""
    from airhilt.assistant.asr.whisper_models import remove as remove_model

    remove_model(name)


COMMAND = models
