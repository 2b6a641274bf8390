"""Points of a box of parameters: Latin hypercube and Sobol sampling, by scipy.stats.qmc."""

from __future__ import annotations

from collections.abc import Iterator

from airhilt.sweep.specification import Sample


def points(sample: Sample) -> Iterator[dict[str, float]]:
    """Yield the points of a sample: a value of each parameter, by its path.

    The same sample gives the same points, and a longer Sobol sequence begins with the shorter one.
    """
    from scipy.stats import qmc

    size = len(sample.intervals)
    if sample.method == "sobol":
        bits = max(sample.count - 1, 1).bit_length()
        shares = qmc.Sobol(size, rng=sample.seed).random_base2(bits)[: sample.count]
    else:
        shares = qmc.LatinHypercube(size, rng=sample.seed).random(sample.count)
    for row in shares:
        yield {
            path: interval.at(float(share))
            for (path, interval), share in zip(sample.intervals.items(), row, strict=True)
        }
