"""Pictures by OpenGL 3.3 without a display: moderngl on EGL, at best on a graphics card."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from airhilt.cameras.light import DISC, GLARE_ENDS, LOWEST_SKY, Light
from airhilt.cameras.mesh import Floats, Mesh
from airhilt.cameras.renderers import Part, Samples
from airhilt.cameras.view import NEAR_M, View, Window
from airhilt.errors import RendererError, first_line

FAR_M = 600_000.0
LEAST_TILE_M = 700.0
CANVAS_STEP_PX = 64
SHELF_PX = 1024
"""Width of a row of windows that are drawn together."""

_AIR = """
uniform vec3 airlight;
uniform float extinction;
vec3 through_air(vec3 colour, float distance) {
    return mix(airlight, colour, exp(-extinction * distance));
}
vec3 encode(vec3 linear) {
    vec3 l = clamp(linear, 0.0, 1.0);
    return mix(12.92 * l, 1.055 * pow(l, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, l));
}
"""
_WORLD_VERTEX = """
#version 330
uniform mat4 projection;
uniform vec3 eye;
in vec3 in_place;
in vec3 in_colour;
out vec3 offset;
flat out vec3 colour;
void main() {
    offset = in_place - eye;
    colour = in_colour;
    gl_Position = projection * vec4(offset, 1.0);
}
"""
_WORLD_FRAGMENT = (
    "#version 330\n"
    + _AIR
    + """
in vec3 offset;
flat in vec3 colour;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;
void main() {
    float away = length(offset);
    out_colour = vec4(encode(through_air(colour, away)), 1.0);
    out_distance = away;
}
"""
)
_SKY_VERTEX = """
#version 330
uniform mat3 corners;
out vec3 towards;
void main() {
    vec2 place = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    towards = corners * vec3(place, 1.0);
    gl_Position = vec4(place, 1.0, 1.0);
}
"""
_SKY_FRAGMENT = (
    _AIR
    + f"""
uniform sampler2D sky;
uniform vec3 sun;
uniform vec3 glare;
uniform float sharpness;
uniform float disc;
in vec3 towards;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;
void main() {{
    vec3 d = normalize(towards);
    vec3 colour = texture(sky, vec2((d.z - ({LOWEST_SKY})) / (1.0 - ({LOWEST_SKY})), 0.5)).rgb;
#ifdef GLARE
    float apart = 1.0 - dot(d, sun);
    if (apart < {GLARE_ENDS} / sharpness)
        colour += (exp(-sharpness * apart) + disc * exp(-{DISC} * apart)) * glare;
#endif
    out_colour = vec4(encode(colour), 1.0);
    out_distance = uintBitsToFloat(0x7F800000u);
}}
"""
)
_BODY_VERTEX = """
#version 330
uniform mat4 projection;
uniform mat3 rotation;
uniform vec3 place;
in vec3 in_place;
in vec3 in_normal;
in vec3 in_colour;
in float in_glow;
out vec3 offset;
out vec3 normal;
flat out vec3 colour;
flat out float glow;
void main() {
    offset = rotation * in_place + place;
    normal = rotation * in_normal;
    colour = in_colour;
    glow = in_glow;
    gl_Position = projection * vec4(offset, 1.0);
}
"""
_BODY_FRAGMENT = (
    "#version 330\n"
    + _AIR
    + """
uniform vec3 sun;
uniform vec3 direct;
uniform vec3 diffuse;
uniform vec3 reflected;
uniform float darkness;
in vec3 offset;
in vec3 normal;
flat in vec3 colour;
flat in float glow;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;
void main() {
    vec3 n = normalize(normal);
    vec3 light = max(dot(n, sun), 0.0) * direct + mix(reflected, diffuse, 0.5 + 0.5 * n.z);
    float away = length(offset);
    out_colour = vec4(encode(through_air(colour * (light + glow * darkness), away)), 1.0);
    out_distance = 1.0 / away;
}
"""
)
_SHADOW_VERTEX = """
#version 330
uniform mat4 projection;
uniform mat3 rotation;
uniform vec3 place;
uniform vec3 eye;
uniform vec3 sun;
in vec3 in_place;
void main() {
    vec3 world = rotation * in_place + place;
    vec3 ground = world - sun * (max(world.z, 0.0) / sun.z);
    gl_Position = projection * vec4(ground - eye, 1.0);
}
"""
_SHADOW_FRAGMENT = """
#version 330
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;
void main() {
    out_colour = vec4(0.0);
    out_distance = 1.0;
}
"""


@dataclass(frozen=True)
class _Body:
    drawn: Any
    shadow: Any


@dataclass(frozen=True)
class _Tiles:
    """Parts of the world in the order in which they are drawn, and a ball about each.

    Attributes
    ----------
    bounds
        Number of the first corner of each part, and after the last.
    """

    bounds: npt.NDArray[np.intp]
    middles: npt.NDArray[np.float64]
    radii_m: npt.NDArray[np.float64]

    def seen_in(self, view: View, window: Window) -> Iterator[tuple[int, int]]:
        """Yield first corners and numbers of corners of what may reach into a window."""
        x, y, z = view.in_camera(self.middles).T
        left, top, right, bottom = _edges(view, window)
        seen = z > -self.radii_m
        for across, low, high in ((x, left, right), (y, top, bottom)):
            seen &= across - high * z <= self.radii_m * math.hypot(1.0, high)
            seen &= low * z - across <= self.radii_m * math.hypot(1.0, low)
        edges = np.flatnonzero(np.diff(np.concatenate(([False], seen, [False]))))
        for begin, end in edges.reshape(-1, 2):
            first = int(self.bounds[begin])
            yield first, int(self.bounds[end]) - first


@dataclass(frozen=True)
class _Canvas:
    """Where is drawn: the first corner of a frame buffer that is at least as large."""

    frame: Any
    size: tuple[int, int]

    def read(self) -> Samples:
        """Return colours, and what has been drawn for distances."""
        width, height = self.size
        colour = np.frombuffer(self.frame.read(self.size, components=4), dtype=np.uint8)
        distance = self.frame.read(self.size, components=1, attachment=1, dtype="f4")
        return Samples(
            colour.reshape(height, width, 4)[..., :3],
            np.frombuffer(distance, dtype=np.float32).reshape(height, width),
        )


class ModernGLRenderer:
    """Draws by OpenGL.

    Raises
    ------
    RendererError
        moderngl or EGL is not installed.
    """

    def __init__(self, world: Mesh, light: Light) -> None:
        self._context = context = _open_context()
        self._light = light
        self._frames: dict[tuple[int, int], Any] = {}
        self._bodies: dict[str, _Body] = {}
        self._world_program = context.program(_WORLD_VERTEX, _WORLD_FRAGMENT)
        self._sky_programs = [
            context.program(_SKY_VERTEX, version + _SKY_FRAGMENT)
            for version in ("#version 330\n", "#version 330\n#define GLARE\n")
        ]
        self._body_program = context.program(_BODY_VERTEX, _BODY_FRAGMENT)
        self._shadow_program = context.program(_SHADOW_VERTEX, _SHADOW_FRAGMENT)
        self._sky = context.texture((len(light.sky), 1), 3, light.sky.tobytes(), dtype="f4")
        self._sky.repeat_x = False
        self._sky.filter = context.NEAREST, context.NEAREST
        self._tallest_m = float(world.corners[..., 2].max())
        self._skies = [context.vertex_array(program, []) for program in self._sky_programs]
        order, self._tiles = _tiles(world)
        self._world = self._array(
            self._world_program,
            "3f 3f",
            ("in_place", "in_colour"),
            _by_corner(world.corners, light.baked(world))[order],
        )
        self._set_light()

    def _set_light(self) -> None:
        light = self._light
        for program in (self._world_program, *self._sky_programs, self._body_program):
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
            ):
                if name in program:
                    program[name] = value
        self._world_program["extinction"] = light.backdrop_extinction_per_m
        self._shadow_program["sun"] = tuple(light.sun)

    def add_shape(self, name: str, mesh: Mesh) -> None:
        """Take in the shape of a body."""
        self._bodies[name] = _Body(
            self._array(
                self._body_program,
                "3f 3f 3f 1f",
                ("in_place", "in_normal", "in_colour", "in_glow"),
                np.concatenate((
                    mesh.corners,
                    mesh.normals,
                    np.broadcast_to(mesh.colours[:, None], mesh.corners.shape),
                    np.broadcast_to(mesh.glow[:, None, None], (len(mesh), 3, 1)),
                ), axis=2),
            ),
            self._array(self._shadow_program, "3f", ("in_place",), mesh.corners),
        )  # fmt: skip

    def close(self) -> None:
        """Give back what was taken."""
        self._context.release()

    def world(self, view: View, window: Window, samples: int = 1) -> Samples:
        """Return the world behind all bodies, with the sky and the air."""
        canvas = self._canvas((window.width * samples, window.height * samples))
        eye = view.pose.position_m
        self._context.enable(self._context.DEPTH_TEST)
        self._context.depth_func = "<="
        near = max(NEAR_M, 0.4 * (eye[2] - self._tallest_m))
        self._world_program["projection"] = _columns(_projection(view, window, near))
        self._world_program["eye"] = eye
        # Everything is closed and faces outwards; in a picture upside down, clockwise.
        self._context.front_face = "cw"
        self._context.enable(self._context.CULL_FACE)
        for first, count in self._tiles.seen_in(view, window):
            self._world.render(vertices=count, first=first)
        self._context.disable(self._context.CULL_FACE)
        # Last, and as far as can be: only where nothing else is.
        left, top, right, bottom = _edges(view, window)
        x, y, ahead = view.axes.T
        middle = ahead + (left + right) / 2.0 * x + (top + bottom) / 2.0 * y
        corners = np.column_stack(((right - left) / 2.0 * x, (bottom - top) / 2.0 * y, middle))
        has_glare = self._has_glare(view, window)
        self._sky.use(0)
        self._sky_programs[has_glare]["corners"] = _columns(corners)
        self._skies[has_glare].render(vertices=3)
        return canvas.read()

    def _has_glare(self, view: View, window: Window) -> bool:
        """Return whether the bright sky about the sun may reach into a window."""
        light = self._light
        columns = np.array([window.left, window.right, window.left, window.right])
        rows = np.array([window.top, window.top, window.bottom, window.bottom])
        edges = view.directions(columns.astype(np.float32), rows.astype(np.float32))
        middle = edges.sum(axis=1) / np.linalg.norm(edges.sum(axis=1))
        reach = math.acos(max(float((middle @ edges).min()), -1.0))
        reach += math.acos(max(light.glare_from, -1.0))
        away = math.acos(min(max(float(middle @ light.sun), -1.0), 1.0))
        return bool(light.glare.any()) and away < reach

    def parts(self, view: View, parts: Sequence[Part]) -> list[Samples]:
        """Return bodies through the air, and shadows: all are drawn on one canvas."""
        if not parts:
            return []
        sizes = [(p.window.width * p.samples, p.window.height * p.samples) for p in parts]
        places, whole = _shelves(sizes)
        canvas = self._canvas(whole)
        self._body_program["extinction"] = self._light.extinction_per_m
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
        away = np.subtract(part.pose.position_m, view.pose.position_m)
        near = max(NEAR_M, 0.2 * (float(np.linalg.norm(away)) - 100.0))
        if part.is_shadow:
            context.disable(context.DEPTH_TEST)
            near = NEAR_M
        else:
            context.enable(context.DEPTH_TEST)
        program["projection"] = _columns(_projection(view, part.window, near))
        program["rotation"] = _columns(part.pose.rotation)
        program["place"] = part.pose.position_m if part.is_shadow else tuple(away)
        (body.shadow if part.is_shadow else body.drawn).render()

    def _canvas(self, size: tuple[int, int]) -> _Canvas:
        """Return a cleared canvas. Frame buffers are costly to make: few sizes do."""
        width, height = (CANVAS_STEP_PX * math.ceil(side / CANVAS_STEP_PX) for side in size)
        frame = self._frames.get((width, height))
        if frame is None:
            context = self._context
            frame = self._frames[width, height] = context.framebuffer(
                [
                    context.texture((width, height), 4),
                    context.texture((width, height), 1, dtype="f4"),
                ],
                context.depth_renderbuffer((width, height)),
            )
        frame.use()
        frame.viewport = 0, 0, *size
        frame.clear()
        return _Canvas(frame, size)

    def _array(self, program: Any, layout: str, names: tuple[str, ...], data: Floats) -> Any:
        """Return triangles for drawing; corners that are alike are stored, and lit, once."""
        corners = np.ascontiguousarray(data, dtype=np.float32).reshape(-1, data.shape[2])
        rows = corners.view(np.dtype((np.void, corners.itemsize * corners.shape[1]))).reshape(-1)
        _, first, number = np.unique(rows, return_index=True, return_inverse=True)
        # In the order of their use, for the sake of the caches.
        rank = np.empty(len(first), dtype=np.uint32)
        rank[np.argsort(first)] = np.arange(len(first), dtype=np.uint32)
        buffer = self._context.buffer(corners[np.sort(first)].tobytes())
        indices = self._context.buffer(rank[number.reshape(-1)].tobytes())
        return self._context.vertex_array(program, [(buffer, layout, *names)], indices)


def _tiles(world: Mesh) -> tuple[npt.NDArray[np.intp], _Tiles]:
    """Return an order of triangles in which those of one tile follow each other, and the tiles.

    Large triangles, which reach over many tiles, are in tiles of their own size.
    """
    low, high = world.corners.min(axis=1), world.corners.max(axis=1)
    size = np.max(high - low, axis=1)
    level = np.ceil(np.log2(np.maximum(size, LEAST_TILE_M) / LEAST_TILE_M))
    cells = np.floor((low + high)[:, :2] / 2.0 / (LEAST_TILE_M * 2.0**level)[:, None])
    _, number = np.unique(np.column_stack((level, cells)), axis=0, return_inverse=True)
    order = np.argsort(number.reshape(-1), kind="stable")
    starts = np.concatenate(([0], np.cumsum(np.bincount(number.reshape(-1)))))
    bottom = np.minimum.reduceat(low[order], starts[:-1]).astype(np.float64)
    top = np.maximum.reduceat(high[order], starts[:-1]).astype(np.float64)
    middles = (bottom + top) / 2.0
    return order, _Tiles(3 * starts, middles, np.linalg.norm(top - middles, axis=1))


def _by_corner(corners: Floats, colours: Floats) -> Floats:
    spread = np.broadcast_to(colours[:, None], corners.shape)
    return np.concatenate((corners, spread), axis=2)


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


def _columns(matrix: npt.NDArray[np.float64]) -> tuple[float, ...]:
    """Return a matrix as OpenGL takes it."""
    return tuple(float(value) for value in matrix.T.reshape(-1))


def _open_context() -> Any:
    libraries = "libegl1 libgl1 libegl-mesa0 libgl1-mesa-dri"
    remedy = f"pip install 'airhilt[moderngl]' and apt install {libraries}"
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
