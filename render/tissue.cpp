#include "render/tissue.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "render/gl.h"

namespace palpa::render {

struct SurfaceMesh {
    std::vector<float> points;
    std::vector<unsigned> triangles;
};

namespace {

constexpr int kCells = 160;  // 0.75 mm on the 120 mm phantom

// Shared by both programs: the map from the tissue to the screen.
#define PALPA_PROJECTION                                                                                     \
    "#version 300 es\n"                                                                                      \
    "precision highp float;\n"                                                                               \
    "layout(location = 0) in vec2 unit;\n"                                                                   \
    "uniform vec2 area_px; uniform vec2 centre_px; uniform vec2 centre_m; uniform vec2 size_m;\n"            \
    "uniform mat2 axes; uniform float px_per_m; uniform float tilt;\n"                                       \
    "vec4 project(vec3 p) {\n"                                                                               \
    "  vec2 q = px_per_m * (axes * (p.xy - centre_m));\n"                                                    \
    "  float y = q.y * cos(tilt) - px_per_m * p.z * sin(tilt);\n"                                            \
    "  float depth = (-q.y * sin(tilt) - px_per_m * p.z * cos(tilt)) / (4.0 * max(area_px.x, area_px.y));\n" \
    "  vec2 s = centre_px + vec2(q.x, y);\n"                                                                 \
    "  return vec4(2.0 * s.x / area_px.x - 1.0, 1.0 - 2.0 * s.y / area_px.y, depth, 1.0);\n"                 \
    "}\n"

constexpr const char* kSurfaceVertex = PALPA_PROJECTION R"(
layout(location = 1) in vec3 relief;
uniform vec2 drag_at_m; uniform vec2 drag_m;
uniform vec2 dent_m; uniform float reach_m; uniform float sink_m[64]; uniform float has_relief;
out vec2 place_m; out vec3 normal; out float sunk_m;
float sink(float r) {
  if (r >= reach_m) return 0.0;
  float i = 63.0 * sqrt(r / reach_m);
  int k = int(i);
  return mix(sink_m[k], k < 63 ? sink_m[k + 1] : 0.0, i - float(k));
}
void main() {
  vec2 p = centre_m + (unit - 0.5) * size_m;
  vec2 d = p - dent_m;
  float r = length(d);
  float h = 3e-4;
  float slope = (sink(r + h) - sink(max(r - h, 0.0))) / (r > h ? 2.0 * h : r + h);
  vec2 outward = r > 1e-9 ? d / r : vec2(0.0);
  vec2 from_finger = (p - drag_at_m) / 0.025;  // a finger hides 10 mm around it
  place_m = p - drag_m * exp(-0.5 * dot(from_finger, from_finger));
  sunk_m = has_relief > 0.5 ? relief.x : sink(r);
  normal = normalize(vec3(has_relief > 0.5 ? relief.yz : outward * slope, 1.0));
  gl_Position = project(vec3(p, -sunk_m));
}
)";

// The light comes from the upper left of the screen, low enough that a shallow dent shows. Grid lines are 10 mm apart.
constexpr const char* kSurfaceFragment = R"(#version 300 es
precision highp float;
in vec2 place_m; in vec3 normal; in float sunk_m;
uniform mat2 axes; uniform vec2 centre_m;
out vec4 colour;
void main() {
  vec3 n = normalize(normal);
  vec2 across = axes * n.xy;  // screen y points down
  vec3 on_screen = normalize(vec3(across.x, -across.y, n.z));
  vec3 light = normalize(vec3(-0.55, 0.65, 0.75));
  float lit = max(dot(on_screen, light), 0.0) / light.z;
  vec3 tissue = vec3(0.80, 0.58, 0.52);
  vec3 shaded = tissue * (0.30 + 0.70 * lit) * exp(-sunk_m * 45.0);
  vec3 half_way = normalize(light + vec3(0.0, 0.0, 1.0));
  shaded += 0.10 * (pow(max(dot(on_screen, half_way), 0.0), 40.0) - pow(half_way.z, 40.0));
  vec2 line = abs(fract((place_m - centre_m) / 0.01 + 0.5) - 0.5) * 0.01;
  vec2 width = fwidth(place_m) * 0.7;
  float on_line = max(1.0 - line.x / width.x, 1.0 - line.y / width.y);
  colour = vec4(mix(shaded, shaded * 0.86, clamp(on_line, 0.0, 1.0)), 1.0);
}
)";

constexpr const char* kBallVertex = PALPA_PROJECTION R"(
uniform vec3 ball_m; uniform float radius_m;
out vec2 spot;
void main() {
  spot = 3.2 * (unit - 0.5);
  vec4 c = project(ball_m);
  gl_Position = vec4(c.xy + spot * radius_m * px_per_m * 2.0 / area_px, c.z - 0.02, 1.0);
}
)";

constexpr const char* kBallFragment = R"(#version 300 es
precision highp float;
in vec2 spot;
uniform float opacity;
out vec4 colour;
void main() {
  float r2 = dot(spot, spot);
  float edge = fwidth(r2) + 1e-6;
  float inside = clamp((1.0 - r2) / edge + 0.5, 0.0, 1.0);
  vec2 fallen = spot - vec2(0.14, -0.16);
  float shadow = 0.45 * exp(-3.5 * max(length(fallen) - 0.75, 0.0)) * (1.0 - smoothstep(1.0, 1.28, length(fallen)));
  vec3 n = vec3(spot, sqrt(max(1.0 - r2, 0.0)));
  vec3 light = normalize(vec3(-0.55, 0.65, 0.75));
  float lit = max(dot(n, light), 0.0);
  vec3 half_way = normalize(light + vec3(0.0, 0.0, 1.0));
  vec3 steel = vec3(0.42, 0.50, 0.60) * (0.35 + 0.75 * lit) + 0.55 * pow(max(dot(n, half_way), 0.0), 60.0);
  vec3 mixed = mix(vec3(0.0), steel, inside);
  float cover = mix(shadow, 1.0, inside);
  if (cover < 0.004) discard;
  colour = vec4(mixed, cover * opacity);
}
)";

SurfaceMesh unit_grid(int cells) {
    SurfaceMesh mesh;
    const auto row = static_cast<unsigned>(cells + 1);
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
            mesh.points.push_back(static_cast<float>(i) / static_cast<float>(cells));
            mesh.points.push_back(static_cast<float>(j) / static_cast<float>(cells));
        }
    }
    for (unsigned j = 0; j + 1 < row; ++j) {
        for (unsigned i = 0; i + 1 < row; ++i) {
            const unsigned at = j * row + i;
            for (const unsigned k : {at, at + 1, at + row, at + 1, at + row + 1, at + row}) mesh.triangles.push_back(k);
        }
    }
    return mesh;
}

void set_view(const Program& program, const TissueView& view) {
    program.use();
    glUniform2fv(program.uniform("area_px"), 1, glm::value_ptr(view.area_px));
    glUniform2fv(program.uniform("centre_px"), 1, glm::value_ptr(view.centre_px));
    glUniform2fv(program.uniform("centre_m"), 1, glm::value_ptr(view.centre_m));
    glUniform2fv(program.uniform("size_m"), 1, glm::value_ptr(view.size_m));
    glUniformMatrix2fv(program.uniform("axes"), 1, GL_FALSE, glm::value_ptr(view.axes));
    glUniform1f(program.uniform("px_per_m"), view.px_per_m);
    glUniform1f(program.uniform("tilt"), view.tilt_rad);
}

}  // namespace

struct TissueDrawer::Gpu {
    void draw(const TissueView& view, const Dent& dent, const Relief& sunk, const Ball& indenter);

    Program surface{kSurfaceVertex, kSurfaceFragment};
    Program ball{kBallVertex, kBallFragment};
    SurfaceMesh fine = unit_grid(kCells);
    SurfaceMesh single = unit_grid(1);
    Mesh tissue{fine.points, fine.triangles};
    Mesh quad{single.points, single.triangles};
    std::vector<float> relief;
    AreaCopy copy;
    bool copied = false;  // what the last call got
};

TissueDrawer::TissueDrawer() : gpu_(std::make_unique<Gpu>()) {}
TissueDrawer::~TissueDrawer() = default;

void TissueDrawer::draw(const TissueView& view, const Dent& dent, const Relief& relief, const Ball& ball,
                        bool as_before) {
    if (as_before && gpu_->copied) return gpu_->copy.put();
    gpu_->draw(view, dent, relief, ball);
    // something that moves is never shown twice, so it is not copied either
    const auto width_px = static_cast<int>(view.area_px.x);
    const auto height_px = static_cast<int>(view.area_px.y);
    gpu_->copied = as_before && gpu_->copy.take(width_px, height_px);
}

void TissueDrawer::Gpu::draw(const TissueView& view, const Dent& dent, const Relief& sunk, const Ball& indenter) {
    clear_screen(static_cast<int>(view.area_px.x), static_cast<int>(view.area_px.y));
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    set_view(surface, view);
    glUniform2fv(surface.uniform("drag_at_m"), 1, glm::value_ptr(view.drag_at_m));
    glUniform2fv(surface.uniform("drag_m"), 1, glm::value_ptr(view.drag_m));
    glUniform2fv(surface.uniform("dent_m"), 1, glm::value_ptr(dent.centre_m));
    glUniform1f(surface.uniform("reach_m"), dent.reach_m);
    glUniform1fv(surface.uniform("sink_m"), kSinkPoints, dent.sink_m.data());
    glUniform1f(surface.uniform("has_relief"), sunk.n_x >= 2 ? 1.0f : 0.0f);
    if (sunk.n_x >= 2) {
        refine(sunk, view.size_m, kCells, relief);
        tissue.set_second(relief);
    }
    tissue.draw();

    glDisable(GL_DEPTH_TEST);
    if (indenter.radius_m <= 0.0f) return;
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    set_view(ball, view);
    glUniform3f(ball.uniform("ball_m"), indenter.centre_m.x, indenter.centre_m.y, indenter.height_m);
    glUniform1f(ball.uniform("radius_m"), indenter.radius_m);
    glUniform1f(ball.uniform("opacity"), indenter.opacity);
    quad.draw();
    glDisable(GL_BLEND);
}

namespace {

// Catmull-Rom weights of the four neighbours of a place between the middle two, and their derivatives.
struct Weights {
    int first = 0;
    float value[4];
    float slope[4];
};

Weights weights_at(float at) {
    Weights w;
    const float low = std::floor(at);
    const float t = at - low;
    w.first = static_cast<int>(low) - 1;
    w.value[0] = 0.5f * (-t + 2.0f * t * t - t * t * t);
    w.value[1] = 0.5f * (2.0f - 5.0f * t * t + 3.0f * t * t * t);
    w.value[2] = 0.5f * (t + 4.0f * t * t - 3.0f * t * t * t);
    w.value[3] = 0.5f * (-t * t + t * t * t);
    w.slope[0] = 0.5f * (-1.0f + 4.0f * t - 3.0f * t * t);
    w.slope[1] = 0.5f * (-10.0f * t + 9.0f * t * t);
    w.slope[2] = 0.5f * (1.0f + 8.0f * t - 9.0f * t * t);
    w.slope[3] = 0.5f * (-2.0f * t + 3.0f * t * t);
    return w;
}

}  // namespace

void refine(const Relief& relief, const glm::vec2& size_m, int cells, std::vector<float>& out) {
    const auto n = static_cast<std::size_t>(cells) + 1;
    const float dx_m = size_m.x / static_cast<float>(relief.n_x - 1);
    const float dy_m = size_m.y / static_cast<float>(relief.n_y - 1);
    // along x first: value and slope of every row at the n places
    std::vector<float> rows(2 * n * static_cast<std::size_t>(relief.n_y));
    for (std::size_t i = 0; i < n; ++i) {
        const Weights w =
            weights_at((static_cast<float>(i) / static_cast<float>(cells) * size_m.x - relief.shift_m.x) / dx_m);
        for (int j = 0; j < relief.n_y; ++j) {
            float value = 0.0f;
            float slope = 0.0f;
            for (int k = 0; k < 4; ++k) {
                const int x = std::clamp(w.first + k, 0, relief.n_x - 1);
                const float sink = relief.sink_m[static_cast<std::size_t>(j * relief.n_x + x)];
                value += w.value[k] * sink;
                slope += w.slope[k] * sink;
            }
            const std::size_t at = 2 * (static_cast<std::size_t>(j) * n + i);
            rows[at] = value;
            rows[at + 1] = slope / dx_m;
        }
    }
    out.resize(3 * n * n);
    for (std::size_t j = 0; j < n; ++j) {
        const Weights w =
            weights_at((static_cast<float>(j) / static_cast<float>(cells) * size_m.y - relief.shift_m.y) / dy_m);
        for (std::size_t i = 0; i < n; ++i) {
            float* vertex = &out[3 * (j * n + i)];
            vertex[0] = vertex[1] = vertex[2] = 0.0f;
            for (int k = 0; k < 4; ++k) {
                const int y = std::clamp(w.first + k, 0, relief.n_y - 1);
                const float* row = &rows[2 * (static_cast<std::size_t>(y) * n + i)];
                vertex[0] += w.value[k] * row[0];
                vertex[1] += w.value[k] * row[1];
                vertex[2] += w.slope[k] * row[0] / dy_m;
            }
        }
    }
}

glm::vec2 project_px(const TissueView& view, const glm::vec3& p_m) {
    const glm::vec2 q = view.px_per_m * (view.axes * (glm::vec2(p_m) - view.centre_m));
    const float y = q.y * std::cos(view.tilt_rad) - view.px_per_m * p_m.z * std::sin(view.tilt_rad);
    return view.centre_px + glm::vec2(q.x, y);
}

}  // namespace palpa::render
