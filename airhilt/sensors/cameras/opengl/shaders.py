"""Shaders in GLSL 3.30: what is computed for each corner and each sample."""

from __future__ import annotations

from airhilt.imaging.view import NEAR_M
from airhilt.sensors.cameras.scene.illumination import DISC, GLARE_ENDS, LOWEST_SKY
from airhilt.sensors.cameras.scene.textures import (
    COARSE,
    DECK_M,
    DECK_MOST,
    DECK_OPAQUE,
    DECK_VARIES,
    FINE,
    LEVELS,
    MIDDLE,
    NEAR,
    SIDE,
    TINT,
)
from airhilt.shapes.material import Material

FAR_M = 600_000.0
"""Greatest depth that is drawn, in m."""

AIR = """
uniform vec3 airlight;
uniform float extinction;
vec3 through_air(vec3 colour, float distance) {
    return mix(airlight, colour, exp(-extinction * distance));
}
// sRGB, its power replaced by a polynomial of the root: less than a tenth of a level beside it.
vec3 encode(vec3 linear) {
    vec3 l = clamp(linear, 0.0, 1.0);
    vec3 s = sqrt(l);
    vec3 high = ((0.51713 * s - 1.62312) * s + 2.03096) * s - 1.40244;
    return mix((high * s + 1.51789) * s - 0.04011, 12.92 * l, lessThan(l, vec3(0.0031308)));
}
"""
TEXTURE = f"""
uniform sampler2DArray fine;
uniform sampler2DArray middle;
uniform sampler2DArray coarse;
uniform float focal;
uniform float texture_share;
// As `_looked_up` of textures.py does it, to the texel.
float at(sampler2DArray tile, float texel, vec2 place, float material, float footprint) {{
    int level = (floatBitsToInt(footprint * {2.0**0.5}) >> 23) - 127 - int(round(log2(texel)));
    level = clamp(level, 0, {LEVELS - 1});
    ivec2 texels = (ivec2(floor(place / texel)) >> level) & (({SIDE} >> level) - 1);
    return texelFetch(tile, ivec3(texels, int(material)), level).r;
}}
// Heights slant places on walls.
float textured(vec3 place, float material, float footprint) {{
    vec2 p = place.xy + place.z;
    float factor = at(middle, {MIDDLE.texel_m}, p, material, footprint)
        * at(coarse, {COARSE.texel_m}, p, material, footprint);
    if (footprint * {2.0**0.5} < {2.0**NEAR})
        factor *= at(fine, {FINE.texel_m}, p, material, footprint);
    return 1.0 + texture_share * (factor - 1.0);
}}
"""
LANDSCAPE_VERTEX = """
#version 330
uniform mat4 projection;
uniform vec3 eye;
in vec3 in_place;
in vec3 in_colour;
in float in_material;
flat out vec3 colour;
flat out float material;
out vec3 place;
void main() {
    colour = in_colour;
    material = in_material;
    place = in_place;
    gl_Position = projection * vec4(in_place - eye, 1.0);
}
"""
LANDSCAPE_FRAGMENT = (
    "#version 330\n"
    + AIR
    + TEXTURE
    + f"""
uniform vec4 focal_plane;
uniform vec3 eye;
flat in vec3 colour;
flat in float material;
in vec3 place;
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;
void main() {{
    vec2 aside = focal_plane.xy * gl_FragCoord.xy + focal_plane.zw;
    float away = sqrt(dot(aside, aside) + 1.0) / gl_FragCoord.w;
    vec3 facing = normalize(cross(dFdx(place), dFdy(place)));
    float slant = abs(dot(facing, place - eye)) / away;
    float footprint = 1.0 / (gl_FragCoord.w * focal * sqrt(max(slant, 1e-6)));
    vec3 tint = vec3({TINT[0]}, {TINT[1]}, {TINT[2]});
    vec3 factor = 1.0 + (textured(place, material, footprint) - 1.0) * tint;
    out_colour = vec4(encode(through_air(colour * factor, away)), 1.0);
    out_distance = away;
    // By the logarithm of the depth: 24 bits of it tell apart 1 m in a thousand kilometres.
    gl_FragDepth = -log(gl_FragCoord.w * {NEAR_M}) / log({FAR_M} / {NEAR_M});
}}
"""
)
SKY_VERTEX = """
#version 330
uniform mat3 corners;
out vec3 towards;
void main() {
    vec2 place = vec2(gl_VertexID == 2 ? 3.0 : -1.0, gl_VertexID == 1 ? 3.0 : -1.0);
    towards = corners * vec3(place, 1.0);
    gl_Position = vec4(place, 1.0, 1.0);
}
"""
SKY_FRAGMENT = (
    "#version 330\n"
    + AIR
    + TEXTURE
    + f"""
uniform sampler2D sky;
uniform vec3 eye;
uniform vec3 deck;
uniform float deck_from;
uniform bool shows_deck;
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
    if (d.z > 0.0 && eye.z <= {DECK_M} && shows_deck) {{
        float away = ({DECK_M} - eye.z) / max(d.z, 1e-3);
        float found = at(coarse, {COARSE.texel_m}, d.xy * away + eye.xy, {Material.DECK}.0,
                         away / focal);
        found = (found - 1.0 - deck_from * {DECK_VARIES}) * {DECK_OPAQUE / DECK_VARIES};
        colour = mix(colour, deck, clamp(found, 0.0, {DECK_MOST}) * clamp(4.0 * d.z, 0.0, 1.0));
    }}
    float apart = 1.0 - dot(d, sun);
    if (apart < {GLARE_ENDS} / sharpness)
        colour += (exp(-sharpness * apart) + disc * exp(-{DISC} * apart)) * glare;
    out_colour = vec4(encode(colour), 1.0);
    out_distance = uintBitsToFloat(0x7F800000u);
}}
"""
)
BODY_VERTEX = """
#version 330
uniform mat4 projection;
uniform mat3 rotation;
uniform vec3 place;
in vec3 in_place;
in vec3 in_normal;
in vec3 in_colour;
in float in_glow;
in float in_material;
flat out float material;
out vec3 local;
out vec3 offset;
out vec3 normal;
flat out vec3 colour;
flat out float glow;
void main() {
    offset = rotation * in_place + place;
    normal = rotation * in_normal;
    colour = in_colour;
    glow = in_glow;
    material = in_material;
    local = in_place;
    gl_Position = projection * vec4(offset, 1.0);
}
"""
BODY_FRAGMENT = (
    "#version 330\n"
    + AIR
    + TEXTURE
    + """
flat in float material;
in vec3 local;
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
    light *= textured(local, material, away / focal);
    out_colour = vec4(encode(through_air(colour * (light + glow * darkness), away)), 1.0);
    out_distance = 1.0 / away;
}
"""
)
SHADOW_VERTEX = """
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
SHADOW_FRAGMENT = """
#version 330
layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance;
void main() {
    out_colour = vec4(0.0);
    out_distance = 1.0;
}
"""
