"""The command that runs a scenario."""

from __future__ import annotations

import click

from airhilt.cli.output import echo_json


class RunCommand(click.Command):
    """A command with the flags of a run; they are made when somebody asks for them."""

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """Return the parameters: those of the command itself, and the flags of a run."""
        from airhilt.cli.run_flags import run_flags

        if not any(parameter.name == "seed" for parameter in self.params):
            self.params[1:1] = run_flags()
        return super().get_params(ctx)


@click.command(
    cls=RunCommand,
    epilog="""\b
Examples:
  airhilt cosim --scenario s02a_headon
  airhilt cosim --scenario my.json --seed 7 --latency lognormal --out runs/mine
  airhilt cosim --scenario s02a_headon --assistant none --json
  airhilt cosim --scenario s02a_headon --endpoint tcp/127.0.0.1:7447 --attach decision
""",
)
@click.option(
    "--scenario",
    required=True,
    metavar="NAME_OR_FILE",
    help="A scenario of `airhilt list`, or a JSON file.",
)
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print summary.json on standard output, everything else on standard error.",
)
@click.pass_context
def cosim(context: click.Context, /, scenario: str, as_json: bool, **_: object) -> None:
    """Run a scenario and leave a run folder."""
    from airhilt.cli.progress import ProgressLine, print_summary
    from airhilt.cli.run_flags import options_given
    from airhilt.cosim.simulation import run
    from airhilt.world.loading import load

    options = options_given(context)
    with ProgressLine(scenario) as progress:
        result = run(load(scenario), options, progress)
    if as_json:
        echo_json(result.summary.model_dump_json(indent=2))
        click.echo(f"run folder: {result.folder}", err=True)
    else:
        print_summary(result.summary, result.folder)


COMMAND = cosim
