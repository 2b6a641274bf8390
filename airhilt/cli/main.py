"""The commands. Each only reads its arguments, calls the package, and prints."""

from __future__ import annotations

import json
import math
import signal
import sys
from pathlib import Path
from typing import Any, NoReturn

import click
from click.core import ParameterSource

from airhilt._version import __version__
from airhilt.cli.airport import airport
from airhilt.cli.dataset import dataset
from airhilt.cli.render import render, renderer_option
from airhilt.errors import AirhiltError, ScenarioError


class _Finite(click.FloatRange):
    """A number of some unit: NaN passes click's own check."""

    def __init__(self, what: str, **limits: Any) -> None:
        super().__init__(**limits)
        self._what = what

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value} is no {self._what}", param, ctx)
        return number


SECONDS = _Finite("time in seconds", min=0.0, max=86_400.0, min_open=True)
DECIBELS = _Finite("ratio in decibels", min=-30.0, max=60.0)
CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 100}
INTERRUPTED = 130


@click.group(context_settings=CONTEXT)
@click.version_option(__version__, prog_name="airhilt")
def cli() -> None:
    """Run, replay and report encounters for assistants that warn pilots and controllers.

    \b
    airhilt list                              what scenarios there are
    airhilt cosim --scenario s02a_headon      run one
    airhilt report RUN                        make its report, one HTML file
    airhilt replay RUN                        run it again and compare
    airhilt listen RUN                        write what was said, as sound and as text
    airhilt render --scenario s01b_nominal --camera runway_01    write what a camera sees
    """


@cli.command(
    epilog="""\b
Examples:
  airhilt cosim --scenario s02a_headon
  airhilt cosim --scenario my.json --seed 7 --latency lognormal --out runs/mine
  airhilt cosim --scenario s02a_headon --assistant none --json
  airhilt cosim --scenario s02a_headon --listen tcp/127.0.0.1:7447 --attach decision
"""
)
@click.option(
    "--scenario",
    required=True,
    metavar="NAME_OR_FILE",
    help="A scenario of `airhilt list`, or a JSON file.",
)
@click.option(
    "--seed",
    type=int,
    default=0,
    show_default=True,
    help="Of perturbations, sensors, crews and turbulence.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="The run folder.  [default: a new one under runs/]",
)
@click.option("--overwrite", is_flag=True, help="Replace the run that --out holds.")
@click.option(
    "--assistant",
    metavar="NAME",
    help="reference, none, or external (who decides is attached).  [default: reference, "
    "external if an attached program may decide]",
)
@click.option(
    "--pace", metavar="PACE", help="virtual (as fast as it goes), realtime, or a factor such as 4x."
)
@click.option(
    "--latency",
    default="measured",
    show_default=True,
    metavar="SOURCE",
    help="measured, fixed, fixed:SECONDS, lognormal or replay:RUN.",
)
@click.option(
    "--listen",
    metavar="ENDPOINT",
    help="Where the bus listens, such as tcp/127.0.0.1:7447.  [default: a free port]",
)
@click.option(
    "--attach",
    multiple=True,
    metavar="WORKER",
    help="Wait for this worker of another process; may be given again.",
)
@click.option(
    "--attach-timeout",
    type=SECONDS,
    default=60.0,
    show_default=True,
    metavar="SECONDS",
    help="How long to wait for it.",
)
@click.option(
    "--step-timeout",
    type=SECONDS,
    default=5.0,
    show_default=True,
    metavar="SECONDS",
    help="Wall time after which an attached worker that does not answer is lost.",
)
@click.option("--no-cameras", is_flag=True, help="Leave cameras and vision out.")
@renderer_option
@click.option(
    "--detector",
    default="embedded",
    show_default=True,
    metavar="ENGINE",
    help="What looks at pictures: embedded, embedded:FILE.onnx, yolo:FILE, the address of a "
    "service, or none.",
)
@click.option(
    "--video", is_flag=True, help="Write what each camera saw as MP4, with boxes and advisories."
)
@click.option("--no-speech", is_flag=True, help="Radio calls as text, not as sound.")
@click.option(
    "--snr",
    type=DECIBELS,
    metavar="DB",
    help="Signal-to-noise ratio of the radio.  [default: the scenario's; without one, no noise]",
)
@click.option(
    "--radio-profile",
    metavar="NAME",
    help="vhf, vhf_833, fading, noisy_cockpit, monitor, line, or a learned channel, FILE.onnx.  "
    "[default: the scenario's, or vhf]",
)
@click.option(
    "--asr",
    default="embedded",
    show_default=True,
    metavar="ENGINE",
    help="What recognises speech: embedded, whisper:FOLDER, or the address of a service.",
)
@click.option(
    "--tts",
    default="espeak",
    show_default=True,
    metavar="ENGINE",
    help="What speaks: espeak, flite, coqui:FOLDER, or the address of a service.",
)
@click.option(
    "--topology",
    type=click.Choice(["parallel", "asr_first", "gated_fusion"]),
    metavar="NAME",
    help="parallel, asr_first (crews get the transcript) or gated_fusion (no advisory while "
    "something is left to fuse).  [default: the scenario's]",
)
@click.option("--strict", is_flag=True, help="Stop when a worker is lost (exit code 3).")
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print summary.json on standard output, everything else on standard error.",
)
def cosim(scenario: str, attach: tuple[str, ...], as_json: bool, **given: Any) -> None:
    """Run a scenario and leave a run folder."""
    from airhilt.cli.progress import ProgressLine, print_summary
    from airhilt.cosim.simulation import run
    from airhilt.options import Options
    from airhilt.world.loading import load

    if given["no_cameras"]:
        _refuse_given("--no-cameras leaves pictures out", "renderer", "detector", "video")
    if given["no_speech"]:
        _refuse_given("--no-speech leaves sound out", "asr", "tts", "radio_profile")
    options = Options(
        seed=given["seed"],
        out=given["out"],
        overwrite=given["overwrite"],
        assistant=given["assistant"],
        pace=given["pace"],
        latency=given["latency"],
        listen=given["listen"],
        attach=attach,
        attach_timeout_s=given["attach_timeout"],
        step_timeout_s=given["step_timeout"],
        cameras=not given["no_cameras"],
        speech=not given["no_speech"],
        strict=given["strict"],
        snr_db=given["snr"],
        radio_profile=given["radio_profile"],
        asr=given["asr"],
        tts=given["tts"],
        renderer=given["renderer"],
        detector=given["detector"],
        video=given["video"],
        topology=given["topology"],
    )
    with ProgressLine(scenario) as progress:
        result = run(load(scenario), options, progress)
    if as_json:
        click.echo(result.summary.model_dump_json(indent=2))
        click.echo(f"run folder: {result.folder}", err=True)
    else:
        print_summary(result.summary, result.folder)


