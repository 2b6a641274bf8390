"""Surfaces vary about their colours, and clouds cover the sky, as much as a scenario says."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from airhilt import load
from airhilt.imaging.view import Intrinsics, Pose, View
from airhilt.sensors.cameras.renderers import open_renderer
from airhilt.sensors.cameras.scene.builder import light_of
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.landscape import airport_landscape
from airhilt.sensors.cameras.scene.textures import SIDE, Places, factors, tiles
from airhilt.shapes.material import Material
from airhilt.shapes.mesh import Mesh
from airhilt.world.site import ScenarioSite
from airhilt.world.surface.layout import load_layout
from breadth import examples

CLEAR = Illumination(np.array((0.3, 0.2, 0.93)), visibility_m=60_000.0, overcast=0.0)
LENS = Intrinsics(160, 90, 1.0)
OVER_GROUND = View(LENS, Pose.of((0.0, 0.0, 60.0), 0.0, -0.8))
INTO_THE_SKY = View(LENS, Pose.of((0.0, 0.0, 60.0), 0.0, 0.6))


def ground(material: Material) -> Mesh:
    far = 60_000.0
    square = ((-far, -far, 0.0), (far, -far, 0.0), (far, far, 0.0), (-far, far, 0.0))
    return Mesh.of(square, ((0, 1, 2), (0, 2, 3)), (0.2, 0.2, 0.2)).made_of(material)


def picture(material: Material, light: Illumination, view: View) -> npt.NDArray[np.float64]:
    _, renderer = open_renderer("embree", ground(material), {}, light)
    return renderer.landscape(view, view.whole).colour.astype(float)


@pytest.mark.parametrize("material", [each for each in Material if each is not Material.DECK])
def test_a_surface_varies_about_its_colour_and_keeps_it(material: Material) -> None:
    flat, half, full = (
        picture(material, replace(CLEAR, texture=texture), OVER_GROUND)
        for texture in (0.0, 0.5, 1.0)
    )
    assert flat.std(axis=(0, 1)).max() < 1.0
    spread = [each.std(axis=(0, 1)).mean() for each in (flat, half, full)]
    assert spread[0] < spread[1] < spread[2]
    assert full.mean() == pytest.approx(flat.mean(), rel=0.06)


def test_a_scenario_has_textures_clouds_and_lenses_unless_it_says_otherwise() -> None:
    scenario = load("s01b_nominal")
    light = light_of(scenario, ScenarioSite.of(scenario))
    assert light.texture == 1.0
    assert light.clouds > 0.0
    assert all(camera.imaging.blur_px > 0.0 for camera in scenario.cameras)


def test_a_texture_is_the_same_in_every_process() -> None:
    made = "b''.join(tile.table.tobytes() for tile in tiles())"
    code = (
        "import hashlib; from airhilt.sensors.cameras.scene.textures import tiles; "
        f"print(hashlib.sha256({made}).hexdigest())"
    )
    told = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    here = hashlib.sha256(b"".join(tile.table.tobytes() for tile in tiles())).hexdigest()
    assert told.stdout.strip() == here


@examples(60)
@given(
    east=st.floats(-20_000.0, 20_000.0),
    north=st.floats(-20_000.0, 20_000.0),
    material=st.sampled_from(Material),
)
def test_a_place_is_as_bright_from_afar_as_its_surroundings_on_average(
    east: float, north: float, material: Material
) -> None:
    across = np.arange(64) - 31.5
    columns, rows = (each.ravel().astype(np.float32) for each in np.meshgrid(across, across))
    kind = np.full(columns.shape, material, dtype=np.int32)
    near = factors(Places(kind, columns + np.float32(round(east / 64.0) * 64.0 + 32.0),
                          rows + np.float32(round(north / 64.0) * 64.0 + 32.0),
                          np.full(columns.shape, 1.0, dtype=np.float32)))  # fmt: skip
    from_afar = factors(
        Places(
            kind[:1],
            np.array([round(east / 64.0) * 64.0 + 32.0], dtype=np.float32),
            np.array([round(north / 64.0) * 64.0 + 32.0], dtype=np.float32),
            np.array([64.0], dtype=np.float32),
        )
    )
    assert from_afar[0] == pytest.approx(near.mean(), abs=0.02)


def test_from_very_far_nothing_varies() -> None:
    places = np.linspace(-1e6, 1e6, 50, dtype=np.float32)
    kind = np.full(50, Material.GRASS, dtype=np.int32)
    size = np.full(50, 64.0 * SIDE, dtype=np.float32)
    assert factors(Places(kind, places, places, size)) == pytest.approx(np.ones(50), abs=1e-3)


def test_more_cover_hides_more_of_the_blue_and_none_hides_nothing() -> None:
    blue, some, much = (
        picture(Material.GRASS, replace(CLEAR, clouds=cover), INTO_THE_SKY)
        for cover in (0.0, 0.3, 0.9)
    )
    changed = [(np.abs(cloudy - blue).max(axis=2) > 3.0).mean() for cloudy in (some, much)]
    assert 0.05 < changed[0] < changed[1]
    overcast = replace(CLEAR, overcast=1.0)
    assert np.array_equal(
        picture(Material.GRASS, replace(overcast, clouds=0.9), INTO_THE_SKY),
        picture(Material.GRASS, overcast, INTO_THE_SKY),
    )


def test_few_specks_of_thin_cloud_stand_alone() -> None:
    """A flatter spectrum, of 2.5, gives 1700 of them."""
    thick = tiles()[2].finest[Material.DECK]
    parts, _ = ndimage.label(thick > np.quantile(thick, 0.75))
    assert (np.bincount(parts.ravel())[1:] <= 9).sum() < 100


def test_rain_makes_pavements_darker_and_nothing_else() -> None:
    layout = load_layout("KDCA")
    dry, wet = (airport_landscape(layout, replace(CLEAR, wet=each)).mesh for each in (False, True))
    paved = np.isin(dry.material, (Material.ASPHALT, Material.CONCRETE))
    assert 0 < paved.sum() < len(dry)
    assert np.allclose(wet.colours[paved], 0.6 * dry.colours[paved])
    assert np.array_equal(wet.colours[~paved], dry.colours[~paved])
