#include "render/tissue.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "render/gl.h"
#include "render/relief.h"
#include "render/tissue_shaders.h"

namespace palpa::render {

struct SurfaceMesh {
    std::vector<float> points;
    std::vector<unsigned> triangles;
};

namespace {

constexpr int kCells = 80;  // 0.35 mm apart at the contact, 3.7 mm far from it, on the 120 mm phantom
constexpr int kRingPoints = 96;
constexpr int kGrain_px = 512;
constexpr float kGrain_m = 0.06f;
constexpr float kMost_px = 1.5e6f;  // of a picture that software draws at its full resolution

// The vertices i = 0 ... cells of each axis, with `border` more on both sides, which lie just beside 0 ... 1.
SurfaceMesh unit_grid(const std::array<int, 2>& cells, int border) {
    SurfaceMesh mesh;
    const auto unit_of = [&](int i, int axis) {
        return static_cast<float>(i) / static_cast<float>(cells[static_cast<std::size_t>(axis)]);
    };
    for (int j = -border; j <= cells[1] + border; ++j) {
        for (int i = -border; i <= cells[0] + border; ++i) {
            mesh.points.push_back(unit_of(i, 0));
            mesh.points.push_back(unit_of(j, 1));
        }
    }
    const auto row = static_cast<unsigned>(cells[0] + 2 * border + 1);
    const auto rows = static_cast<unsigned>(cells[1] + 2 * border + 1);
    for (unsigned j = 0; j + 1 < rows; ++j) {
        for (unsigned i = 0; i + 1 < row; ++i) {
            const unsigned at = j * row + i;
            for (const unsigned k : {at, at + 1, at + row, at + 1, at + row + 1, at + row}) mesh.triangles.push_back(k);
        }
    }
    return mesh;
}

// How a material answers light; colours are linear.
struct MaterialLook {
    glm::vec3 plain, pale, flushed;  // at rest, pressed pale, and around that
    glm::vec3 wrap;                  // how far light bleeds round into the shade, for red, green, blue
    glm::vec3 bled;                  // what is left of the light in a shadow
    glm::vec3 gloss;                 // a wide, a middle and a narrow highlight
    float bump;                      // how strongly its slopes catch the light
};

MaterialLook look_of(Material material) {
    if (material == Material::silicone)
        return {{0.66f, 0.45f, 0.36f},
                {0.74f, 0.57f, 0.48f},
                {0.60f, 0.36f, 0.28f},
                {0.42f, 0.30f, 0.24f},
                {0.50f, 0.33f, 0.27f},
                {0.075f, 0.14f, 0.30f},
                0.10f};
    return {{0.62f, 0.32f, 0.245f},
            {0.76f, 0.53f, 0.43f},
            {0.60f, 0.25f, 0.19f},
            {0.34f, 0.14f, 0.10f},
            {0.44f, 0.17f, 0.12f},
            {0.060f, 0.070f, 0.08f},
            0.42f};
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
    glUniform2fv(program.uniform("eye_m"), 1, glm::value_ptr(view.eye_m));
    glUniform1f(program.uniform("eye_per_m"), view.eye_per_m);
}

// The lamp stands at the upper left of the screen, low enough that a shallow dent shows.
constexpr glm::vec3 kLampDirection{-0.56f, 0.62f, 0.62f};  // right, up, towards the viewer

glm::vec3 towards_lamp(const TissueView& view) {
    // screen y points down; axes are orthogonal
    const glm::vec2 across = glm::transpose(view.axes) * glm::vec2(kLampDirection.x, -kLampDirection.y);
    return glm::normalize(glm::vec3(across, kLampDirection.z));
}

glm::vec3 towards_eye(const TissueView& view) {
    return {glm::transpose(view.axes) * glm::vec2(0.0f, std::sin(view.tilt_rad)), std::cos(view.tilt_rad)};
}

void set3(const Program& program, const char* name, const glm::vec3& v) {
    glUniform3fv(program.uniform(name), 1, glm::value_ptr(v));
}

}  // namespace

struct TissueDrawer::Gpu {
    void draw(const TissuePicture& picture);
    void draw_surface(const TissuePicture& picture, const MaterialLook& look);
    void draw_ring(const TissuePicture& picture);
    void draw_indenter(const TissuePicture& picture, const MaterialLook& look);
    void make_grain(Material material);

    Program surface{kSurfaceVertex, kSurfaceFragment};
    Program indenter{kIndenterVertex, kIndenterFragment};
    Program grain_maker{kGrainVertex, kGrainFragment};
    Program ring{kRingVertex, kRingFragment};
    SurfaceMesh fine = unit_grid({kCells, kCells}, 1);
    SurfaceMesh single = unit_grid({1, 1}, 0);
    SurfaceMesh strip = unit_grid({kRingPoints, 1}, 0);
    Mesh tissue{fine.points, fine.triangles};
    Mesh quad{single.points, single.triangles};
    Mesh ring_strip{strip.points, strip.triangles};
    Texture grain{kGrain_px};
    std::optional<Material> grain_of;
    std::vector<float> relief;
    std::vector<float> rows;
    std::vector<float> points;  // of the ring
    Layer half;
    bool software = draws_in_software();
    AreaCopy copy;
    bool copied = false;  // what the last call got
};

TissueDrawer::TissueDrawer() : gpu_(std::make_unique<Gpu>()) {}
TissueDrawer::~TissueDrawer() = default;

void TissueDrawer::draw(const TissuePicture& picture, bool as_before) {
    if (as_before && gpu_->copied) return gpu_->copy.put();
    const auto width_px = static_cast<int>(picture.view.area_px.x);
    const auto height_px = static_cast<int>(picture.view.area_px.y);
    if (gpu_->grain_of != picture.material) gpu_->make_grain(picture.material);
    const bool large = picture.view.area_px.x * picture.view.area_px.y > kMost_px;
    const bool at_half = gpu_->software && large && gpu_->half.begin((width_px + 1) / 2, (height_px + 1) / 2);
    if (at_half) clear_screen((width_px + 1) / 2, (height_px + 1) / 2);
    if (!at_half) clear_screen(width_px, height_px);
    gpu_->draw(picture);
    if (at_half) gpu_->half.show(width_px, height_px);
    // something that moves is never shown twice, so it is not copied either
    gpu_->copied = as_before && gpu_->copy.take(width_px, height_px);
}

void TissueDrawer::Gpu::make_grain(Material material) {
    grain_of = material;
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    if (!grain.begin()) return;
    grain_maker.use();
    glUniform1f(grain_maker.uniform("skin"), material == Material::skin ? 1.0f : 0.0f);
    quad.draw();
    grain.end();
}

void TissueDrawer::Gpu::draw(const TissuePicture& picture) {
    const MaterialLook look = look_of(picture.material);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    draw_surface(picture, look);
    if (picture.indenter.radius_m > 0.0f) draw_indenter(picture, look);
    glDisable(GL_DEPTH_TEST);
}

void TissueDrawer::Gpu::draw_surface(const TissuePicture& picture, const MaterialLook& look) {
    const auto& [view, dent, sunk, grip, ball, material] = picture;
    set_view(surface, view);
    const glm::vec2 focus = focus_of(picture);
    glUniform2fv(surface.uniform("focus"), 1, glm::value_ptr(focus));
    glUniform1f(surface.uniform("thickness_m"), view.thickness_m);
    glUniform2fv(surface.uniform("drag_at_m"), 1, glm::value_ptr(view.drag_at_m));
    glUniform2fv(surface.uniform("drag_m"), 1, glm::value_ptr(view.drag_m));
    glUniform2fv(surface.uniform("dent_m"), 1, glm::value_ptr(dent.centre_m));
    glUniform1f(surface.uniform("reach_m"), dent.reach_m);
    glUniform1fv(surface.uniform("sink_m"), kSinkPoints, dent.sink_m.data());
    glUniform2fv(surface.uniform("grip_m"), 1, glm::value_ptr(grip.centre_m));
    glUniform1f(surface.uniform("contact_m"), grip.contact_radius_m);
    glUniform1f(surface.uniform("pull"), grip.pull);
    glUniform1f(surface.uniform("pressure"), grip.pressure);
    glUniform1f(surface.uniform("crease"), grip.crease);
    set3(surface, "ball_m", {ball.centre_m, ball.height_m});
    glUniform1f(surface.uniform("radius_m"), ball.radius_m);
    glUniform1f(surface.uniform("opacity"), ball.opacity);
    const glm::vec3 lamp = towards_lamp(view);
    set3(surface, "lamp", lamp);
    set3(surface, "half_way", glm::normalize(lamp + towards_eye(view)));
    set3(surface, "plain", look.plain);
    set3(surface, "pale", look.pale);
    set3(surface, "flushed", look.flushed);
    set3(surface, "wrap", look.wrap);
    set3(surface, "bled", look.bled);
    set3(surface, "gloss", look.gloss);
    glUniform1f(surface.uniform("bump"), look.bump);
    glUniform1f(surface.uniform("has_relief"), sunk.n_x >= 2 ? 1.0f : 0.0f);
    if (sunk.n_x >= 2) {
        refine(sunk, view.size_m, kCells, focus, rows, relief);
        tissue.set_second(relief);
    }
    grain.bind(view.px_per_m * kGrain_m < 0.55f * kGrain_px);
    tissue.draw();
    if (grip.footprint_m > 0.0f) draw_ring(picture);
}

void TissueDrawer::Gpu::draw_ring(const TissuePicture& picture) {
    const Grip& grip = picture.grip;
    const float half_m = std::max(3.3f / picture.view.px_per_m, 0.5e-3f);
    points.clear();
    for (int side = 0; side < 2; ++side) {
        for (int i = 0; i <= kRingPoints; ++i) {
            const float angle = 6.2831853f * static_cast<float>(i) / kRingPoints;
            const float radius_m = grip.footprint_m + (side == 0 ? -half_m : half_m);
            const glm::vec2 p_m = grip.centre_m + radius_m * glm::vec2(std::cos(angle), std::sin(angle));
            const glm::vec3 point_m = displaced_m(picture, p_m);
            points.insert(points.end(), {point_m.x, point_m.y, point_m.z});
        }
    }
    set_view(ring, picture.view);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    ring_strip.set_second(points);
    ring_strip.draw();
    glDisable(GL_BLEND);
}

void TissueDrawer::Gpu::draw_indenter(const TissuePicture& picture, const MaterialLook& look) {
    const TissueView& view = picture.view;
    const Indenter& ball = picture.indenter;
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    set_view(indenter, view);
    set3(indenter, "ball_m", {ball.centre_m, ball.height_m});
    glUniform1f(indenter.uniform("radius_m"), ball.radius_m);
    glUniform1f(indenter.uniform("extent"), ball.kind == IndenterKind::ball ? 1.1f : 3.3f);
    glUniform1f(indenter.uniform("opacity"), ball.opacity);
    glUniform1f(indenter.uniform("kind"), static_cast<float>(ball.kind));
    glUniform1f(indenter.uniform("covered"), ball.covered);
    glUniform1f(indenter.uniform("height_r"), ball.height_m / ball.radius_m);
    const float nearer = 1.0f / (1.0f - ball.height_m * view.eye_per_m);
    const float depth = ball.radius_m * view.px_per_m * nearer / (4.0f * std::max(view.area_px.x, view.area_px.y));
    glUniform1f(indenter.uniform("depth_per_r"), depth);
    const glm::vec2 hand = glm::normalize(glm::vec2(0.5f * ball.hand_x, -0.87f));
    glUniform2fv(indenter.uniform("hand"), 1, glm::value_ptr(hand));
    set3(indenter, "lamp", glm::normalize(kLampDirection));
    set3(indenter, "tissue", look.plain);
    quad.draw();
    glDisable(GL_BLEND);
}

glm::vec2 project_px(const TissueView& view, const glm::vec3& p_m) {
    const glm::vec2 seen_m = view.eye_m + (glm::vec2(p_m) - view.eye_m) / (1.0f - p_m.z * view.eye_per_m);
    const glm::vec2 q = view.px_per_m * (view.axes * (seen_m - view.centre_m));
    const float y = q.y * std::cos(view.tilt_rad) - view.px_per_m * p_m.z * std::sin(view.tilt_rad);
    return view.centre_px + glm::vec2(q.x, y);
}

glm::vec2 dragged_m(const TissueView& view, const glm::vec2& p_m) {
    const glm::vec2 from_finger = (p_m - view.drag_at_m) / 0.025f;
    return p_m + view.drag_m * std::exp(-0.5f * glm::dot(from_finger, from_finger));
}

glm::vec3 displaced_m(const TissuePicture& picture, const glm::vec2& p_m) {
    const float sunk_m =
        picture.relief.n_x >= 2 ? sink_m(picture.relief, picture.view, p_m) : sink_m(picture.dent, p_m);
    const Grip& grip = picture.grip;
    const glm::vec2 from_m = p_m - grip.centre_m;
    const float r_m = glm::length(from_m);
    const float a_m = grip.contact_radius_m;
    if (!(a_m > 0.0f) || !(r_m > 0.0f)) return {p_m, -sunk_m};
    const float beside = std::max(r_m - a_m, 0.0f) / (1.5f * a_m);
    const float drawn_in_m = grip.pull * a_m * std::min(r_m / a_m, 1.0f) * std::exp(-0.5f * beside * beside);
    return {p_m - drawn_in_m / r_m * from_m, -sunk_m};
}

}  // namespace palpa::render