def _refuse_given(why: str, *names: str) -> None:
    """Refuse options of this command that were given but would do nothing.

    Raises
    ------
    AirhiltError
        One of them was.
    """
    context = click.get_current_context()
    for name in names:
        if context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            option = f"--{name.replace('_', '-')}"
            raise AirhiltError(
                f"{option} {context.params[name]!r} would do nothing: {why}; expected only one of "
                "the two"
            )


@cli.command(
    "list",
    epilog="""\b
Examples:
  airhilt list
  airhilt list --json
""",
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON array.")
def list_scenarios(as_json: bool) -> None:
    """Name the scenarios that ship with AIRHILT."""
    from airhilt import library

    rows = []
    for name in library.names("scenarios"):
        document = json.loads(library.find("scenarios", name).read_text(encoding="utf-8"))
        rows.append({key: document.get(key, "") for key in ("name", "family", "title")})
    if as_json:
        click.echo(json.dumps(rows, indent=2))
        return
    width = max((len(row["name"]) for row in rows), default=0)
    for row in rows:
        click.echo(f"{row['name']:{width}}  {row['family']}  {row['title']}")


@cli.command(
    epilog="""\b
Examples:
  airhilt report runs/s02a_headon-0-20260101T120000
  airhilt report RUN --out headon.html
"""
)
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Where to write it.  [default: report.html in the run folder]",
)
def report(run_folder: Path, out: Path | None) -> None:
    """Make the report of a run: one HTML file that opens offline."""
    from airhilt.report.report import write_report

    click.echo(write_report(run_folder, out))


@cli.command(
    epilog="""\b
Examples:
  airhilt replay runs/s02a_headon-0-20260101T120000
  airhilt replay RUN --json
"""
)
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def replay(run_folder: Path, as_json: bool) -> None:
    """Run a run again with the latencies it had, and say where the two differ.

    Exit code 0: identical. 1: they differ.
    """
    from airhilt.cli.progress import ProgressLine
    from airhilt.cosim.replay import replay as replay_run

    with ProgressLine(f"replay of {run_folder}") as progress:
        verdict = replay_run(run_folder, progress)
    if as_json:
        click.echo(json.dumps(verdict.as_dict(), indent=2))
    else:
        click.echo(str(verdict))
    if not verdict.identical:
        sys.exit(1)


