"""The options of a run, for Python, the command line and ``run.json``.

`Options` is the only place where an option is written: its default, its limits, and in its `Flag`
how the command line spells and explains it. `airhilt.run` takes its fields as keywords, ``airhilt
cosim`` makes its flags of them, and ``run.json`` holds them whole, so that a replay has them back.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    ValidationError,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

from airhilt.engine_families import (
    ASSISTANTS,
    DETECTORS,
    ENHANCERS,
    NONE,
    RECOGNISERS,
    VOICES,
    WORDINGS,
)
from airhilt.engines import RENDERER_HELP, EngineFamily
from airhilt.errors import AirhiltError, all_problems, shown
from airhilt.host.files import is_url
from airhilt.host.library import nearest
from airhilt.messages import Modality, RadarKind, Told
from airhilt.scenario.models import ResponseModelName, Topology
from airhilt.scenario.models.scene import Visibility

RUN_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,79}")
"""Names of runs: one chunk of a key of Zenoh, and of a path."""
LABEL = re.compile(r"[a-z][a-z0-9_-]{0,39}")
"""Classes of what cameras see, as `airhilt.messages.VisibleClass` has them."""
LONGEST_S = 86_400.0
"""Greatest timeout in s."""
MODALITIES: tuple[Modality, ...] = ("adsb", "asr", "vision")
"""Modalities by which an assistant observes."""

ASSISTANT = "Assistant"
PROGRAMS = "Workers and external programs"
PEOPLE = "People at seats"
CAMERAS = "Cameras"
RADIO = "Radio and speech"
WORLD = "People and equipment in the world"


@dataclass(frozen=True)
class Flag:
    """Spelling and explanation of an option on the command line.

    Attributes
    ----------
    name
        Such as ``--seed``; one of a switch that turns something off begins with ``--no-``.
    help
        One or two sentences.
    metavar
        Stands for the value in the help.
    default
        Shown in the help where the option's own default (None) says nothing.
    needs
        Names of the options without which this one does nothing.
    in_sweeps
        False for what belongs to one run alone, such as its folder, and for programs that attach
        to it.
    help_of_one_run
        Sentence after the help of a single run, about what sweeps have not.
    group
        Heading in the help.
    """

    name: str
    help: str
    metavar: str | None = None
    default: str = ""
    needs: tuple[str, ...] = ()
    in_sweeps: bool = True
    help_of_one_run: str = ""
    group: str = "Options"


def _engine_flag(family: EngineFamily[Any], group: str, metavar: str = "ENGINE") -> Flag:
    """Return the flag by which the command line chooses an engine of a family."""
    return Flag(f"--{family.option}", family.help, metavar, needs=family.needs, group=group)


def _one_chunk(name: str) -> str:
    """Return a name that is one chunk of a key."""
    if RUN_NAME.fullmatch(name) is None:
        raise PydanticCustomError(
            "run_name",
            "found {name}; expected at most 80 letters, digits, '.', '_' and '-', a letter or a "
            "digit first: it is a part of keys",
            {"name": shown(name)},
        )
    return name


def _on_this_machine(path: Any) -> Any:
    """Return a path unchanged; a URL is refused, or a folder such as ``s3:`` would be made."""
    if is_url(path):
        raise PydanticCustomError("url", "found {url}, a URL; expected a path", {"url": str(path)})
    return path


def _in_order(text: str) -> str:
    """Return names of modalities, each once and in the order of `MODALITIES`."""
    given = text.split("+")
    if not set(given) <= set(MODALITIES):
        raise PydanticCustomError(
            "modalities",
            "found {text}; expected some of adsb, asr and vision, such as adsb+asr",
            {"text": shown(text)},
        )
    return "+".join(each for each in MODALITIES if each in given)


def class_pairs(text: str) -> dict[str, str]:
    """Return the labels by names of a text such as ``aircraft=airplane,lorry=truck``.

    Raises
    ------
    ValueError
        It is none.
    """
    pairs = [part.partition("=") for part in text.split(",")]
    for name, _, label in pairs:
        if not name.strip() or not LABEL.fullmatch(label.strip()):
            raise ValueError(
                f"found {text!r}; expected pairs such as aircraft=airplane,lorry=truck"
            )
    return {name.strip(): label.strip() for name, _, label in pairs}


def _in_pairs(text: str) -> str:
    """Return pairs of names and classes unchanged."""
    try:
        class_pairs(text)
    except ValueError as error:
        raise PydanticCustomError(
            "pairs", "found {text}; {error}", {"text": shown(text), "error": str(error)}
        ) from None
    return text


Seconds = Annotated[float, Field(gt=0.0, le=LONGEST_S, allow_inf_nan=False)]


class Options(BaseModel):
    """The options of a run; the defaults are those of the command line."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    seed: Annotated[
        int, Flag("--seed", "Seed of perturbations, sensors, crews and turbulence.")
    ] = 0
    twin: Annotated[
        bool,
        Flag("--twin", "Run the scenario's nominal twin: the same traffic without its conflict."),
    ] = False
    out: Annotated[
        Path | None,
        BeforeValidator(_on_this_machine),
        Flag("--out", "The run folder.", "DIR", default="a new one under runs/", in_sweeps=False),
    ] = None
    overwrite: Annotated[
        bool, Flag("--overwrite", "Replace the run that --out holds.", in_sweeps=False)
    ] = False
    assistant: Annotated[
        str | None,
        replace(
            _engine_flag(ASSISTANTS, ASSISTANT, "NAME"),
            default=f"{ASSISTANTS.default}, external if you attach your own decision program",
            help_of_one_run="Or external: a worker or program of yours.",
        ),
    ] = None
    assistant_config: Annotated[
        dict[str, Any] | None,
        Flag(
            "--assistant-config",
            "Rules and thresholds of the assistant, a JSON file; `airhilt schema --assistant NAME` "
            "prints what it may hold.",
            "FILE",
            default="the assistant's own",
            needs=("assistant",),
            group=ASSISTANT,
        ),
    ] = None
    recipients: Annotated[
        Told | None,
        Flag(
            "--recipients",
            "Who is told of conflicts: crew (the crews and drivers concerned), controller, or "
            "both.",
            "WHO",
            default="whom the assistant tells",
            needs=("assistant",),
            group=ASSISTANT,
        ),
    ] = None
    modalities: Annotated[
        str,
        AfterValidator(_in_order),
        Flag(
            "--modalities",
            "What the assistant is given, such as adsb+asr: ADS-B reports, radio calls and their "
            "transcripts (asr), pictures and detections (vision). Crews and equipment keep theirs.",
            "NAMES",
            needs=("assistant",),
            group=ASSISTANT,
        ),
    ] = "+".join(MODALITIES)
    pace: Annotated[
        str | None,
        Flag(
            "--pace",
            "virtual (as fast as it goes), realtime, or a factor such as 4x.",
            "PACE",
            default="virtual, realtime if an attached program does not keep simulation time",
            in_sweeps=False,
        ),
    ] = None
    latency: Annotated[
        str | None,
        Flag(
            "--latency",
            "measured, fixed, fixed:SECONDS, lognormal, lognormal:MEDIAN, since_start:MEAN, "
            "on_output:SECONDS, paper or replay:RUN; after it other ones for single stages: "
            "fixed,asr=lognormal:5.9,tts=fixed:0.9.",
            "SOURCE",
            default="fixed; measured for workers and engines that you bring",
        ),
    ] = None
    endpoint: Annotated[
        str | None,
        Flag(
            "--endpoint",
            "Where the bus accepts connections, such as tcp/127.0.0.1:7447.",
            "ENDPOINT",
            default="none, or a free port with --attach, --seat, --tls or --share-truth",
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = None
    tls: Annotated[
        Path | None,
        Flag(
            "--tls",
            "Folder of `airhilt keys init`: programs need a certificate, and may do what its role "
            "may.",
            "DIR",
            default="no keys, on this machine alone",
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = None
    insecure: Annotated[
        bool,
        Flag(
            "--insecure",
            "Let programs of other machines connect without keys.",
            needs=("endpoint",),
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = False
    share_truth: Annotated[
        bool,
        Flag(
            "--share-truth",
            "Let every program that connects read truth/, for viewers and recorders. The results "
            "of a program that decides by it are worth nothing.",
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = False
    seat: Annotated[
        tuple[str, ...],
        Flag(
            "--seat",
            "Leave this seat to a person: tower, the name of a unit, or a callsign; may be given "
            "again. It is taken in the browser, and the run goes on in real time.",
            "NAME",
            in_sweeps=False,
            group=PEOPLE,
        ),
    ] = ()
    wait_for_seats: Annotated[
        bool,
        Flag(
            "--wait-for-seats",
            "Let the time stand still at the start until each --seat is taken.",
            needs=("seat",),
            in_sweeps=False,
            group=PEOPLE,
        ),
    ] = False
    pause: Annotated[
        bool,
        Flag(
            "--no-pause",
            "Refuse pause and slow motion to people at seats.",
            needs=("seat",),
            in_sweeps=False,
            group=PEOPLE,
        ),
    ] = True
    voice_recording: Annotated[
        bool,
        Flag(
            "--no-voice-recording",
            "Leave the voices of people at seats out of the run folder. Their words are there, as "
            "recognised; the run cannot be replayed.",
            needs=("seat",),
            in_sweeps=False,
            group=PEOPLE,
        ),
    ] = True
    isa_minutes: Annotated[
        Annotated[float, Field(gt=0.0, le=60.0, allow_inf_nan=False)] | None,
        Flag(
            "--isa",
            "Ask people at seats every so many minutes how high their workload is (ISA, 1 to 5).",
            "MINUTES",
            default="not asked",
            needs=("seat",),
            in_sweeps=False,
            group=PEOPLE,
        ),
    ] = None
    nasa_tlx: Annotated[
        bool,
        Flag(
            "--nasa-tlx",
            "Ask people at seats for the NASA-TLX ratings when the run has come to its end.",
            needs=("seat",),
            in_sweeps=False,
            group=PEOPLE,
        ),
    ] = False
    attach: Annotated[
        tuple[str, ...],
        Flag(
            "--attach",
            "Wait for this worker of another process; may be given again.",
            "WORKER",
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = ()
    attach_timeout_s: Annotated[
        Seconds,
        Flag(
            "--attach-timeout",
            "How long to wait for it.",
            "SECONDS",
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = 60.0
    step_timeout_s: Annotated[
        Seconds,
        Flag(
            "--step-timeout",
            "Wall time after which an attached worker that does not answer is lost.",
            "SECONDS",
            in_sweeps=False,
            group=PROGRAMS,
        ),
    ] = 5.0
    run_name: Annotated[
        Annotated[str, AfterValidator(_one_chunk)] | None,
        Flag(
            "--run-name",
            "Name of the run in its keys and on its page.  [default: scenario and seed]",
            "NAME",
            in_sweeps=False,
        ),
    ] = None
    cameras: Annotated[
        bool, Flag("--no-cameras", "Leave cameras and vision out.", group=CAMERAS)
    ] = True
    renderer: Annotated[
        str,
        Flag("--renderer", RENDERER_HELP, "NAME", needs=("cameras",), group=CAMERAS),
    ] = "auto"
    camera_rate: Annotated[
        Literal["full", "adaptive"],
        Flag(
            "--camera-rate",
            "full, or adaptive: one picture a second until a body would cover two pixels.",
            "NAME",
            needs=("cameras",),
            group=CAMERAS,
        ),
    ] = "full"
    share_pictures: Annotated[
        bool,
        Flag(
            "--share-pictures",
            "Take over from other runs, and keep for them, pictures and what is found in them. "
            "Sweeps do it by themselves. For latencies that are not measured.",
            needs=("cameras",),
            in_sweeps=False,
            group=CAMERAS,
        ),
    ] = False
    detector: Annotated[str, _engine_flag(DETECTORS, CAMERAS)] = DETECTORS.default
    detector_classes: Annotated[
        Annotated[str, AfterValidator(_in_pairs)] | None,
        Flag(
            "--detector-classes",
            "What classes of an onnx: or yolo: detector are called here, such as "
            "aircraft=airplane,lorry=truck.",
            "NAME=CLASS,...",
            default="by known synonyms; what is dropped is told",
            needs=("cameras", "assistant"),
            group=CAMERAS,
        ),
    ] = None
    visibility_m: Annotated[
        Visibility | None,
        Flag(
            "--visibility",
            "Meteorological optical range, for cameras.",
            "M",
            default="the scenario's",
            needs=("cameras",),
            group=CAMERAS,
        ),
    ] = None
    video: Annotated[
        bool,
        Flag(
            "--video",
            "Write what each camera saw as MP4, with boxes and advisories.",
            needs=("cameras",),
            in_sweeps=False,
            group=CAMERAS,
        ),
    ] = False
    speech: Annotated[
        bool, Flag("--no-speech", "Radio calls as text, not as sound.", group=RADIO)
    ] = True
    snr_db: Annotated[
        Annotated[float, Field(ge=-30.0, le=60.0, allow_inf_nan=False)] | None,
        Flag(
            "--snr",
            "Signal-to-noise ratio of the radio.",
            "DB",
            default="the scenario's; without one, no noise",
            group=RADIO,
        ),
    ] = None
    radio_profile: Annotated[
        str | None,
        Flag(
            "--radio-profile",
            "vhf, vhf_833, fading, noisy_cockpit, monitor, line, or a learned channel, FILE.onnx.",
            "NAME",
            default="the scenario's, or vhf",
            needs=("speech",),
            group=RADIO,
        ),
    ] = None
    asr: Annotated[str, _engine_flag(RECOGNISERS, RADIO)] = RECOGNISERS.default
    enhancer: Annotated[str, _engine_flag(ENHANCERS, RADIO)] = ENHANCERS.default
    partial_transcripts: Annotated[
        bool,
        Flag(
            "--partial-transcripts",
            "Recognise calls while they last, every 0.5 s, so that a decision may begin before "
            "their end.",
            needs=("speech", "assistant"),
            group=RADIO,
        ),
    ] = False
    tts: Annotated[str, _engine_flag(VOICES, RADIO)] = VOICES.default
    wording: Annotated[str, _engine_flag(WORDINGS, ASSISTANT, "NAME")] = WORDINGS.default
    llm: Annotated[
        str | None,
        Flag(
            "--llm",
            "Address of an OpenAI-compatible endpoint, such as http://127.0.0.1:11434/v1; its key, "
            "if it needs one, in AIRHILT_LLM_KEY.",
            "URL",
            default="no language model",
            needs=("assistant",),
            group=ASSISTANT,
        ),
    ] = None
    llm_model: Annotated[
        str,
        StringConstraints(strip_whitespace=True, min_length=1),
        Flag(
            "--llm-model",
            "Name of the language model there.",
            "NAME",
            needs=("llm",),
            group=ASSISTANT,
        ),
    ] = "gpt-oss:20b"
    llm_deadline_s: Annotated[
        Seconds,
        Flag(
            "--llm-deadline",
            "Wall time after which the rules do without its answer.",
            "SECONDS",
            needs=("llm",),
            group=ASSISTANT,
        ),
    ] = 3.0
    advisory_channel: Annotated[
        Literal["cockpit", "frequency"],
        Flag(
            "--advisory-channel",
            "Where crews and drivers hear advisories: cockpit (a loudspeaker of their own) or "
            "frequency (a call to them, which all hear, and which may collide).",
            "NAME",
            needs=("assistant",),
            group=ASSISTANT,
        ),
    ] = "cockpit"
    crews: Annotated[
        ResponseModelName | None,
        Flag(
            "--crews",
            "How crews, drivers and controllers respond to advisories and urgent calls: ideal (at "
            "once, always), icao (after 5 s, or 2.5 s if it changes, always) or observed (as "
            "was measured: some late, too slowly, the wrong way, or not at all).",
            "NAME",
            default="the scenario's, or icao",
            group=WORLD,
        ),
    ] = None
    topology: Annotated[
        Topology | None,
        Flag(
            "--topology",
            "parallel, asr_first (crews get the transcript) or gated_fusion (no advisory while "
            "something is left to fuse).",
            "NAME",
            default="the scenario's",
            group=RADIO,
        ),
    ] = None
    radar: Annotated[
        RadarKind | None,
        Flag(
            "--radar",
            "Add a surveillance radar: terminal (4.8 s a turn) or en_route (12 s).",
            "KIND",
            default="those of the scenario",
            group=WORLD,
        ),
    ] = None
    surface_surveillance: Annotated[
        bool,
        Flag(
            "--surface-surveillance",
            "Add radar and multilateration of the airport's surface; an assistant that reads their "
            "tracks has them anyway.",
            group=WORLD,
        ),
    ] = False
    cockpit: Annotated[
        bool, Flag("--cockpit", "Publish what the instruments of all aircraft show.", group=WORLD)
    ] = False
    equipment: Annotated[
        tuple[str, ...],
        Flag(
            "--equipment",
            "A decision engine in the world besides the assistant: tcas, conflict_alert, "
            "runway_status_lights. May be given again.",
            "NAME",
            default="that of the scenario",
            group=WORLD,
        ),
    ] = ()
    report: Annotated[
        bool,
        Flag(
            "--no-report",
            "Leave report.html out; `airhilt report RUN` writes it later.",
            in_sweeps=False,
        ),
    ] = True
    strict: Annotated[bool, Flag("--strict", "Stop when a worker is lost (exit code 3).")] = False

    @property
    def may_be_joined(self) -> bool:
        """True if programs of other processes can connect to the run."""
        asked = self.attach or self.seat or self.share_truth
        return bool(asked) or self.endpoint is not None or self.tls is not None

    @property
    def given_modalities(self) -> frozenset[str]:
        """Modalities that the assistant is given."""
        return frozenset(self.modalities.split("+"))

    @property
    def asks_for_detections(self) -> bool:
        """True if the assistant may be told what a detector finds in pictures."""
        has_both = self.detector != NONE and self.assistant != NONE
        return self.cameras and has_both and "vision" in self.given_modalities


def options_of(given: dict[str, Any]) -> Options:
    """Return the options that keywords of Python name.

    Raises
    ------
    TypeError
        There is no option of that name; the message gives the nearest.
    AirhiltError
        A value is not what the option takes.
    """
    known = list(Options.model_fields)
    for name in given:
        if name not in known:
            raise TypeError(f"no option named {name!r}{nearest(name, known)}")
    try:
        return Options(**given)
    except ValidationError as error:
        raise AirhiltError(f"option {all_problems(error)}") from None


def flag_of(field: FieldInfo) -> Flag | None:
    """Return how the command line spells an option, None if it does not."""
    return next((each for each in field.metadata if isinstance(each, Flag)), None)


def arguments_of(options: Options) -> list[str]:
    """Return the arguments by which the command line gives these options, without the defaults."""
    arguments: list[str] = []
    for name, field in Options.model_fields.items():
        flag, value = flag_of(field), getattr(options, name)
        if flag is None or value == field.default:
            continue
        if isinstance(value, bool):
            arguments.append(flag.name)
        else:
            for one in value if isinstance(value, tuple) else (value,):
                arguments.append(f"{flag.name}={one}")
    return arguments
