"""A torchvision that was built for another torch than the one that is installed."""

from __future__ import annotations


def mend_torchvision() -> None:
    """Give a torchvision that was built for another torch the one operator that is needed."""
    import torch

    try:
        import torchvision.ops

        torchvision.ops.nms(torch.zeros(0, 4), torch.zeros(0), 0.5)
    except (ImportError, RuntimeError):
        from ultralytics.utils.nms import TorchNMS

        _OPERATORS.append(library := torch.library.Library("torchvision", "DEF"))
        for name in ("nms", "qnms"):
            library.define(f"{name}(Tensor dets, Tensor scores, float iou_threshold) -> Tensor")
        library.impl("nms", TorchNMS.nms, "CPU")
        import torchvision.extension

        torchvision.extension._has_ops = lambda: True


_OPERATORS: list[object] = []
"""Kept, because they go when their library does."""
