"""The examples of README, the first page and the tutorials are run as they stand, in short runs."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import chain
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

from airhilt.bus import free_endpoint
from airhilt.host import library
from airhilt_short import shorten, use_for
from breadth import mostly_slow
from paths import DOCS, ROOT, SUPPORT
from sweep_tables import grid, write_sweep

PAGES = (ROOT / "README.md", *sorted(DOCS.glob("*.md")))
TUTORIALS = (DOCS / "getting-started.md", *sorted(DOCS.glob("tutorial-*.md")))
RUN_PAGES = (ROOT / "README.md", DOCS / "README.md", *TUTORIALS)
RUN_COMMANDS = ("airhilt", "for", "python", "pip install ./")
SAVED = re.compile(r"\b[Ss]ave (?:it|this) as\s+`([^`]+)`[^`]*?\n+```\w+\n(.*?)```", re.DOTALL)
"""A file that a page lets its reader write: its name, and its text."""
LONGEST_S = 300.0
Cli = Callable[..., subprocess.CompletedProcess[str]]
RunBlocks = Callable[[Iterable[Sequence[str]]], None]


@dataclass(frozen=True)
class Example:
    """A block of code of a page."""

    page: Path
    line: int
    language: str
    text: str

    def __str__(self) -> str:
        return f"{self.page.name}:{self.line}"


def examples(page: Path) -> Iterator[Example]:
    """Yield the blocks of code of a page: fenced and indented ones."""
    for token in MarkdownIt().parse(page.read_text(encoding="utf-8")):
        if token.type in ("fence", "code_block"):
            begin, _ = token.map or (0, 0)
            yield Example(page, begin + 1, token.info, token.content)


def commands(example: Example) -> list[str]:
    """Return the commands of a block that can be run here, without the remarks beside them."""
    text = re.sub(r"\\\n\s*", "", "" if example.language else example.text)
    text = re.sub(r"(?m)(?<=\S)( {3,}| +#).*$", "", text)
    text = re.sub(r"(?ms)^for .*?^done", in_one_line, text)
    return [line for line in text.split("\n") if line.startswith(RUN_COMMANDS)]


def in_one_line(loop: re.Match[str]) -> str:
    """Return a loop of the shell in one line."""
    return re.sub(r"\n\s*", "; ", loop[0]).replace("do; ", "do ")


def is_possible(command: str) -> bool:
    """Tell whether what a command needs besides the plain install is there."""
    needed = {"--video": "av", "--renderer moderngl": "moderngl", "--renderer open3d": "open3d"}
    return all(find_spec(package) for option, package in needed.items() if option in command)


EXAMPLES = [example for page in PAGES for example in examples(page)]
CLUSTERS = ("from dask_jobqueue", "from dask_kubernetes")
PYTHON = [
    one
    for one in EXAMPLES
    if one.language == "python"
    and not any(package in one.text for package in CLUSTERS)
    and one.text not in dict(SAVED.findall(one.page.read_text(encoding="utf-8"))).values()
]
"""Examples in Python; the recipe for SLURM has a test of its own, marked ``slurm``, and files that
a reader writes are run with the commands of their page."""
CHEAP_PYTHON = [one for one in PYTHON if not re.search(r"read_sweep\(|snapshot\(", one.text)]
"""Examples that neither read tables nor draw a picture."""


@pytest.fixture(scope="session")
def short_scenarios(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("scenarios")
    shorten(folder)
    return folder


@pytest.fixture
def environment(tmp_path: Path, short_scenarios: Path) -> dict[str, str]:
    """Programs by the names that a reader's terminal has for them, in an empty folder."""
    programs = tmp_path / "programs"
    programs.mkdir()
    short = f"{SUPPORT / 'airhilt_short.py'} {short_scenarios}"
    for name, call in {
        "airhilt": f'exec "{sys.executable}" {short} "$@"',
        "python": f'exec "{sys.executable}" "$@"',
        "interrupted": f'exec "{sys.executable}" "{SUPPORT / "interrupted.py"}" "$@"',
        "seq": "echo 1 2",
    }.items():
        path = programs / name
        path.write_text(f"#!/bin/sh\n{call}\n")
        path.chmod(0o755)
    work = tmp_path / "work"
    work.mkdir()
    shutil.copy(short_scenarios / "unseen" / "s02a_headon.json", work / "my_scenario.json")
    (work / "examples").symlink_to(ROOT / "examples")
    return os.environ | {
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "PWD": str(work),
    }


def run(script: str, environment: dict[str, str]) -> str:
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script],
        cwd=environment["PWD"], env=environment, capture_output=True, text=True, timeout=LONGEST_S,
    )  # fmt: skip
    assert done.returncode == 0, f"{script}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def as_run(command: str, endpoint: str, work: Path) -> str:
    """Return a command as it is run here: its own run folders and port, and few pictures.

    An evaluation tries a run of each kind. The page of a run folder is served until Ctrl+C, and
    interrupted; a run with a page goes faster than the clock on the wall.
    """
    command = re.sub(r"tcp/127\.0\.0\.1:\d+", endpoint, command)
    command = re.sub(r"--images \d+", "--images 2", command)
    command = command.replace(" --wait-for-seats", "")
    if command.startswith("airhilt sweep"):
        command = command.replace("'s01a_*'", "s02a_headon").replace("0:20:5", "5")
        command = command.replace("0,10,20", "5").replace("0,5,10", "5")
        command = command.replace("1000,2000,5000", "1000").replace(" --no-cameras", "")
        fewer = "" if "--visibility" in command else " --no-cameras"
        fewer += "" if "--asr" in command else " --no-speech"
        command = re.sub(r"--seeds \d+", f"--seeds 1{fewer}", command)
    if command.startswith("airhilt evaluate"):
        command += " --dry-run"
    command = re.sub(r"runs/(\w+-0-)\.\.\.", lambda run: newest_run(work, run[1]), command)
    command = re.sub(r"\bRUN\b", lambda _: newest_run(work), command)
    if re.search(r"airhilt view|airhilt station|--view|--seat", command):
        command += " --no-browser --port 0"
    if command.startswith(("airhilt view", "airhilt station")):
        command = f"interrupted {command}"
    elif re.search(r"--view|--seat", command):
        command += " --pace 4x"
    return f"{command} &" if "--attach" in command else command


