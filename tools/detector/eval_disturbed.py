"""Judge a detector on pictures under texture, noise, blur, compression and other light.

    pip install scikit-image
    airhilt dataset export --out data/test --images 1000 --seed 731 --airport LSZH ...
    python tools/detector/eval_disturbed.py data/test
    python tools/detector/eval_disturbed.py data/test --images 200 --json

Printed is for each disturbance how many airplanes from 20 pixels on are found, beside how many
of the same ones are found in the picture as it is, and false boxes on pictures where nobody is.
Airplanes are apart by their contrast in deviations of what the disturbance adds around them: what
stands out by less than two hardly anybody can see. Found is what `eval_detector.py` calls
``loose``: of the right class, with an overlap of three tenths. The photographs of grass, gravel
and brick (scikit-image) are in no training.

In the pictures as they are, the deviation is that of the picture itself around a body. That table
has two sizes.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageFilter
from rich.console import Console
from rich.progress import track
from rich.table import Table

from airhilt.assistant.vision.detector import Detector
from airhilt.engine_families import DETECTORS
from detector_data import Body, Picture, Shot, read_folder
from detector_disturbances import coded
from eval_detector import found_in, loosely, matched

AS_IT_IS = "as it is"
MARGIN_PX = 4
LEAST_PX, SMALLER_PX = 20.0, 12.0
APART = (4.0, 2.0, 0.0)
"""Least contrast of each group of bodies, in deviations."""
LEAST_DEVIATION = 0.5

Floats = npt.NDArray[np.float64]
Disturbance = Callable[[Floats, np.random.Generator], Floats]


def smooth(shape: tuple[int, int]) -> Floats:
    """Return a smooth random factor of a standard deviation of about 14 %, less 1."""
    draws = np.random.default_rng(0)
    rows, columns = shape
    total = np.zeros(shape)
    for cells in (20, 60, 160):
        coarse = draws.normal(128.0, 40.0, (cells, cells)).clip(0.0, 255.0).astype(np.uint8)
        total += np.asarray(
            Image.fromarray(coarse).resize((columns, rows), Image.Resampling.BICUBIC)
        )
        total -= 128.0
    return total / (3.0 * 128.0)


def photograph(name: str, shape: tuple[int, int]) -> Floats:
    """Return a photograph of a surface, of mean 0 and deviation 1."""
    import skimage  # Not at the top: it is for these pictures alone.

    rows, columns = shape
    side = 2 * max(512, columns, rows)
    path = Path(skimage.__file__).with_name("data") / f"{name}.png"
    with Image.open(path) as image:
        grey = image.convert("L").resize((side, side), Image.Resampling.BICUBIC)
    levels = np.asarray(grey, dtype=float)[:rows, :columns]
    return np.asarray((levels - levels.mean()) / levels.std())


def disturbances(shape: tuple[int, int]) -> dict[str, Disturbance]:
    """Return what is done to pictures of a shape, by name."""
    field = smooth(shape)
    surfaces = {name: 0.07 * photograph(name, shape) for name in ("grass", "gravel", "brick")}
    field *= 0.07 / field.std()

    def factor(of: Floats) -> Disturbance:
        return lambda levels, _: levels * (1.0 + of[..., None])

    def noise(deviation: float) -> Disturbance:
        return lambda levels, draws: levels + draws.normal(0.0, deviation, levels.shape)

    def jpeg(quality: int) -> Disturbance:
        return lambda levels, _: coded(levels.astype(np.uint8), quality).astype(float)

    def bent(gamma: float) -> Disturbance:
        return lambda levels, _: 255.0 * (levels / 255.0) ** gamma

    def blurred(levels: Floats, _: np.random.Generator) -> Floats:
        image = Image.fromarray(levels.astype(np.uint8))
        return np.asarray(image.filter(ImageFilter.GaussianBlur(1.0)), dtype=float)

    return {
        AS_IT_IS: lambda levels, _: levels,
        "texture 3.5 %": factor(0.5 * field),
        "texture 7 %": factor(field),
        **{f"{name} 7 %": factor(surface) for name, surface in surfaces.items()},
        **{f"noise {deviation:g} levels": noise(deviation) for deviation in (3.0, 6.0, 12.0)},
        "blur 1 px": blurred,
        "JPEG 50": jpeg(50),
        "JPEG 25": jpeg(25),
        "gamma 0.7": bent(0.7),
        "gamma 1.5": bent(1.5),
    }


@dataclass(frozen=True)
class Sight:
    """An airplane in a picture: its size, its contrast in deviations, and whether it is found."""

    shot: int
    body: int
    size_px: float
    apart: float
    found: bool


@dataclass(frozen=True)
class Outcome:
    """Result of a detector on all pictures under a disturbance."""

    sights: tuple[Sight, ...]
    false_in_empty: int


def around(body: Body, shape: tuple[int, int]) -> tuple[slice, slice]:
    """Return the part of a picture with a body and some pixels about it."""
    left, top, right, bottom = body.box
    rows = slice(max(int(top) - MARGIN_PX, 0), min(math.ceil(bottom) + MARGIN_PX, shape[0]))
    columns = slice(max(int(left) - MARGIN_PX, 0), min(math.ceil(right) + MARGIN_PX, shape[1]))
    return rows, columns


def judged(engine: Detector, shots: Sequence[Shot], name: str, disturb: Disturbance) -> Outcome:
    """Return what a detector makes of pictures under a disturbance."""
    sights: list[Sight] = []
    false = 0
    for index, shot in enumerate(
        track(shots, name, transient=True, disable=not sys.stderr.isatty())
    ):
        drawn = shot.picture()
        draws = np.random.default_rng((5, index))
        seen = disturb(drawn.astype(float), draws).clip(0.0, 255.0).astype(np.uint8)
        found = found_in(engine, shot, seen)
        hit, _ = matched(shot.bodies, found, loosely)
        if not shot.bodies:
            false += len(found)
        for number, body in enumerate(shot.bodies):
            if body.counts and body.label == 0 and body.size_px >= SMALLER_PX:
                deviation = deviation_of(shot, body, drawn, seen, name == AS_IT_IS)
                apart = body.contrast / max(deviation, LEAST_DEVIATION)
                sights.append(Sight(index, number, body.size_px, apart, number in hit))
    return Outcome(tuple(sights), false)


def deviation_of(shot: Shot, body: Body, drawn: Picture, seen: Picture, of_itself: bool) -> float:
    """Return how much a picture, or what disturbs it, deviates around a body, in levels."""
    near = around(body, (drawn.shape[0], drawn.shape[1]))
    if of_itself:
        apart = seen[near][~shot.masks()[near]]
    else:
        apart = (seen[near].astype(float) - drawn[near]).reshape(-1, 3)
    # As the contrast does, by the colour in which it is greatest.
    return float(apart.std(axis=0).max()) if len(apart) else 0.0


def groups(sights: Sequence[Sight]) -> list[list[Sight]]:
    """Return sights by their contrast in deviations, the clearest first."""
    edges = (math.inf, *APART)
    return [
        [each for each in sights if low <= each.apart < high]
        for high, low in zip(edges, APART, strict=False)
    ]


def share(sights: Sequence[Sight]) -> float | None:
    """Return the part that is found."""
    return round(sum(each.found for each in sights) / len(sights), 3) if sights else None


def table_of(outcomes: dict[str, Outcome]) -> list[dict[str, object]]:
    """Return a row for each disturbance."""
    before = {(each.shot, each.body): each for each in outcomes[AS_IT_IS].sights}
    rows: list[dict[str, object]] = []
    for name, outcome in outcomes.items():
        row: dict[str, object] = {"disturbance": name}
        large = [each for each in outcome.sights if each.size_px >= LEAST_PX]
        names = "all", "at least 4", "2 to 4", "under 2"
        for title, group in zip(names, (large, *groups(large)), strict=True):
            same = [before[each.shot, each.body] for each in group]
            row[title] = {"airplanes": len(group), "found": share(group), "as it is": share(same)}
        row["false on empty"] = outcome.false_in_empty
        rows.append(row)
    return rows


def own_table(outcome: Outcome) -> dict[str, dict[str, object]]:
    """Return what is found in pictures as they are, of at least four deviations, by size."""
    clear = [each for each in outcome.sights if each.apart >= APART[0]]
    sizes = {
        "12 to 20 px": [each for each in clear if each.size_px < LEAST_PX],
        "over 20 px": [each for each in clear if each.size_px >= LEAST_PX],
    }
    return {name: {"airplanes": len(of), "found": share(of)} for name, of in sizes.items()}


def printed(rows: Sequence[dict[str, object]], empty: int) -> Table:
    """Return the rows as a table."""
    table = Table(
        "disturbance", "all", "at least 4 deviations", "2 to 4", "under 2", f"false on {empty}"
    )
    for row in rows:
        cells = []
        for value in row.values():
            if isinstance(value, dict):
                found, same = (
                    "-" if value[key] is None else f"{value[key]:.2f}"
                    for key in ("found", "as it is")
                )
                cells.append(f"{found} ({same}) of {value['airplanes']}")
            else:
                cells.append(str(value))
        table.add_row(*cells)
    return table


def main() -> None:
    """Judge, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="DATA")
    parser.add_argument("--engine", default="embedded", help="as for airhilt cosim --detector")
    parser.add_argument("--images", type=int, help="look at the first ones only")
    parser.add_argument("--json", action="store_true", dest="as_json")
    given = parser.parse_args()
    engine = DETECTORS.create(given.engine)
    shots = [shot for folder in given.folders for shot in read_folder(folder)][: given.images]
    rows, columns = shots[0].picture().shape[:2]
    outcomes = {
        name: judged(engine, shots, name, disturb)
        for name, disturb in disturbances((rows, columns)).items()
    }
    empty = sum(not shot.bodies for shot in shots)
    table, own = table_of(outcomes), own_table(outcomes[AS_IT_IS])
    if given.as_json:
        print(
            json.dumps(
                {"pictures": len(shots), "empty": empty, "rows": table, "own": own}, indent=2
            )
        )
        return
    console = Console(width=120)
    console.print(printed(table, empty))
    console.print("Airplanes of at least 4 deviations in the pictures as they are:", own)


if __name__ == "__main__":
    main()
