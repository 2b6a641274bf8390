"""Draw textured pictures of airplanes by another renderer, to judge a detector on.

    pip install panda3d scikit-image
    python tools/detector/foreign_pictures.py --out data/foreign --images 300
    python tools/detector/eval_disturbed.py data/foreign

Nothing in the pictures is AIRHILT's: shapes are lofted here, Panda3D draws and lights them, ground
and walls
are photographs of surfaces (scikit-image). No detector may learn from it. Files are those that
``airhilt dataset export`` writes, so the same tools judge both. A third of the pictures is empty.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import skimage
from direct.showbase.ShowBase import ShowBase
from panda3d import core
from PIL import Image, ImageDraw, ImageFilter
from rich.progress import track

from airhilt.sensors.cameras.dataset.records import run_lengths

COLUMNS, ROWS = 640, 360
EMPTY = 1.0 / 3.0
SIZES_PX = (10.0, 220.0)
"""Sizes that airplanes are placed for; logarithms are drawn alike often."""
CONFIGURATION = """
window-type offscreen
load-display p3headlessgl
audio-library-name null
sync-video false
notify-level error
"""

Floats = npt.NDArray[np.float64]
Triangles = npt.NDArray[np.int64]
Draws = np.random.Generator


# --- shapes -------------------------------------------------------------------------------


@dataclass(frozen=True)
class Design:
    """An airplane: x goes forward from its middle, y to the left, z up, all in m.

    Attributes
    ----------
    wing, tail
        Half span, chords at root and tip, how far the tip is behind the root, and x and z of the
        root's middle.
    engines
        Places of nacelles of a half (x, y, z), and length and radius of each.
    """

    length: float
    radius: float
    wing: tuple[float, float, float, float, float, float]
    tail: tuple[float, float, float, float, float, float]
    fin_height: float
    engines: tuple[tuple[float, float, float], ...]
    nacelle: tuple[float, float]
    propeller: bool


DESIGNS = (
    Design(38, 1.95, (17.5, 7, 1.6, 7.5, 1, -0.9), (7, 4, 1.4, 3.2, -16, 0.8), 6.5,
           ((3.5, 5.6, -2.0),), (4.2, 1.05), False),
    Design(68, 3.0, (31, 14, 2.4, 16, 1, -1.4), (11, 7, 2.2, 6, -29, 1.0), 10.0,
           ((5.0, 10.5, -3.0), (-2.0, 20.0, -2.4)), (5.6, 1.5), False),
    Design(30, 1.4, (11.5, 5, 1.4, 4.5, -1, -0.9), (4.6, 2.6, 1.2, 1.8, -13.4, 4.6), 5.0,
           ((-8.5, 2.3, 0.6),), (3.6, 0.75), False),
    Design(23, 1.4, (13.5, 2.8, 1.5, 0.4, 0.6, 1.5), (4.2, 2.0, 1.1, 0.7, -10.4, 4.4), 4.8,
           ((2.6, 4.1, 1.1),), (4.4, 0.6), True),
    Design(8.2, 0.62, (5.5, 1.6, 1.1, 0.15, 0.8, 0.75), (1.75, 1.1, 0.7, 0.3, -3.6, 0.15), 1.5,
           (), (0.0, 0.0), True),
    Design(8.6, 0.6, (5.3, 1.7, 1.1, 0.3, 0.4, -0.45), (1.8, 1.1, 0.7, 0.4, -3.8, 0.2), 1.5,
           ((1.6, 1.9, -0.2),), (1.9, 0.35), True),
)  # fmt: skip


WHEELS = np.full(3, 0.15)
NUMBER_LEVELS = 60
NAMING = core.BitMask32.bit(1)
"""Mask of the camera that names airplanes: it sees all but propellers."""


def mesh(places: Floats, triangles: Any, shades: Floats, uvs: Floats | None = None) -> Any:
    """Return a node of triangles with smooth normals; all vertices have a colour, from 0 to 1."""
    triangles = np.asarray(triangles, dtype=np.uint32)
    corners = places[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(places)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], faces)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True).clip(1e-9)
    if uvs is None:
        uvs = np.zeros((len(places), 2))
    layout = core.GeomVertexArrayFormat()
    layout.add_column("vertex", 3, core.Geom.NT_float32, core.Geom.C_point)
    layout.add_column("normal", 3, core.Geom.NT_float32, core.Geom.C_normal)
    layout.add_column("color", 4, core.Geom.NT_float32, core.Geom.C_color)
    layout.add_column("texcoord", 2, core.Geom.NT_float32, core.Geom.C_texcoord)
    known = core.GeomVertexFormat.register_format(core.GeomVertexFormat(layout))
    data = core.GeomVertexData("mesh", known, core.Geom.UH_static)
    data.unclean_set_num_rows(len(places))
    colours = np.column_stack((shades, np.ones(len(places))))
    rows = np.hstack((places, normals, colours, uvs)).astype(np.float32)
    data.modify_array_handle(0).copy_data_from(np.ascontiguousarray(rows))
    drawn = core.GeomTriangles(core.Geom.UH_static)
    drawn.set_index_type(core.Geom.NT_uint32)
    indices = drawn.modify_vertices()
    indices.unclean_set_num_rows(triangles.size)
    indices.modify_handle().copy_data_from(np.ascontiguousarray(triangles.ravel()))
    drawn.close_primitive()
    geometry = core.Geom(data)
    geometry.add_primitive(drawn)
    node = core.GeomNode("mesh")
    node.add_geom(geometry)
    return node


def tube(sections: Floats, around: int = 20) -> tuple[Floats, Triangles, Floats]:
    """Return the skin of sections (x, y, z of the middle, half width, half height)."""
    angle = np.linspace(0.0, 2.0 * math.pi, around + 1)
    places, uvs = [], []
    for index, (x, y, z, wide, high) in enumerate(sections):
        ring = np.column_stack(
            (np.full(around + 1, x), y + wide * np.cos(angle), z + high * np.sin(angle))
        )
        places.append(ring)
        uvs.append(np.column_stack((np.full(around + 1, index / (len(sections) - 1)),
                                    angle / (2.0 * math.pi))))  # fmt: skip
    skin = outward(np.concatenate(places), grid(len(sections), around + 1))
    return *skin, np.concatenate(uvs)


def outward(places: Floats, triangles: Triangles) -> tuple[Floats, Triangles]:
    """Return a closed shape whose triangles all turn the way that lights it from outside."""
    corners = places[triangles] - places.mean(axis=0)
    volume = np.linalg.det(corners).sum()
    return places, triangles if volume > 0.0 else triangles[:, ::-1]


def fuselage(design: Design) -> Floats:
    """Return the sections of a body that is round in front and lifts its tail."""
    along = np.concatenate((np.linspace(0.0, 0.14, 8), np.linspace(0.2, 0.62, 6),
                            np.linspace(0.68, 1.0, 8)))  # fmt: skip
    front = np.sqrt(np.clip(1.0 - (1.0 - np.minimum(along / 0.14, 1.0)) ** 2, 0.0, 1.0))
    back = 1.0 - 0.88 * np.clip((along - 0.62) / 0.38, 0.0, 1.0) ** 1.6
    radius = design.radius * np.minimum(front, back)
    lift = design.radius * 0.75 * np.clip((along - 0.62) / 0.38, 0.0, 1.0) ** 1.6
    lift -= 0.25 * design.radius * (1.0 - np.minimum(along / 0.14, 1.0)) ** 2
    x = (0.5 - along) * design.length
    return np.column_stack((x, np.zeros_like(x), lift, radius, radius * 1.04))


def panel(
    half_span: float, root: float, tip: float, behind: float, place: tuple[float, float, float],
    up: tuple[float, float], thickness: float = 0.11,
) -> tuple[Floats, Triangles]:  # fmt: skip
    """Return a wing half: ``up`` is the direction of its span in the plane of y and z."""
    profile = np.array([(0.5, 0.0), (0.35, 0.45), (0.05, 0.5), (-0.5, 0.02),
                        (0.05, -0.3), (0.35, -0.35)])  # fmt: skip
    places = []
    for share in (0.0, 1.0):
        chord = root + (tip - root) * share
        x = place[0] - behind * share + profile[:, 0] * chord
        off = profile[:, 1] * chord * thickness
        y = place[1] + half_span * share * up[0] - off * up[1]
        z = place[2] + half_span * share * up[1] + off * abs(up[0])
        places.append(np.column_stack((x, y, z)))
    count = len(profile)
    step = np.arange(count)
    other = (step + 1) % count
    triangles = np.vstack((
        np.column_stack((step, step + count, other)),
        np.column_stack((other, step + count, other + count)),
        np.column_stack((np.full(count, count), other + count, step + count)),
    ))  # fmt: skip
    return outward(np.concatenate(places), triangles)


def airplane(design: Design, draws: Draws) -> Any:
    """Return the node path of an airplane in colours of chance."""
    whole = core.NodePath("airplane")
    body = draws.choice([0.93, 0.85, 0.75, 0.5]) * np.ones(3)
    if draws.random() < 0.3:
        body = draws.uniform(0.2, 0.95, 3)
    accent, metal = draws.uniform(0.1, 0.9, 3), np.full(3, draws.uniform(0.55, 0.85))
    places, triangles, uvs = tube(fuselage(design))
    skin = whole.attach_new_node(mesh(places, triangles, np.ones_like(places), uvs))
    skin.set_texture(livery(design, body, accent, draws))

    def add(part: tuple[Any, ...], colour: Floats) -> None:
        whole.attach_new_node(mesh(part[0], part[1], np.tile(colour, (len(part[0]), 1))))

    half, root, tip, behind, x, z = design.wing
    stance = math.radians(draws.uniform(2.0, 7.0))
    for side in (1.0, -1.0):
        up = side * math.cos(stance), math.sin(stance)
        add(panel(half, root, tip, behind, (x, 0.0, z), up), metal if design.length > 10 else body)
        span, near, far, swept, tail_x, tail_z = design.tail
        add(panel(span, near, far, swept, (tail_x, 0.0, tail_z), (side, 0.1), 0.09), metal)
        for engine_x, engine_y, engine_z in design.engines:
            long, radius = design.nacelle
            along = np.linspace(0.0, 1.0, 7)
            girth = radius * np.array([0.85, 1.0, 1.0, 0.97, 0.85, 0.7, 0.5])
            sections = np.column_stack((engine_x + long * (0.5 - along),
                                        np.full(7, side * engine_y), np.full(7, engine_z),
                                        girth, girth))  # fmt: skip
            add(tube(sections, 12), accent if draws.random() < 0.3 else metal)
            if design.propeller:
                _propeller(whole, (engine_x + long / 2, side * engine_y, engine_z), 3.4 * radius)
    chord = 1.5 * design.tail[1]
    add(panel(design.fin_height, chord, 0.5 * chord, 0.5 * chord,
              (design.tail[4] + 0.2 * chord, 0.0, 0.3), (0.0, 1.0), 0.09), accent)  # fmt: skip
    if design.propeller and not design.engines:
        _propeller(whole, (0.5 * design.length, 0.0, -0.2), 1.0)
    if draws.random() < 0.5:
        thick = 0.3 * design.radius
        for gear_x, gear_y in ((0.36, 0.0), (-0.03, 1.6), (-0.03, -1.6)):
            place = gear_x * design.length, gear_y * design.radius, -0.6 * design.radius
            add(panel(1.4 * design.radius, thick, thick, 0.0, place, (0.0, -1.0), 0.5), WHEELS)
    return whole


def _propeller(whole: Any, middle: tuple[float, float, float], radius: float) -> None:
    """Add the disc of a turning propeller, which dims what is behind it."""
    angle = np.linspace(0.0, 2.0 * math.pi, 25)
    rim = np.column_stack((np.full(25, middle[0]), middle[1] + radius * np.cos(angle),
                           middle[2] + radius * np.sin(angle)))  # fmt: skip
    places = np.vstack((np.array(middle)[None], rim))
    triangles = [(0, step, step + 1) for step in range(1, 25)]
    triangles += [(0, step + 1, step) for step in range(1, 25)]
    disc = whole.attach_new_node(mesh(places, triangles, np.full_like(places, 0.15)))
    disc.set_transparency(core.TransparencyAttrib.M_alpha)
    disc.set_alpha_scale(0.18)
    disc.hide(NAMING)


# --- surfaces -----------------------------------------------------------------------------


def texture(image: Image.Image) -> Any:
    """Return a texture of an image, which is repeated."""
    pixels = np.asarray(image.convert("RGB"))[::-1, :, ::-1]
    made = core.Texture()
    made.setup_2d_texture(pixels.shape[1], pixels.shape[0], core.Texture.T_unsigned_byte,
                          core.Texture.F_rgb)  # fmt: skip
    made.set_ram_image(np.ascontiguousarray(pixels).tobytes())
    made.set_minfilter(core.SamplerState.FT_linear_mipmap_linear)
    made.set_wrap_u(core.SamplerState.WM_repeat)
    made.set_wrap_v(core.SamplerState.WM_repeat)
    return made


def livery(design: Design, body: Floats, accent: Floats, draws: Draws) -> Any:
    """Return a skin with a band, windows, a grey belly and dirt."""
    wide, high = 1024, 256
    image = Image.new("RGB", (wide, high), tuple(int(255 * level) for level in body))
    pen = ImageDraw.Draw(image)
    colour = tuple(int(255 * level) for level in accent)
    for at in (0.02, 0.46):
        top = int((at + draws.uniform(-0.02, 0.04)) * high)
        pen.rectangle((0, top, wide, top + int(draws.uniform(2, 14))), fill=colour)
        if design.length > 10:
            for x in range(110, int(0.85 * wide), 12):
                pen.rectangle((x, int((at + 0.03) * high), x + 5, int((at + 0.03) * high) + 6),
                              fill=(40, 45, 55))  # fmt: skip
    if draws.random() < 0.5:
        pen.rectangle((int(0.78 * wide), 0, wide, high), fill=colour)
    pen.rectangle((0, int(0.62 * high), wide, int(0.88 * high)), fill=(150, 152, 155))
    pen.rectangle((36, int(0.1 * high), 70, int(0.4 * high)), fill=(25, 30, 40))
    dirt = draws.normal(1.0, 0.04, (high // 4, wide // 4))
    levels = np.asarray(image, dtype=float)
    levels *= np.asarray(Image.fromarray(dirt.astype(np.float32)).resize((wide, high)))[..., None]
    return texture(Image.fromarray(levels.clip(0, 255).astype(np.uint8)).rotate(180))


def surface(name: str, colour: npt.ArrayLike, depth: float) -> Any:
    """Return a photograph of a surface in a colour; ``depth`` is how much it deviates."""
    with Image.open(Path(skimage.__file__).with_name("data") / f"{name}.png") as photograph:
        grey = np.asarray(photograph.convert("L").resize((512, 512)), dtype=float)
    # The photograph beside its mirror image goes on without a seam.
    grey = np.block([[grey, grey[:, ::-1]], [grey[::-1], grey[::-1, ::-1]]])
    shade = 1.0 + depth * (grey - grey.mean()) / grey.std()
    levels = 255.0 * shade[..., None] * np.array(colour)
    return texture(Image.fromarray(levels.clip(0, 255).astype(np.uint8)))


def clouds(draws: Draws, sky: Floats, horizon: Floats) -> Image.Image:
    """Return the sky all around: 1024 pixels of azimuth, 256 from the horizon to the zenith."""
    wide, high = 1024, 256
    up = np.linspace(1.0, 0.0, high)[:, None, None]
    levels = horizon + (sky - horizon) * up**0.5 * np.ones((1, wide, 1))
    across, down = np.fft.rfftfreq(wide)[None], np.fft.fftfreq(high)[:, None]
    frequency = np.hypot(across, 2.5 * down)
    frequency[0, 0] = 1.0
    waves = draws.normal(size=frequency.shape) + 1j * draws.normal(size=frequency.shape)
    field = np.fft.irfft2(waves / frequency**1.6, s=(high, wide))
    field = (field - field.mean()) / field.std()
    cover = np.clip((field - draws.uniform(-0.8, 2.2)) * 0.8, 0.0, 1.0)[..., None]
    white = np.array([1.0, 1.0, 1.0]) * draws.uniform(0.75, 1.0)
    shaded = white * (0.8 + 0.2 * np.clip(1.2 - field, 0.0, 1.0))[..., None]
    levels = levels * (1.0 - cover) + shaded * cover
    return Image.fromarray((255.0 * levels.clip(0.0, 1.0)).astype(np.uint8))


# --- worlds -------------------------------------------------------------------------------


class World:
    """A place with ground, sky, houses and light, and a camera in it."""

    def __init__(self, base: Any, draws: Draws) -> None:
        self.root = core.NodePath("world")
        self.aloft = draws.random() < 0.35
        self.visibility_m = float(math.exp(draws.uniform(math.log(3000.0), math.log(40_000.0))))
        self.horizon = np.array([0.75, 0.8, 0.86]) * draws.uniform(0.6, 1.1)
        sky = np.array([0.3, 0.5, 0.8]) * draws.uniform(0.5, 1.1)
        if draws.random() < 0.3:
            sky = self.horizon * draws.uniform(0.75, 1.0)
        self._ground(draws)
        self._dome(draws, sky)
        self._houses(draws)
        fog = core.Fog("haze")
        fog.set_color(*self.horizon.clip(0.0, 1.0))
        fog.set_exp_density(3.0 / self.visibility_m)
        self.root.set_fog(fog)
        self.sun_rad = math.radians(draws.uniform(12.0, 70.0))
        sun = core.DirectionalLight("sun")
        sun.set_color(core.LColor(*(np.array([1.0, 0.96, 0.88]) * draws.uniform(0.45, 0.95)), 1.0))
        lamp = self.root.attach_new_node(sun)
        lamp.set_hpr(draws.uniform(0.0, 360.0), -math.degrees(self.sun_rad), 0.0)
        sky_light = core.AmbientLight("sky")
        sky_light.set_color(
            core.LColor(*(np.array([0.36, 0.4, 0.46]) * draws.uniform(0.7, 1.2)), 1.0)
        )
        self.root.set_light(lamp)
        self.root.set_light(self.root.attach_new_node(sky_light))
        height = draws.uniform(300.0, 2500.0) if self.aloft else draws.uniform(2.0, 40.0)
        self.field_rad = math.radians(draws.uniform(20.0, 65.0))
        base.cam.set_pos(0.0, 0.0, height)
        lift = draws.uniform(-6.0, 6.0) if self.aloft else draws.uniform(-2.0, 12.0)
        base.cam.set_hpr(
            draws.uniform(0.0, 360.0), lift, draws.normal(0.0, 4.0 if self.aloft else 0.3)
        )

    def _ground(self, draws: Draws) -> None:
        """Lay a ground of two photographs, one over the other, and most often a runway."""
        name = "grass" if draws.random() < 0.7 else "gravel"
        colour = np.array(GROUNDS[name]) * draws.uniform(0.6, 1.3) * draws.uniform(0.85, 1.15, 3)
        ground = self.root.attach_new_node(_rings())
        ground.set_texture(surface(name, colour, 0.16))
        ground.set_tex_scale(core.TextureStage.get_default(), 1.0 / (180.0 if self.aloft else 12.0))
        fields = core.TextureStage("fields")
        fields.set_mode(core.TextureStage.M_modulate)
        fields.set_rgb_scale(2)
        ground.set_texture(fields, surface("gravel", (0.5, 0.5, 0.5), 0.25))
        ground.set_tex_scale(fields, 1.0 / 480.0)
        if draws.random() < 0.8:
            strip = self.root.attach_new_node(_flat(45.0, 3000.0, 60))
            strip.set_texture(surface("gravel", (0.26, 0.26, 0.27), 0.1))
            strip.set_tex_scale(core.TextureStage.get_default(), 1.0 / 8.0)
            strip.set_pos(draws.uniform(-400, 400), draws.uniform(-1500, 1500), 0.0)
            strip.set_h(draws.uniform(0.0, 360.0))
            strip.set_depth_offset(1)
            dashes = strip.attach_new_node("dashes")
            dashes.set_texture_off(1)
            dashes.set_depth_offset(2)
            dash = _flat(0.9, 30.0, 1)
            for at in range(-1440, 1440, 60):
                dashes.attach_new_node(dash).set_y(at)

    def _dome(self, draws: Draws, sky: Floats) -> None:
        angle, lift = np.linspace(0, 2 * math.pi, 49), np.linspace(-0.02, math.pi / 2, 13)
        turn, up = (each.ravel() for each in np.meshgrid(angle, lift))
        flat = np.cos(up)
        places = 20_000.0 * np.column_stack((flat * np.cos(turn), flat * np.sin(turn), np.sin(up)))
        uvs = np.column_stack((turn / (2.0 * math.pi), (up * 2.0 / math.pi).clip(0.004, 0.996)))
        dome = self.root.attach_new_node(mesh(places, grid(13, 49), np.ones_like(places), uvs))
        dome.set_texture(texture(clouds(draws, sky, self.horizon.clip(0.0, 1.0))))
        dome.set_two_sided(True)
        dome.set_light_off(1)
        dome.set_fog_off(1)
        dome.set_bin("background", 0)
        dome.set_depth_write(False)

    def _houses(self, draws: Draws) -> None:
        walls = surface("brick", draws.uniform(0.3, 0.7, 3), 0.18)
        leaves = surface("grass", np.array((0.2, 0.3, 0.14)) * draws.uniform(0.6, 1.2), 0.3)
        for _ in range(int(draws.integers(0, 40))):
            away, course = (
                math.exp(draws.uniform(math.log(250.0), math.log(6000.0))),
                draws.uniform(0.0, 2 * math.pi),
            )
            sides = draws.uniform(8.0, 60.0), draws.uniform(8.0, 40.0), draws.uniform(3.0, 25.0)
            tree = draws.random() < 0.5
            house = self.root.attach_new_node(_cone() if tree else _block(*sides))
            house.set_pos(away * math.cos(course), away * math.sin(course), 0.0)
            house.set_h(draws.uniform(0.0, 360.0))
            if tree:
                house.set_scale(
                    draws.uniform(2.0, 5.0), draws.uniform(2.0, 5.0), draws.uniform(6.0, 18.0)
                )
                house.set_texture(leaves)
            else:
                house.set_texture(walls)
                house.set_color_scale(*draws.uniform(0.6, 1.3, 3), 1.0)


GROUNDS = {"grass": (0.28, 0.4, 0.18), "gravel": (0.42, 0.38, 0.3)}


def _rings() -> Any:
    """Return the ground up to 20 km; haze is worked out at its corners."""
    angle, away = np.linspace(0, 2 * math.pi, 65), np.geomspace(1.0, 20_000.0, 60)
    turn, out = np.meshgrid(angle, away)
    places = np.column_stack(((out * np.cos(turn)).ravel(), (out * np.sin(turn)).ravel(),
                              np.zeros(out.size)))  # fmt: skip
    return mesh(places, grid(60, 65), np.ones_like(places), places[:, :2])


def grid(rows: int, columns: int) -> Triangles:
    """Return the triangles of a grid of corners."""
    a = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    one = np.column_stack((a, a + columns, a + 1))
    return np.vstack((one, np.column_stack((a + 1, a + columns, a + columns + 1))))


def _flat(wide: float, long: float, steps: int) -> Any:
    across, along = np.array([wide / 2, -wide / 2]), np.linspace(-long / 2, long / 2, steps + 1)
    x, y = np.meshgrid(across, along)
    places = np.column_stack((x.ravel(), y.ravel(), np.zeros(x.size)))
    return mesh(places, grid(steps + 1, 2), np.full_like(places, 0.95), places[:, :2])


def _block(wide: float, long: float, high: float) -> Any:
    parts: list[Floats] = []
    uvs: list[Floats] = []
    triangles: list[tuple[int, int, int]] = []
    x, y = wide / 2, long / 2
    corners = np.array([(-x, -y), (x, -y), (x, y), (-x, y)])
    for side in range(4):
        a, b = corners[side], corners[(side + 1) % 4]
        base = 4 * len(parts)
        parts.append(np.array([(*a, 0), (*b, 0), (*b, high), (*a, high)]))
        run = math.dist(a, b)
        uvs.append(np.array([(0, 0), (run, 0), (run, high), (0, high)]) / 6.0)
        triangles += [(base, base + 1, base + 2), (base, base + 2, base + 3)]
    base = 4 * len(parts)
    parts.append(np.column_stack((corners, np.full(4, high))))
    uvs.append(corners / 6.0)
    triangles += [(base, base + 1, base + 2), (base, base + 2, base + 3)]
    places = np.concatenate(parts)
    return mesh(places, triangles, np.ones_like(places), np.concatenate(uvs))


def _cone() -> Any:
    angle = np.linspace(0.0, 2 * math.pi, 11)
    rim = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(11)))
    places = np.vstack((rim, (0.0, 0.0, 1.0)))
    uvs = np.column_stack((np.append(angle / 2.0, 0.5), np.append(np.zeros(11), 2.0)))
    return mesh(places, [(step, step + 1, 11) for step in range(10)], np.ones_like(places), uvs)


# --- pictures -----------------------------------------------------------------------------


class Studio:
    """Draws worlds, and which pixels are which airplane."""

    def __init__(self) -> None:
        core.load_prc_file_data("", CONFIGURATION + f"win-size {2 * COLUMNS} {2 * ROWS}\n")
        self.base = ShowBase()
        self.base.disable_mouse()
        self._names = self.base.win.make_texture_buffer("names", COLUMNS, ROWS, None, True)
        self._names.set_clear_color(core.LColor(0.0, 0.0, 0.0, 1.0))
        self._camera = self.base.make_camera(self._names, lens=self.base.camLens)
        self._camera.reparent_to(self.base.cam)
        lens = self._camera.node()
        lens.set_initial_state(_named(0).get_state())
        lens.set_camera_mask(NAMING)
        lens.set_tag_state_key("number")
        for number in range(1, 4):
            lens.set_tag_state(str(number), _named(number).get_state())

    def seen(self, buffer: Any) -> npt.NDArray[np.uint8]:
        """Return the pixels of a buffer, shape (rows, columns, 3)."""
        shot = buffer.get_screenshot()
        pixels = np.frombuffer(shot.get_ram_image_as("RGB").get_data(), dtype=np.uint8)
        return pixels.reshape(shot.get_y_size(), shot.get_x_size(), 3)[::-1].copy()

    def numbers(self) -> npt.NDArray[np.int64]:
        """Return the number of the airplane of each pixel; 0 is none."""
        levels = self.seen(self._names)[..., 0].astype(int)
        return np.round(levels / NUMBER_LEVELS).astype(np.int64)


def _named(number: int) -> Any:
    """Return a node whose state draws all in the levels of a number, without light or haze."""
    node = core.NodePath("state")
    node.set_color(NUMBER_LEVELS * number / 255.0, 0.0, 0.0, 1.0, 10)
    node.set_texture_off(10)
    node.set_light_off(10)
    node.set_fog_off(10)
    node.set_color_scale_off(10)
    node.set_transparency(core.TransparencyAttrib.M_none, 10)
    node.set_antialias(core.AntialiasAttrib.M_none, 10)
    return node


def placed(base: Any, world: World, draws: Draws) -> list[tuple[Any, float]]:
    """Add up to two airplanes before the camera, and return them with their ranges in m."""
    made = []
    for number in range(1, 1 + int(draws.integers(1, 3))):
        design = DESIGNS[int(draws.integers(len(DESIGNS)))]
        plane = airplane(design, draws)
        size_px = math.exp(draws.uniform(*np.log(SIZES_PX)))
        focal_px = 0.5 * COLUMNS / math.tan(world.field_rad / 2.0)
        range_m = min(focal_px * 0.8 * design.length / size_px, 0.8 * world.visibility_m)
        across, up = draws.uniform(-0.42, 0.42) * COLUMNS, draws.uniform(-0.4, 0.42) * ROWS
        place = base.render.get_relative_point(
            base.cam, core.Point3(across / focal_px * range_m, range_m, up / focal_px * range_m)
        )
        on_ground = place.z < 2.0 * design.radius
        if on_ground:
            if world.aloft:
                continue
            place = core.Point3(place.x, place.y, 2.2 * design.radius)
        plane.reparent_to(world.root)
        plane.set_pos(place)
        pitch, bank = (0.0, 0.0) if on_ground else (draws.normal(2.0, 4.0), draws.normal(0.0, 12.0))
        plane.set_hpr(draws.uniform(0.0, 360.0), pitch, bank)
        plane.set_tag("number", str(number))
        made.append((plane, math.dist(tuple(place), tuple(base.cam.get_pos(base.render)))))
    return made


def taken(levels: npt.NDArray[np.uint8], draws: Draws) -> Image.Image:
    """Return a picture as a camera with a lens and a sensor would have taken it."""
    image = (
        Image.fromarray(levels).reduce(2).filter(ImageFilter.GaussianBlur(draws.uniform(0.2, 0.7)))
    )
    noisy = np.asarray(image, dtype=float)
    noisy = noisy * draws.uniform(0.8, 1.1) + draws.normal(
        0.0, draws.uniform(0.5, 3.0), noisy.shape
    )
    return Image.fromarray(noisy.clip(0.0, 255.0).astype(np.uint8))


def drawn(
    studio: Studio, seed: int, index: int, folder: Path
) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Draw a picture into a folder, and return what COCO says of it and of its airplanes."""
    base = studio.base
    draws = np.random.default_rng((seed, index))
    world = World(base, draws)
    world.root.reparent_to(base.render)
    base.camLens.set_film_size(COLUMNS, ROWS)
    base.camLens.set_fov(math.degrees(world.field_rad))
    base.camLens.set_near_far(2.0, 40_000.0)
    planes = [] if draws.random() < EMPTY else placed(base, world, draws)
    base.graphicsEngine.render_frame()
    name = f"images/{index:05d}.png"
    taken(studio.seen(base.win), draws).save(folder / name)
    numbers = studio.numbers()
    about = {
        "id": index,
        "file_name": name,
        "width": COLUMNS,
        "height": ROWS,
        "visibility_m": world.visibility_m,
        "camera_kind": "nose" if world.aloft else "fixed",
        "sun_elevation_deg": math.degrees(world.sun_rad),
    }
    found = [
        _annotation(studio, world, plane, range_m, numbers, index)
        for plane, range_m in planes
        if (numbers == int(plane.get_tag("number"))).any()
    ]
    world.root.remove_node()
    return about, found


def _annotation(
    studio: Studio, world: World, plane: Any, range_m: float, numbers: Any, index: int
) -> dict[str, Any]:
    number = int(plane.get_tag("number"))
    mask = numbers == number
    others = [each for each in world.root.get_children() if each != plane]
    for other in others:
        other.hide()
    studio.base.graphicsEngine.render_frame()
    alone = studio.numbers() == number
    for other in others:
        other.show()
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    size = int(np.ptp(columns)) + 1, int(np.ptp(rows)) + 1
    return {
        "image_id": index,
        "category_id": 0,
        "bbox": [int(columns[0]), int(rows[0]), *size],
        "range_m": range_m,
        "visible_fraction": float(mask.sum() / alone.sum()),
        "transmission": math.exp(-3.0 * range_m / world.visibility_m),
        "segmentation": run_lengths(mask),
    }


def main() -> None:
    """Draw, and write pictures and truth."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    parser.add_argument("--images", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    (given.out / "images").mkdir(parents=True, exist_ok=True)
    studio = Studio()
    images: list[dict[str, Any]] = []
    annotations: list[dict[str, Any]] = []
    for index in track(range(given.images), "pictures", disable=not sys.stderr.isatty()):
        about, found = drawn(studio, given.seed, index, given.out)
        images.append(about)
        annotations += [{"id": len(annotations) + place, **one} for place, one in enumerate(found)]
    document = {
        "categories": [{"id": 0, "name": "airplane"}],
        "images": images,
        "annotations": annotations,
    }
    (given.out / "annotations.json").write_text(json.dumps(document), encoding="utf-8")
    print(f"{len(images)} pictures with {len(annotations)} airplanes in {given.out}")


if __name__ == "__main__":
    main()