def blocks_of(page: Path) -> list[list[str]]:
    """Return the commands of each block of a page."""
    return [commands(example) for example in EXAMPLES if example.page == page]


def first_run(page: Path) -> str:
    """Return the first command of a page that runs a scenario."""
    every = chain.from_iterable(blocks_of(page))
    return next(command for command in every if command.startswith("airhilt cosim"))


def newest_run(work: Path, begin: str = "") -> str:
    """Return the newest run folder whose name begins so."""
    folders = work.glob(f"runs/{begin}*/")
    return str(max(folders, key=lambda folder: folder.stat().st_mtime).relative_to(work))


def install(project: Path, environment: dict[str, str], patch: pytest.MonkeyPatch) -> None:
    """Install a project of one module, by its name and entry points, as pip would."""
    declared = tomllib.loads((project / "pyproject.toml").read_text())["project"]
    metadata = project / f"{declared['name']}-{declared['version']}.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: {declared['name']}\nVersion: {declared['version']}\n"
    )
    points = [
        f"[{group}]\n" + "".join(f"{name} = {place}\n" for name, place in members.items())
        for group, members in declared["entry-points"].items()
    ]
    (metadata / "entry_points.txt").write_text("".join(points))
    patch.syspath_prepend(project)
    environment["PYTHONPATH"] += f"{os.pathsep}{project}"
    patch.setenv("PYTHONPATH", environment["PYTHONPATH"])


@pytest.fixture
def run_blocks(
    environment: dict[str, str], short_scenarios: Path,
    airhilt_command: Cli, monkeypatch: pytest.MonkeyPatch,
) -> RunBlocks:  # fmt: skip
    """Runs commands, each list of them with a port of its own.

    A terminal does what needs one: programs beside a run, pages, Ctrl+C, loops.
    """
    work = Path(environment["PWD"])
    monkeypatch.chdir(work)

    def run_all(blocks: Iterable[Sequence[str]]) -> None:
        begun = list[str]()
        for block in blocks:
            endpoint = free_endpoint()
            for command in filter(is_possible, block):
                given = as_run(command, endpoint, work)
                if given.startswith("pip install"):
                    install(work / given.rpartition("/")[2], environment, monkeypatch)
                elif given.endswith("&"):
                    begun.append(given)
                elif begun or not given.startswith("airhilt") or "--no-browser" in given:
                    run("\n".join([*begun, given, "wait"]), environment)
                    begun.clear()
                else:
                    arguments = shlex.split(given)[1:]
                    with monkeypatch.context() as patch:
                        patch.setattr(library, "folder", library.folder)
                        use_for(arguments, short_scenarios)
                        done = airhilt_command(*arguments)
                    assert done.returncode == 0, f"{given}\n{done.stdout}\n{done.stderr}"

    return run_all


def test_the_first_run_of_the_readme_can_be_run(run_blocks: RunBlocks) -> None:
    run_blocks([[first_run(ROOT / "README.md")]])


@pytest.mark.slow
@pytest.mark.parametrize("page", RUN_PAGES, ids=lambda page: page.name)
def test_the_commands_of_a_page_can_be_run(page: Path, run_blocks: RunBlocks) -> None:
    write_files(page, Path.cwd())
    run_blocks(blocks_of(page))


def write_files(page: Path, work: Path) -> None:
    """Write the files that a page lets its reader write."""
    for name, text in SAVED.findall(page.read_text(encoding="utf-8")):
        (work / name).parent.mkdir(exist_ok=True)
        (work / name).write_text(text)


@pytest.fixture(scope="session")
def sweep_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep that the pages can read; it never ran."""
    out = tmp_path_factory.mktemp("sweeps") / "s01a"
    return write_sweep(out, grid(["s01a_bad_readback"], ["reference", "none"], seeds=2))


@pytest.mark.parametrize("example", mostly_slow(PYTHON, *CHEAP_PYTHON), ids=str)
def test_the_python_of_a_page_can_be_run(
    example: Example,
    environment: dict[str, str],
    short_scenarios: Path,
    request: pytest.FixtureRequest,
) -> None:
    work = Path(environment["PWD"])
    for name in set(re.findall(r"sweeps/(\w+)", example.text)):
        shutil.copytree(request.getfixturevalue("sweep_folder"), work / "sweeps" / name)
    (work / "example.py").write_text(example.text)
    (work / "launch.py").write_text(
        f"import runpy, sys\nsys.path.append({str(SUPPORT)!r})\n"
        f"import airhilt_short\nfrom pathlib import Path\n"
        f"airhilt_short.use(Path({str(short_scenarios / 'unseen')!r}))\n"
        "runpy.run_path('example.py')\n"
    )
    run("python launch.py", environment)
