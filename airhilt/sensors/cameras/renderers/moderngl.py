"""Pictures by OpenGL 3.3 without a display: moderngl on EGL, at best on a graphics card."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from airhilt.errors import RendererError, first_line
from airhilt.imaging.view import NEAR_M, View, Window
from airhilt.sensors.cameras.opengl import shaders
from airhilt.sensors.cameras.opengl.shaders import FAR_M
from airhilt.sensors.cameras.renderers import Part, Samples
from airhilt.sensors.cameras.scene.illumination import Illumination
from airhilt.sensors.cameras.scene.textures import SIDE, deck_from, tiles
from airhilt.shapes.mesh import Floats, Mesh

SYSTEM_LIBRARIES = "libegl1 libgl1 libegl-mesa0 libgl1-mesa-dri"
SHELF_PX = 1024
"""Width of a row of windows that are drawn together, in pixels."""
CANVAS_STEP_PX = 64
"""Step in which frame buffers grow."""
TOUCHED, UNTOUCHED = ((True,) * 4,) * 2, ((False,) * 4,) * 2
"""Masks that let colours and distances be written, or not."""


class _Canvas:
    """Draws into the upper left corner of a frame buffer that only grows.

    There is never more than one: a buffer for each size would in time take all memory.
    """

    def __init__(self, context: Any) -> None:
        self._context = context
        self._room = 0, 0
        self._owned: list[Any] = []
        self.frame: Any = None
        self.size = 0, 0

    def clear(self, size: tuple[int, int], *, is_filled: bool = False) -> None:
        """Begin a drawing of some size; colours are not cleared if all of it will be filled."""
        width, height = (
            max(CANVAS_STEP_PX * math.ceil(side / CANVAS_STEP_PX), room)
            for side, room in zip(size, self._room, strict=True)
        )
        if (width, height) != self._room:
            self._replace((width, height))
        self.size = size
        self.frame.use()
        self.frame.viewport = 0, 0, *size
        self.frame.color_mask = UNTOUCHED if is_filled else TOUCHED
        self.frame.clear(viewport=(0, 0, *size))
        self.frame.color_mask = TOUCHED

    def _replace(self, room: tuple[int, int]) -> None:
        for owned in self._owned:
            owned.release()
        context = self._context
        colour, distance = context.texture(room, 4), context.texture(room, 1, dtype="f4")
        depth = context.depth_renderbuffer(room)
        self.frame = context.framebuffer([colour, distance], depth)
        self._owned = [self.frame, colour, distance, depth]
        self._room = room

    def read(self) -> Samples:
        """Return colours, and what has been drawn for distances."""
        width, height = self.size
        colour = self.frame.read(self.size, components=3, alignment=1)
        distance = self.frame.read(self.size, components=1, attachment=1, dtype="f4")
        return Samples(
            np.frombuffer(colour, dtype=np.uint8).reshape(height, width, 3),
            np.frombuffer(distance, dtype=np.float32).reshape(height, width),
        )


@dataclass(frozen=True)
class _Body:
    drawn: Any
    shadow: Any
    reach_m: float


class ModernGLRenderer:
    """Draws by OpenGL."""

    def __init__(self, landscape: Mesh, light: Illumination) -> None:
        self._context = context = _open_context()
        # Everything is closed and faces outwards; in a picture upside down, clockwise.
        context.front_face = "cw"
        context.depth_func = "<="
        self._light = light
        self._behind, self._before = _Canvas(context), _Canvas(context)
        self._bodies: dict[str, _Body] = {}
        self._landscape_program = context.program(
            shaders.LANDSCAPE_VERTEX, shaders.LANDSCAPE_FRAGMENT
        )
        self._sky_program = context.program(shaders.SKY_VERTEX, shaders.SKY_FRAGMENT)
        self._body_program = context.program(shaders.BODY_VERTEX, shaders.BODY_FRAGMENT)
        self._shadow_program = context.program(shaders.SHADOW_VERTEX, shaders.SHADOW_FRAGMENT)
        colours = context.texture((len(light.sky), 1), 3, light.sky.tobytes(), dtype="f4")
        colours.repeat_x = False
        colours.filter = context.NEAREST, context.NEAREST
        colours.use(0)
        self._add_textures()
        self._sky = context.vertex_array(self._sky_program, [])
        colours = np.broadcast_to(light.baked(landscape)[:, None], landscape.corners.shape)
        data = np.concatenate((landscape.corners, colours, _at_corners(landscape.material)), axis=2)
        names = ("in_place", "in_colour", "in_material")
        self._landscape = self._array(self._landscape_program, "3f 3f 1f", names, data)
        self._set_light()

    def _add_textures(self) -> None:
        context = self._context
        programs = self._landscape_program, self._sky_program, self._body_program
        for unit, name in enumerate(("fine", "middle", "coarse"), start=1):
            for program in programs:
                if name in program:
                    program[name] = unit
        if self._light.texture == 0.0 and not self._light.shows_deck:
            return
        for unit, tile in enumerate(tiles(), start=1):
            data = tile.finest.astype(np.float16)
            texture = context.texture_array((SIDE, SIDE, len(data)), 1, data.tobytes(), dtype="f2")
            texture.build_mipmaps()
            texture.filter = context.NEAREST_MIPMAP_NEAREST, context.NEAREST
            texture.use(unit)

    def _set_light(self) -> None:
        light = self._light
        for program in (self._landscape_program, self._sky_program, self._body_program):
            for name, value in (
                ("airlight", tuple(light.airlight)),
                ("extinction", light.extinction_per_m),
                ("sun", tuple(light.sun)),
                ("glare", tuple(light.glare)),
                ("sharpness", light.glare_sharpness),
                ("disc", light.disc),
                ("direct", tuple(light.direct)),
                ("diffuse", tuple(light.diffuse)),
                ("reflected", tuple(light.reflected)),
                ("darkness", light.darkness),
                ("deck", tuple(light.deck)),
                ("deck_from", deck_from(light.clouds)),
                ("shows_deck", light.shows_deck),
                ("texture_share", light.texture),
            ):
                if name in program:
                    program[name] = value
        self._landscape_program["extinction"] = light.background_extinction_per_m
        self._shadow_program["sun"] = tuple(light.sun)

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Keep the shape of a body, to draw it by this name."""
        self._bodies[name] = _Body(
            self._array(
                self._body_program,
                "3f 3f 3f 1f 1f",
                ("in_place", "in_normal", "in_colour", "in_glow", "in_material"),
                np.concatenate((
                    mesh.corners,
                    mesh.normals,
                    np.broadcast_to(mesh.colours[:, None], mesh.corners.shape),
                    _at_corners(mesh.glow),
                    _at_corners(mesh.material),
                ), axis=2),
            ),
            self._array(self._shadow_program, "3f", ("in_place",), mesh.corners),
            float(np.linalg.norm(mesh.corners, axis=2).max()),
        )  # fmt: skip

    def close(self) -> None:
        """Release the context."""
        self._context.release()

    def landscape(self, view: View, window: Window, samples: int = 1) -> Samples:
        """Return the landscape behind all bodies, with the sky and the air."""
        context, program = self._context, self._landscape_program
        canvas = self._behind
        canvas.clear((window.width * samples, window.height * samples), is_filled=True)
        context.enable_only(context.DEPTH_TEST | context.CULL_FACE)
        left, top, right, bottom = _edges(view, window)
        width, height = canvas.size
        program["projection"].write(_columns(_projection(view, window, NEAR_M)))
        focal = view.intrinsics.focal_px * samples
        for each in (program, self._sky_program):
            each["eye"] = view.pose.position_m
            each["focal"] = focal
        program["focal_plane"] = (right - left) / width, (bottom - top) / height, left, top
        self._landscape.render()
        # Last, and as far as can be: only where nothing else is.
        x, y, ahead = view.axes.T
        middle = ahead + (left + right) / 2.0 * x + (top + bottom) / 2.0 * y
        corners = np.column_stack(((right - left) / 2.0 * x, (bottom - top) / 2.0 * y, middle))
        self._sky_program["corners"].write(_columns(corners))
        self._sky.render(vertices=3)
        return canvas.read()

    def parts(self, view: View, parts: Sequence[Part]) -> list[Samples]:
        """Return bodies through the air, and shadows: all are drawn on one canvas."""
        if not parts:
            return []
        sizes = [(p.window.width * p.samples, p.window.height * p.samples) for p in parts]
        places, whole = _shelves(sizes)
        canvas = self._before
        canvas.clear(whole)
        self._shadow_program["eye"] = view.pose.position_m
        for part, place, size in zip(parts, places, sizes, strict=True):
            canvas.frame.viewport = canvas.frame.scissor = (*place, *size)
            self._draw(view, part)
        canvas.frame.scissor = None
        colour, inverse = canvas.read()
        with np.errstate(divide="ignore"):
            distance = np.float32(1.0) / inverse
        found = []
        for (left, top), (width, height) in zip(places, sizes, strict=True):
            window = slice(top, top + height), slice(left, left + width)
            found.append(Samples(colour[window], distance[window]))
        return found

    def _draw(self, view: View, part: Part) -> None:
        body, context = self._bodies[part.shape], self._context
        program = self._shadow_program if part.is_shadow else self._body_program
        offset = np.subtract(part.pose.position_m, view.pose.position_m)
        away = float(np.linalg.norm(offset))
        near = NEAR_M if part.is_shadow else max(NEAR_M, 0.2 * (away - 100.0))
        # From within, a body is seen from behind.
        culled = context.CULL_FACE if away > body.reach_m else context.NOTHING
        tested = context.NOTHING if part.is_shadow else context.DEPTH_TEST
        context.enable_only(culled | tested)
        program["projection"].write(_columns(_projection(view, part.window, near)))
        if not part.is_shadow:
            program["focal"] = view.intrinsics.focal_px * part.samples
        program["rotation"].write(_columns(part.pose.rotation))
        program["place"] = part.pose.position_m if part.is_shadow else tuple(offset)
        (body.shadow if part.is_shadow else body.drawn).render()

    def _array(self, program: Any, layout: str, names: tuple[str, ...], data: Floats) -> Any:
        """Return triangles for drawing."""
        buffer = self._context.buffer(np.ascontiguousarray(data, dtype=np.float32))
        return self._context.vertex_array(program, [(buffer, layout, *names)])


