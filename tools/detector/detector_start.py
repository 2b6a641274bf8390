"""Go on from exported networks: their weights, and normalisations that change nothing at first."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import onnx
import torch
from onnx import numpy_helper
from torch import Tensor, nn


def begin_with(network: nn.Module, path: Path) -> dict[str, Tensor]:
    """Take the weights of an exported network of the same widths, and return those without a place.

    The exporter folds normalisations into the convolutions before them; these are as if they did
    nothing, until `measure` has been called.
    """
    graph = onnx.load(path).graph
    weights = {
        each.name: torch.from_numpy(numpy_helper.to_array(each).copy())
        for each in graph.initializer
    }
    own = network.state_dict()
    folded = [
        [weights.pop(name) for name in node.input[1:]]
        for node in graph.node
        if node.op_type == "Conv" and not node.input[1].startswith("network.")
    ]
    named = {name.removeprefix("network."): weight for name, weight in weights.items()}
    for name, module in network.named_modules():
        if isinstance(module, nn.Linear) and f"{name}.weight" not in named:
            raise SystemExit(f"{path}: no weights named 'network.{name}.weight'")
    for name in named.keys() & own.keys():
        own[name].copy_(named.pop(name))
    convolutions = [
        module
        for module in network.modules()
        if isinstance(module, nn.Sequential) and isinstance(module[0], nn.Conv2d)
    ]
    with torch.no_grad():
        for norm in _norms(network):
            norm.running_mean.zero_()
            norm.running_var.fill_(1.0 - norm.eps)
        if len(folded) > len(convolutions):
            (named["first"],) = folded.pop(0)
        for module, (weight, bias) in zip(convolutions, folded, strict=True):
            module[0].weight.copy_(weight)
            module[1].bias.copy_(bias)
    return named


def measure(network: nn.Module, batches: Iterable[tuple[Tensor, ...]]) -> None:
    """Give normalisations the means and variances of some batches; the network does as before."""
    seen: dict[nn.BatchNorm2d, list[Tensor]] = {norm: [] for norm in _norms(network)}

    def note(norm: nn.Module, given: tuple[Tensor, ...]) -> None:
        assert isinstance(norm, nn.BatchNorm2d)
        flat = given[0].transpose(0, 1).flatten(1)
        seen[norm].append(torch.stack((flat.mean(1), (flat * flat).mean(1))))

    hooks = [norm.register_forward_pre_hook(note) for norm in seen]
    network.eval()
    with torch.no_grad():
        for batch in batches:
            network(*batch)
        for norm, noted in seen.items():
            mean, square = torch.stack(noted).mean(0)
            variance = (square - mean * mean).clamp(min=1e-4)
            assert norm.running_mean is not None
            assert norm.running_var is not None
            deviation = (norm.running_var + norm.eps).sqrt()
            norm.bias += norm.weight * (mean - norm.running_mean) / deviation
            norm.weight *= (variance + norm.eps).sqrt() / deviation
            norm.running_mean.copy_(mean)
            norm.running_var.copy_(variance)
    for hook in hooks:
        hook.remove()


def _norms(network: nn.Module) -> list[nn.BatchNorm2d]:
    return [each for each in network.modules() if isinstance(each, nn.BatchNorm2d)]
