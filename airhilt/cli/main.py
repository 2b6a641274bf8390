"""The command line: it finds the commands, and turns a user's mistakes into one line."""

from __future__ import annotations

import io
import os
import resource
import signal
import sys
from typing import NoReturn

import click

from airhilt._version import __version__
from airhilt.cli.output import tell
from airhilt.cli.parameters import INTERRUPTED
from airhilt.errors import AirhiltError, is_out_of_memory
from airhilt.host.library import nearest
from airhilt.plugins import Family

COMMANDS = Family("command", "airhilt.commands", "airhilt.cli.commands", "COMMAND", click.Command)
CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 100}
OUT_OF_MEMORY = 2
MEANT = {"run": "cosim", "simulate": "cosim"}
"""Commands by names that people try, which other programs have."""

ADDRESS_SPACE = 3 * 10**9
"""Least address space that a sweep was seen to work in, in bytes.

With less, OpenBLAS and Dask wait for memory for ever instead of failing.
"""


class Commands(click.Group):
    """The commands of the family; each is loaded when it is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002
        """Return the names of all commands."""
        return COMMANDS.names()

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """Return a command, None if there is none of that name.

        One that cannot be loaded is there with the cause for its help; calling it is an error.
        """
        if cmd_name not in COMMANDS.names():
            return None
        try:
            command: click.Command = COMMANDS.load(cmd_name)
        except AirhiltError as error:
            return _broken(cmd_name, error)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the command that is asked for; an unknown one is an error with the nearest."""
        if args and not args[0].startswith("-") and args[0] not in COMMANDS.names():
            tail = nearest(MEANT.get(args[0], args[0]), COMMANDS.names())
            raise click.UsageError(f"No such command {args[0]!r}{tail}", ctx)
        return super().resolve_command(ctx, args)


def _broken(name: str, error: AirhiltError) -> click.Command:
    """Return a command in the place of one that cannot be loaded; it raises the cause."""

    def fail(given: tuple[str, ...]) -> NoReturn:  # noqa: ARG001
        raise error

    return click.Command(
        name,
        context_settings={"ignore_unknown_options": True, "help_option_names": []},
        callback=fail,
        params=[click.Argument(["given"], nargs=-1, type=click.UNPROCESSED)],
        short_help=str(error),
    )


@click.group(cls=Commands, context_settings=CONTEXT)
@click.version_option(__version__, prog_name="airhilt")
def cli() -> None:
    """Run, replay and report encounters for assistants that warn pilots and controllers.

    \b
    airhilt list                              what scenarios there are
    airhilt cosim --scenario s02a_headon      run one
    airhilt report RUN                        make its report, one HTML file
    airhilt station                           choose, start and watch runs in the browser
    airhilt view RUN                          show it in the browser, with sound and pictures
    airhilt experiment PLAN                   lead participants through trials at a seat
    airhilt replay RUN                        run it again and compare
    airhilt verify RUN                        say whether it is as it was written
    airhilt listen RUN                        write what was said, as sound and as text
    airhilt export RUN --to parquet           write its data as tables
    airhilt sweep --scenario 's02a_*' --snr 0:20:5 --seeds 10    run many, into one table
    airhilt evaluate --preset paper           make the paper's table
    airhilt compare SWEEP SWEEP               say what differs, and how surely
    airhilt render --scenario s01b_nominal --camera runway_01    write what a camera sees
    """
    _check_address_space()


def main() -> NoReturn:
    """Run the command line; a user's mistake ends with one line and exit code 2."""
    signal.signal(signal.SIGTERM, _interrupt)
    signal.signal(signal.SIGINT, _interrupt)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # A terminal may lack UTF-8.
    try:
        code = cli.main(standalone_mode=False)
    except AirhiltError as error:
        for line in str(error).splitlines():
            tell(line)
        sys.exit(error.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.exceptions.Abort):
        click.echo("airhilt: interrupted", err=True)
        sys.exit(INTERRUPTED)
    except Exception as error:
        if not is_out_of_memory(error):
            raise
        _end_without_memory(error)
    sys.exit(code if isinstance(code, int) else 0)


def _check_address_space() -> None:
    """Refuse to start within an address space (``ulimit -v``) in which libraries hang."""
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit != resource.RLIM_INFINITY and limit < ADDRESS_SPACE:
        raise AirhiltError(
            f"the address space is limited to {limit / 1e9:.2f} GB (ulimit -v); "
            f"expected at least {ADDRESS_SPACE / 1e9:.0f} GB"
        )


def _end_without_memory(error: Exception) -> NoReturn:
    """End at once: a thread that waits for one that was never started would wait for ever."""
    tell(f"memory ran out ({str(error) or 'MemoryError'}); expected more memory for this process")
    sys.stdout.flush()
    os._exit(OUT_OF_MEMORY)


def _interrupt(*_: object) -> None:
    """Interrupt once: what then finishes the run folder must not be interrupted again."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt
