#pragma once
// The shaders of the tissue, in OpenGL ES 3.0. Colours are linear; the last line of each takes the square root, close to
// what a screen expects.

// What all programs share: the map from the tissue to the screen.
#define PALPA_PROJECTION                                                                                     \
    "#version 300 es\n"                                                                                      \
    "precision highp float;\n"                                                                               \
    "layout(location = 0) in vec2 unit;\n"                                                                   \
    "uniform vec2 area_px; uniform vec2 centre_px; uniform vec2 centre_m; uniform vec2 size_m;\n"            \
    "uniform mat2 axes; uniform float px_per_m; uniform float tilt; uniform vec2 eye_m;\n"                   \
    "uniform float eye_per_m;\n"                                                                             \
    "vec4 project(vec3 p) {\n"                                                                               \
    "  vec2 seen = eye_m + (p.xy - eye_m) / (1.0 - p.z * eye_per_m);\n"                                      \
    "  vec2 q = px_per_m * (axes * (seen - centre_m));\n"                                                    \
    "  float y = q.y * cos(tilt) - px_per_m * p.z * sin(tilt);\n"                                            \
    "  float depth = (-q.y * sin(tilt) - px_per_m * p.z * cos(tilt)) / (4.0 * max(area_px.x, area_px.y));\n" \
    "  vec2 s = centre_px + vec2(q.x, y);\n"                                                                 \
    "  return vec4(2.0 * s.x / area_px.x - 1.0, 1.0 - 2.0 * s.y / area_px.y, depth, 1.0);\n"                 \
    "}\n"

namespace palpa::render {

// All that changes slowly over the surface is computed at the vertices: colour under pressure, light that the indenter
// keeps away, the crease. What is left for each pixel is one texture, the light on its slopes and the highlights: with
// software drawing pixels are what costs time. Vertices beside 0 ... 1 are the lower edges of the block's sides.
inline constexpr const char* kSurfaceVertex = PALPA_PROJECTION R"(
layout(location = 1) in vec3 relief;
uniform vec2 dent_m; uniform float reach_m; uniform float sink_m[64]; uniform float has_relief;
uniform vec2 focus; uniform float thickness_m; uniform vec2 drag_at_m; uniform vec2 drag_m;
uniform vec2 grip_m; uniform float contact_m; uniform float pull; uniform float pressure; uniform float crease;
uniform vec3 ball_m; uniform float radius_m; uniform float opacity;
uniform vec3 lamp; uniform vec3 plain; uniform vec3 pale; uniform vec3 flushed; uniform vec3 bled;
out vec2 grain_at; out vec2 from_centre; out vec3 normal;
out vec3 ambient; out vec3 key; out float shining;
float sink(float r) {
  if (r >= reach_m) return 0.0;
  float i = 63.0 * sqrt(r / reach_m);
  int k = int(i);
  return mix(sink_m[k], k < 63 ? sink_m[k + 1] : 0.0, i - float(k));
}
float crowded(float u, float f) {
  float side = u < f ? f : 1.0 - f;
  float t = side > 0.0 ? abs(u - f) / side : 0.0;
  float moved = side * t * (0.22 + 0.78 * t * t);
  return u < f ? f - moved : f + moved;
}
void main() {
  vec2 inside = clamp(unit, 0.0, 1.0);
  float down = inside == unit ? 0.0 : 1.0;
  vec2 rest = centre_m + (vec2(crowded(inside.x, focus.x), crowded(inside.y, focus.y)) - 0.5) * size_m;
  vec2 d = rest - dent_m;
  float r = length(d);
  float h = 2e-4;
  float slope = (sink(r + h) - sink(max(r - h, 0.0))) / (r > h ? 2.0 * h : r + h);
  vec2 outward = r > 1e-9 ? d / r : vec2(0.0);
  float sunk = has_relief > 0.5 ? relief.x : sink(r);
  // slopes are lit as if they were steeper, so that a shallow dent shows
  normal = normalize(vec3(1.7 * (has_relief > 0.5 ? relief.yz : outward * slope), 1.0));

  vec2 from = rest - grip_m;
  float s = length(from);
  float a = max(contact_m, 1e-6);
  float beside = max(s - a, 0.0) / (1.5 * a);
  float drawn_in = pull * a * min(s / a, 1.0) * exp(-0.5 * beside * beside);
  vec2 moved = rest - (s > 1e-9 ? from / s : vec2(0.0)) * drawn_in;
  vec3 p = vec3(moved, mix(-sunk, -thickness_m, down));
  gl_Position = project(p);
  from_centre = (rest - centre_m) / size_m;
  vec2 from_finger = (rest - drag_at_m) / 0.025;  // a finger hides 10 mm around it
  vec2 dragged = drag_m * exp(-0.5 * dot(from_finger, from_finger));
  grain_at = (rest - centre_m - dragged + vec2(0.0, down * thickness_m)) / 0.06;

  // sky that the indenter hides, and its shadow
  vec3 to_ball = ball_m - p;
  float far = max(length(to_ball), radius_m);
  float hidden = radius_m > 0.0 ? max(dot(normal, to_ball / far), 0.0) * radius_m * radius_m / (far * far) : 0.0;
  float along = dot(to_ball, lamp);
  float off = sqrt(max(far * far - along * along, 0.0));
  float shadow = along > 0.0 ? 1.0 - smoothstep(0.72 * radius_m, 1.3 * radius_m + 0.08 * along, off) : 0.0;
  shadow *= radius_m > 0.0 ? opacity : 0.0;
  float open = mix(1.0, exp(-190.0 * sunk), 0.85) * (1.0 - 0.85 * opacity * hidden);
  float line = (s - 1.12 * a) / (0.30 * a);
  float fold = (s - 2.3 * a) / (0.55 * a);
  float creased = 1.0 - crease * (0.64 * exp(-line * line) + 0.22 * exp(-fold * fold));
  float blanched = 0.75 * pressure * (1.0 - smoothstep(0.9 * a, 2.4 * a, s));
  float ring = (s - 3.0 * a) / (1.3 * a);
  vec3 tint = mix(mix(plain, flushed, 0.8 * pressure * exp(-ring * ring)), pale, blanched);
  // the lamp is nearer to one corner
  float nearer = 1.0 + 0.22 * dot(from_centre, lamp.xy);
  tint *= creased * nearer * (1.0 - 0.62 * down);
  ambient = 0.24 * open * tint;
  key = 1.08 * mix(open, 1.0, 0.65) * mix(bled, vec3(1.0), 1.0 - shadow) * tint;
  shining = open * creased * (1.0 - 0.6 * shadow) * (1.0 - down);
}
)";

inline constexpr const char* kSurfaceFragment = R"(#version 300 es
precision highp float;
in vec2 grain_at; in vec2 from_centre; in vec3 normal;
in vec3 ambient; in vec3 key; in float shining;
uniform vec2 size_m; uniform vec3 lamp; uniform vec3 half_way;
uniform vec3 wrap; uniform float bump; uniform vec3 gloss;
uniform sampler2D grain;
out vec4 colour;
void main() {
  vec4 fine = texture(grain, grain_at);
  // the block's edges are rounded
  vec2 over = max((abs(from_centre) - 0.5) * size_m * 400.0 + 1.0, 0.0);
  vec3 n = normal + vec3((fine.rg - 0.5) * bump + sign(from_centre) * over * over * 0.7, 0.0);
  n *= inversesqrt(dot(n, n));
  vec3 lit = max(dot(n, lamp) * (1.0 - wrap) + wrap, 0.0);
  float s = max(dot(n, half_way), 0.0);
  float s4 = s * s; s4 *= s4;
  float s16 = s4 * s4; s16 *= s16;
  float s64 = s16 * s16; s64 *= s64;
  float shine = (gloss.x * s16 + (gloss.y + gloss.z * s64 * s64) * s64) * fine.a * shining;
  colour = vec4(sqrt((ambient + key * lit) * (1.4 * fine.b) + shine), 1.0);
}
)";

// A ring on the surface, light between two dark lines. Its points come displaced, as relief.
inline constexpr const char* kRingVertex = PALPA_PROJECTION R"(
layout(location = 1) in vec3 point_m;
out float across;
void main() { across = unit.y; gl_Position = project(point_m) - vec4(0.0, 0.0, 1e-3, 0.0); }
)";

inline constexpr const char* kRingFragment = R"(#version 300 es
precision highp float;
in float across;
out vec4 colour;
void main() {
  float off = abs(2.0 * across - 1.0);
  float width = fwidth(off);
  float light = clamp((0.40 - off) / width + 0.5, 0.0, 1.0);
  colour = vec4(vec3(mix(0.08, 0.94, light)), clamp((1.0 - off) / width, 0.0, 1.0));
}
)";

// The texture of a material, drawn once: slopes in r and g; in b the share of light that comes back (1 / 1.4 on average),
// with lines 10 mm apart; gloss in a. It repeats every 60 mm.
inline constexpr const char* kGrainVertex = R"(#version 300 es
precision highp float;
layout(location = 0) in vec2 unit;
out vec2 at;
void main() { at = unit; gl_Position = vec4(2.0 * unit - 1.0, 0.0, 1.0); }
)";

inline constexpr const char* kGrainFragment = R"(#version 300 es
precision highp float;
precision highp int;
in vec2 at;
uniform float skin;
out vec4 colour;
vec2 random(ivec2 cell, int period) {
  uvec2 c = uvec2((cell % period + period) % period);
  uint h = c.x * 1664525u + c.y * 22695477u + uint(period) * 374761393u;
  h = (h ^ (h >> 15)) * 2246822519u; h = (h ^ (h >> 13)) * 3266489917u; h ^= h >> 16;
  return vec2(float(h & 65535u), float(h >> 16)) / 65535.0;
}
float smooth_noise(vec2 p, int period) {
  p *= float(period);
  ivec2 c = ivec2(floor(p));
  vec2 t = fract(p); t = t * t * (3.0 - 2.0 * t);
  float low = mix(random(c, period).x, random(c + ivec2(1, 0), period).x, t.x);
  float high = mix(random(c + ivec2(0, 1), period).x, random(c + ivec2(1, 1), period).x, t.x);
  return mix(low, high, t.y);
}
// distances to the nearest and the second point of a jittered grid
vec2 nearest(vec2 p, int period) {
  p *= float(period);
  ivec2 c = ivec2(floor(p));
  vec2 best = vec2(9.0);
  for (int j = -1; j <= 1; ++j) for (int i = -1; i <= 1; ++i) {
    ivec2 cell = c + ivec2(i, j);
    float d = length(vec2(cell) + 0.15 + 0.7 * random(cell, period) - p);
    best = d < best.x ? vec2(d, best.x) : vec2(best.x, min(best.y, d));
  }
  return best;
}
float height(vec2 p) {
  if (skin < 0.5) return 0.5 * smooth_noise(p, 144) + 0.5 * smooth_noise(p, 60);
  vec2 d = nearest(p, 66);
  float furrow = smoothstep(0.0, 0.32, d.y - d.x);
  float pore = smoothstep(0.05, 0.16, nearest(p + 0.37, 29).x);
  return 0.55 * furrow + 0.6 * pore + 0.12 * smooth_noise(p, 240);
}
void main() {
  float h = 1.0 / 512.0;
  float here = height(at);
  vec2 slope = vec2(height(at + vec2(h, 0.0)) - here, height(at + vec2(0.0, h)) - here);
  float spots = 0.38 * smooth_noise(at + 0.21, 7) + 0.34 * smooth_noise(at + 0.77, 13) + 0.28 * smooth_noise(at, 29) - 0.5;
  float dark = skin > 0.5 ? 0.10 * (here - 0.95) + 0.24 * spots : 0.04 * (smooth_noise(at, 190) - 0.5) + 0.10 * spots;
  vec2 line = abs(fract(at * 6.0 + 0.5) - 0.5) * 10.0;  // mm
  float on_line = 1.0 - smoothstep(0.05, 0.17, min(line.x, line.y));
  float gloss = skin > 0.5 ? 0.45 + 0.5 * min(here, 1.1) : 0.85 + 0.15 * smooth_noise(at, 90);
  float back = (1.0 + dark) * (1.0 - 0.32 * on_line) / 1.4;
  colour = vec4(0.5 - clamp(1.3 * slope, -0.5, 0.5), clamp(back, 0.0, 1.0), clamp(gloss, 0.0, 1.0));
}
)";

inline constexpr const char* kIndenterVertex = PALPA_PROJECTION R"(
uniform vec3 ball_m; uniform float radius_m; uniform float extent;
out vec2 spot; out float depth_here;
void main() {
  spot = 2.0 * extent * (unit - 0.5);
  vec4 c = project(ball_m);
  float nearer = 1.0 / (1.0 - ball_m.z * eye_per_m);
  gl_Position = vec4(c.xy + spot * nearer * radius_m * px_per_m * 2.0 / area_px, c.z, 1.0);
  depth_here = c.z;
}
)";

