"""A frequency is the name of a channel of 25 or 8.33 kHz."""

from __future__ import annotations

import pytest

from airhilt.errors import ScenarioError
from airhilt.scenario.vhf_channels import channel_spacing_khz


def test_the_channels_of_25_khz_are_named_by_their_frequency(subtests: pytest.Subtests) -> None:
    for name in [118_000, 118_025, 118_050, 118_075, 121_500, 136_975]:
        with subtests.test(str(name)):
            assert channel_spacing_khz(name) == 25.0


def test_the_channels_of_833_khz_are_named_5_10_and_15_above_those(
    subtests: pytest.Subtests,
) -> None:
    for name in [118_005, 118_010, 118_015, 118_030, 132_055, 136_990]:
        with subtests.test(str(name)):
            assert channel_spacing_khz(name) == pytest.approx(8.333, abs=1e-3)


def test_other_numbers_are_no_channel_and_the_error_names_one(subtests: pytest.Subtests) -> None:
    table = [(118_020, 118_015), (118_001, 118_000), (119_095, 119_090), (117_975, 118_000),
     (136_995, 136_990), (0, 118_000), (-5, 118_000), (243_000, 136_990)]  # fmt: skip
    for name, nearest in table:
        with (
            subtests.test(str((name, nearest))),
            pytest.raises(ScenarioError, match=rf"{name} kHz is no channel.* such as {nearest}"),
        ):
            channel_spacing_khz(name)


def test_there_are_four_names_in_each_25_khz() -> None:
    names = []
    for name in range(118_000, 118_100):
        try:
            channel_spacing_khz(name)
        except ScenarioError:
            continue
        names.append(name - 118_000)
    assert names == [0, 5, 10, 15, 25, 30, 35, 40, 50, 55, 60, 65, 75, 80, 85, 90]