def _at_corners(numbers: Floats) -> Floats:
    """Return a number of each triangle for each of its corners."""
    return np.broadcast_to(numbers[:, None, None], (len(numbers), 3, 1))


def _shelves(
    sizes: Sequence[tuple[int, int]],
) -> tuple[list[tuple[int, int]], tuple[int, int]]:
    """Return places for rectangles side by side, row above row, and the size of it all."""
    widest = max(SHELF_PX, *(width for width, _ in sizes))
    places = []
    left = top = tallest = used = 0
    for width, height in sizes:
        if left + width > widest:
            left, top, tallest = 0, top + tallest, 0
        places.append((left, top))
        left, tallest = left + width, max(tallest, height)
        used = max(used, left)
    return places, (used, top + tallest)


def _projection(view: View, window: Window, near_m: float) -> npt.NDArray[np.float64]:
    """Return clip coordinates from offsets in the world; the first row of a picture is the lowest.

    OpenGL keeps the lowest row first, so drawing upside down saves turning what is read.
    """
    left, top, right, bottom = _edges(view, window)
    frustum = np.array((
        (2.0 / (right - left), 0.0, -(right + left) / (right - left), 0.0),
        (0.0, 2.0 / (bottom - top), -(bottom + top) / (bottom - top), 0.0),
        (0.0, 0.0, (FAR_M + near_m) / (FAR_M - near_m), -2.0 * FAR_M * near_m / (FAR_M - near_m)),
        (0.0, 0.0, 1.0, 0.0),
    ))  # fmt: skip
    turn = np.eye(4)
    turn[:3, :3] = view.axes.T
    return np.asarray(frustum @ turn)