@cli.command(
    epilog="""\b
Examples:
  airhilt listen runs/s02a_headon-0-20260101T120000
  airhilt listen RUN --frequency 118300 --out tower.wav
  airhilt listen RUN --json
"""
)
@click.argument("run_folder", metavar="RUN", type=click.Path(path_type=Path))
@click.option(
    "--frequency",
    "frequency_khz",
    type=int,
    metavar="KHZ",
    help="Which one, such as 118300.  [default: the run's only one]",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="The WAV file; the transcript has its name with .txt.  [default: frequency-KHZ.wav in "
    "the run folder]",
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object.")
def listen(run_folder: Path, frequency_khz: int | None, out: Path | None, as_json: bool) -> None:
    """Write a frequency of a run as a WAV file, and who said and heard what beside it."""
    from airhilt.record.tape import listen as write_tape

    tape, wav, text = write_tape(run_folder, frequency_khz, out)
    if as_json:
        files = {"wav": str(wav), "transcript": str(text)}
        click.echo(json.dumps(tape.as_dict() | files, indent=2))
    else:
        click.echo(tape.text())
        click.echo(f"{wav}\n{text}")


@cli.command(
    epilog="""\b
Examples:
  airhilt validate my_scenario.json
"""
)
@click.argument("file")
def validate(file: str) -> None:
    """Check a scenario file, and put all its actors where they begin."""
    from airhilt.cosim.setup import TICK_S
    from airhilt.world.actors import build_actors
    from airhilt.world.loading import draw, load
    from airhilt.world.site import ScenarioSite

    try:
        scenario = load(file)
    except ScenarioError as error:
        raise AirhiltError("\n".join(error.problems)) from None
    realised, _ = draw(scenario, 0)
    build_actors(realised, ScenarioSite.of(realised), 0, TICK_S)
    click.echo(f"{file}: valid: {scenario.name}, {len(scenario.actors)} actors")


@cli.command(
    epilog="""\b
Examples:
  airhilt schema > messages.json
  airhilt schema --scenario > scenario.schema.json
"""
)
@click.option("--scenario", is_flag=True, help="The schema of scenario files instead.")
def schema(scenario: bool) -> None:
    """Print the JSON Schemas of all messages on the bus."""
    if scenario:
        from airhilt.scenario import Scenario

        document = Scenario.model_json_schema()
    else:
        from airhilt.messages import json_schemas
        from airhilt.sensors.base import sensor_messages

        document = json_schemas(sensor_messages())
    click.echo(json.dumps(document, indent=2))


@cli.command(
    epilog="""\b
Examples:
  airhilt doctor
  airhilt doctor --json
"""
)
@click.option("--json", "as_json", is_flag=True, help="Print a JSON array.")
def doctor(as_json: bool) -> None:
    """Say what is installed, what is missing, and how to get it.

    Exit code 1 if something is missing that every run needs.
    """
    from airhilt.cli.doctor import examine

    findings = examine()
    if as_json:
        click.echo(json.dumps([finding.as_dict() for finding in findings], indent=2))
    else:
        for finding in findings:
            click.echo(str(finding))
    if any(finding.needed and not finding.found for finding in findings):
        sys.exit(1)


@cli.command(
    epilog="""\b
Examples:
  airhilt worker decision --connect tcp/127.0.0.1:7447
  airhilt worker asr --engine whisper:models/base.en --connect tcp/127.0.0.1:7447
  airhilt worker vision --engine yolo:models/yolov10n.pt --connect tcp/127.0.0.1:7447
"""
)
@click.argument("kind", type=click.Choice(["decision", "asr", "tts", "vision"]))
@click.option("--engine", metavar="ENGINE", help="Engine, as for `airhilt cosim`.")
@click.option("--connect", required=True, metavar="ENDPOINT", help="The run's endpoint.")
@click.option(
    "--run", "run_name", metavar="RUN", help="Name of the run, where several share an endpoint."
)
@click.option("--name", default=None, help="Name of the worker.  [default: its kind]")
@click.option(
    "--patience",
    type=SECONDS,
    default=30.0,
    show_default=True,
    metavar="SECONDS",
    help="How long to wait for the run to come up.",
)
def worker(
    kind: str,
    engine: str | None,
    connect: str,
    run_name: str | None,
    name: str | None,
    patience: float,
) -> None:
    """Attach a reference worker to a run from this process."""
    from airhilt.assistant.reference import reference_worker
    from airhilt.workers import serve

    serve(reference_worker(kind, engine, name or kind), connect, run_name, patience)


cli.add_command(airport)
cli.add_command(dataset)
cli.add_command(render)


def main() -> NoReturn:
    """Run the command line; a user's mistake ends with one line and exit code 2."""
    signal.signal(signal.SIGTERM, _interrupt)
    signal.signal(signal.SIGINT, _interrupt)
    try:
        code = cli.main(standalone_mode=False)
    except AirhiltError as error:
        for line in str(error).splitlines():
            click.echo(f"airhilt: {line}", err=True)
        sys.exit(error.exit_code)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except (KeyboardInterrupt, click.exceptions.Abort):
        click.echo("airhilt: interrupted", err=True)
        sys.exit(INTERRUPTED)
    sys.exit(code if isinstance(code, int) else 0)


def _interrupt(*_: object) -> None:
    """Interrupt once: what then finishes the run folder must not be interrupted again."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt
