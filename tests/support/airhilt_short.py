"""The command `airhilt`, with scenarios short enough to run every example of the documentation.

    python airhilt_short.py FOLDER cosim --scenario s02a_headon

The scenarios are those of a folder that `shorten` has made. Only runs are short: a picture is drawn
at the time that the example gives.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from airhilt.cli import main
from airhilt.host import library
from shortened import shortened

LONGEST_S, LONGEST_WITH_CAMERAS_S = 12.0, 1.0


def shorten(folder: Path) -> None:
    """Write the scenarios that ship, shortened, to a folder: with cameras and without."""
    for name in library.names("scenarios"):
        document = json.loads(library.find("scenarios", name).read_text(encoding="utf-8"))
        document["end_when"] = []
        for kind, longest_s, cameras in (
            ("seen", LONGEST_WITH_CAMERAS_S, document.get("cameras", [])),
            ("unseen", LONGEST_S, []),
        ):
            short = shortened(document, min(document["duration_s"], longest_s))
            short["cameras"] = cameras
            if kind == "seen":  # times that are drawn would be before the start
                short["perturbations"] = []
            path = folder / kind / f"{name}.json"
            path.parent.mkdir(exist_ok=True)
            path.write_text(json.dumps(short), encoding="utf-8")


def use(scenarios: Path) -> None:
    """Let AIRHILT find its scenarios in another folder."""
    shipped = library.folder
    library.folder = lambda kind: scenarios if kind == "scenarios" else shipped(kind)


def use_for(arguments: list[str], folder: Path) -> None:
    """Let a command that runs scenarios find those that `shorten` has written to a folder."""
    if arguments[:1] in (["cosim"], ["sweep"], ["evaluate"]):
        with_cameras = {"--video", "--detector"} & set(arguments)
        use(folder / ("seen" if with_cameras else "unseen"))


if __name__ == "__main__":
    chosen = Path(sys.argv.pop(1))
    use_for(sys.argv[1:], chosen)
    main()