def _edges(view: View, window: Window) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom of a window at a depth of 1."""
    lens = view.intrinsics
    across, down = lens.width_px / 2.0, lens.height_px / 2.0
    focal = lens.focal_px
    return (
        (window.left - across) / focal,
        (window.top - down) / focal,
        (window.right - across) / focal,
        (window.bottom - down) / focal,
    )


def _columns(matrix: npt.NDArray[np.float64]) -> bytes:
    """Return a matrix as OpenGL takes it."""
    return matrix.T.astype(np.float32).tobytes()


def _open_context() -> Any:
    remedy = ModernGL.needs
    try:
        import moderngl
    except ImportError:
        raise RendererError(f"the renderer moderngl is not installed: {remedy}") from None
    create: Any = moderngl.create_standalone_context
    try:
        return create(backend="egl")
    except Exception as error:  # of any class, by what of EGL is missing
        raise RendererError(
            f"the renderer moderngl finds no EGL: {remedy} ({first_line(error)})"
        ) from None


class ModernGL:
    """Draws with OpenGL."""

    name = "moderngl"
    needs = f"pip install 'airhilt[moderngl]' and apt install {SYSTEM_LIBRARIES}"

    def open(self, landscape: Mesh, light: Illumination) -> ModernGLRenderer:
        """Return a renderer of a landscape; RendererError if moderngl or EGL is not installed."""
        return ModernGLRenderer(landscape, light)


RENDERER = ModernGL()