// A ball of steel, the same at the end of a shaft, or a fingertip: spheres and capsules, seen from above. kind: 0, 1, 2.
inline constexpr const char* kIndenterFragment = R"(#version 300 es
precision highp float;
in vec2 spot; in float depth_here;
uniform float opacity; uniform float kind; uniform float covered; uniform float height_r; uniform float depth_per_r;
uniform vec2 hand; uniform vec3 lamp; uniform vec3 tissue;
out vec4 colour;
// normal of a capsule from `from` along `along` (length 1), and how far inside of its outline the place is
vec4 capsule(vec2 from, vec2 along, float length_r, float radius) {
  float t = clamp(dot(spot - from, along), 0.0, length_r);
  vec2 off = (spot - from - t * along) / radius;
  float r2 = dot(off, off);
  return vec4(off, sqrt(max(1.0 - r2, 0.0)), (1.0 - sqrt(r2)) * radius);
}
vec3 steel(vec3 n) {
  vec3 back = vec3(2.0 * n.z * n.xy, 2.0 * n.z * n.z - 1.0);
  float sky = smoothstep(-0.95, 0.8, back.z);
  vec3 room = mix(vec3(0.03, 0.035, 0.045), vec3(0.42, 0.47, 0.54), sky) * (0.75 + 0.25 * back.y);
  room += vec3(1.6) * smoothstep(0.90, 0.965, dot(back, lamp));
  vec3 below = tissue * 0.20 * smoothstep(-0.1, -0.8, back.z);
  return room * 0.85 + below;
}
vec3 skin(vec3 n) {
  float lit = max((dot(n, lamp) + 0.35) / 1.35, 0.0);
  float s = max(dot(n, normalize(lamp + vec3(0.0, 0.0, 1.0))), 0.0);
  s *= s; s *= s; s *= s; s *= s;
  return vec3(0.60, 0.33, 0.24) * (0.30 + 0.85 * lit) + 0.12 * s;
}
vec3 fingertip(vec4 c) {
  vec3 shown = skin(c.xyz);
  // the nail: an oval behind the tip
  vec2 at = spot - 0.42 * hand;
  vec2 nail = vec2(dot(at, hand) / 0.74, dot(at, vec2(-hand.y, hand.x)) / 0.56);
  float oval = pow(abs(nail.x), 2.6) + pow(abs(nail.y), 2.6);
  float on_nail = smoothstep(1.06, 0.96, oval);
  vec3 plate = mix(vec3(0.74, 0.56, 0.48), vec3(0.68, 0.40, 0.34), smoothstep(-0.80, -0.66, nail.x));
  plate *= 0.55 + 0.45 * c.z;
  plate += 0.22 * smoothstep(0.30, 0.0, abs(nail.y + 0.30)) * smoothstep(0.9, 0.4, abs(nail.x));
  shown *= 1.0 - 0.35 * smoothstep(1.25, 1.05, oval);
  return mix(shown, plate, on_nail);
}
void main() {
  vec4 ball = capsule(vec2(0.0), hand, kind > 1.5 ? 3.0 : 0.0, 1.0);
  vec3 n = ball.xyz;
  float edge = fwidth(ball.w) + 1e-6;
  float inside = clamp((ball.w - (kind > 1.5 ? 0.0 : covered)) / edge + 0.5, 0.0, 1.0);
  float height = height_r + n.z;  // above the undisturbed surface, in radii
  vec3 shown = kind > 1.5 ? fingertip(ball) : steel(n);
  height += kind > 1.5 ? 0.8 * max(dot(spot, hand), 0.0) : 0.0;
  float sunk = smoothstep(0.35, -1.1, height);  // walls of tissue stand around what lies deep
  shown = mix(shown, shown * 0.25 + 0.10 * tissue, sunk);
  shown *= mix(1.0, smoothstep(0.0, 0.22, 1.0 - length(n.xy) - covered + 0.04), kind > 1.5 ? 0.0 : 0.75 * sunk);
  if (kind > 0.5 && kind < 1.5) {
    vec4 shaft = capsule(0.25 * hand, hand, 3.0, 0.34);
    float on_shaft = clamp(shaft.w / (fwidth(shaft.w) + 1e-6) + 0.5, 0.0, 1.0);
    shown = mix(shown, steel(shaft.xyz), on_shaft);
    inside = max(inside, on_shaft);
  }
  float fade = kind > 0.5 ? 1.0 - smoothstep(1.5, 2.9, dot(spot, hand)) : 1.0;
  float cover = inside * opacity * fade;
  if (cover < 0.004) discard;
  float rise = kind > 0.5 ? 0.8 * max(dot(spot, hand), 0.0) : 0.0;  // shaft and finger come down from the hand
  gl_FragDepth = clamp(0.5 + 0.5 * (depth_here - depth_per_r * (n.z + rise)), 0.0, 1.0);
  colour = vec4(sqrt(shown), cover);
}
)";

}  // namespace palpa::render
