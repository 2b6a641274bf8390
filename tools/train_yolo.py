"""Fine-tunes a YOLO model of ultralytics on pictures of AIRHILT.

    airhilt dataset export --out data --images 10000 --format yolo
    python tools/train_yolo.py data --model yolo11n.pt --epochs 50 --out mine
    airhilt cosim s01b_nominal --detector mine/mine.onnx

The folder ``mine`` then holds ``mine.pt`` and ``mine.onnx``, with the names of the classes in them.
ultralytics is under the AGPL (docs/vision.md): ``pip install 'airhilt[yolo]'``.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from pathlib import Path

from airhilt.assistant.vision.detectors.yolo import ENVIRONMENT


def main(arguments: list[str] | None = None) -> None:
    """Train and export."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", type=Path, help="what `airhilt dataset export` has written")
    parser.add_argument("--model", required=True, help="weights, .pt, or a model's .yaml")
    parser.add_argument("--out", type=Path, required=True, help="a new folder")
    parser.add_argument("--epochs", type=int, default=50)
    parser.add_argument("--side", type=int, default=640, help="side of the pictures, in pixels")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--device", default="cpu", help="as torch names it, such as 0")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args(arguments)
    out = given.out.resolve()
    if problem := _problem(given.folder, out):
        parser.error(problem)
    os.environ.update(ENVIRONMENT)
    try:
        from ultralytics import YOLO
    except ImportError:
        parser.error("the package ultralytics is missing; install it: pip install 'airhilt[yolo]'")
    model = YOLO(given.model)
    model.train(
        data=str((given.folder / "data.yaml").resolve()),
        epochs=given.epochs,
        imgsz=given.side,
        batch=given.batch,
        device=given.device,
        seed=given.seed,
        project=str(out),
        name="training",
        amp=False,
        plots=False,
        workers=0,
    )
    weights = out / f"{out.name}.pt"
    shutil.copy(out / "training" / "weights" / "best.pt", weights)
    YOLO(weights).export(format="onnx", dynamic=True, simplify=False)
    print(weights.with_suffix(".onnx"))


def _problem(folder: Path, out: Path) -> str:
    """Return what is wrong with the folders; empty if nothing is."""
    if out.exists():
        return f"{out} is there already; expected a new folder: choose another --out"
    if not (folder / "data.yaml").is_file():
        return (
            f"{folder} has no data.yaml; expected what `airhilt dataset export --format yolo` wrote"
        )
    for split in ("train", "val"):
        if not (folder / f"{split}.txt").read_text():
            return f"{folder}: no pictures for {split}; expected an export of 100 pictures or more"
    return ""


if __name__ == "__main__":
    main(sys.argv[1:])
