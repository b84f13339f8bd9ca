#include "app/screens/tissue_drawing.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace palpa::app {
namespace {

// Straight above the tissue the eye is this high: near enough that a dent narrows towards its bottom, and that lines on
// the tissue bend into it (by 1 to 2 mm at 7 mm of depth).
constexpr float kEye_m = 0.035f;
constexpr float kTilt_rad = 0.52f;  // 30 degrees

glm::vec2 to_gl(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }

render::Dent dent_of(const avatar::SurfaceCurve& curve, double gain, const glm::vec2& centre_m) {
    static_assert(render::kSinkPoints == avatar::kSurfacePoints, "the curve goes to the shader as it is");
    render::Dent dent;
    dent.centre_m = centre_m;
    dent.reach_m = static_cast<float>(curve.reach_m);
    std::transform(curve.sink_m.begin(), curve.sink_m.end(), dent.sink_m.begin(),
                   [&](double sink_m) { return static_cast<float>(gain * sink_m); });
    return dent;
}

render::Relief relief_of(const scene::SurfaceShape& shape, double gain, const glm::vec2& shift_m) {
    render::Relief relief;
    relief.n_x = static_cast<int>(shape.n_x);
    relief.n_y = static_cast<int>(shape.n_y);
    relief.sink_m.reserve(static_cast<std::size_t>(shape.sink_m.size()));
    const auto at = [&](int i, int j) {
        const int x = std::clamp(i, 0, relief.n_x - 1);
        const int y = std::clamp(j, 0, relief.n_y - 1);
        return shape.sink_m[y * relief.n_x + x];
    };
    const auto along_x = [&](int i, int j) { return 0.25 * at(i - 1, j) + 0.5 * at(i, j) + 0.25 * at(i + 1, j); };
    for (int j = 0; j < relief.n_y; ++j) {
        for (int i = 0; i < relief.n_x; ++i) {
            const double smooth = 0.25 * along_x(i, j - 1) + 0.5 * along_x(i, j) + 0.25 * along_x(i, j + 1);
            relief.sink_m.push_back(static_cast<float>(gain * smooth));
        }
    }
    relief.shift_m = shift_m;
    return relief;
}

render::Grip grip_of(const scene::CueValues& cues, const scene::Plan& plan, const scene::Contact& contact,
                     const glm::vec2& centre_m) {
    render::Grip grip;
    grip.centre_m = centre_m;
    if (!(cues.drawn_depth_m > 0.0)) return grip;
    const double radius_m = plan.indenter_radius_m;
    grip.contact_radius_m = static_cast<float>(avatar::sphere_contact_radius_m(contact.depth_m, radius_m));
    // flesh clings to what presses into it, the more the deeper it lies
    constexpr float kPull = 0.36f;
    grip.pull = kPull * static_cast<float>(std::min(cues.drawn_depth_m / radius_m, 1.0));
    grip.pressure = static_cast<float>(std::clamp(contact.normal_N / std::max(0.1, plan.greatest_force_N), 0.0, 1.0));
    grip.crease = static_cast<float>(cues.crease);
    grip.footprint_m = static_cast<float>(cues.footprint_m);
    return grip;
}

}  // namespace

render::TissueView tissue_view(const scene::Scene& scene, const scene::State& state, const scene::Avatar& avatar,
                               const glm::vec2& window_px) {
    const scene::View& view = state.view;
    render::TissueView out;
    out.area_px = window_px;
    out.centre_px = to_gl(view.centre_px);
    out.centre_m = to_gl(view.area.centre_m);
    out.size_m = to_gl(view.area.size_m);
    out.axes = glm::mat2(to_gl(view.axes.col(0)), to_gl(view.axes.col(1)));
    out.px_per_m = static_cast<float>(view.px_per_m);
    if (scene.surface) out.thickness_m = static_cast<float>(scene.surface->thickness_m);
    if (scene.mapping.kind == scene::MappingKind::indirect) {
        out.tilt_rad = kTilt_rad;
        // the block's front side stands below its surface: both together are in the middle
        out.centre_px.y -= 0.5f * out.px_per_m * out.thickness_m * std::sin(kTilt_rad);
    } else {
        // beside the tissue the eye would see the sides of the block
        const Eigen::Vector2d half_m = 0.5 * view.area.size_m;
        const Eigen::Vector2d from_m = avatar.p_m - view.area.centre_m;
        out.eye_m = to_gl(view.area.centre_m + from_m.cwiseMax(-half_m).cwiseMin(half_m));
        out.eye_per_m = 1.0f / kEye_m;
    }
    out.drag_at_m = to_gl(avatar.p_m);
    out.drag_m = to_gl(avatar.texture_m);
    return out;
}

void add_surface(const scene::SurfaceShape& shape, const scene::DrawnCues& cues, const scene::Avatar& avatar,
                 render::TissuePicture& picture) {
    const double gain = 1.0 + cues.depth_gain;
    if (shape.curve) picture.dent = dent_of(*shape.curve, gain, to_gl(avatar.p_m));
    if (shape.n_x > 0) picture.relief = relief_of(shape, gain, -to_gl(avatar.lag_m));
}

void add_indenter(const scene::Plan& plan, const scene::State& state, const scene::CueValues& cues,
                  const scene::Avatar& avatar, render::TissuePicture& picture) {
    const double radius_m = plan.indenter_radius_m;
    const glm::vec2 centre_m = to_gl(avatar.p_m);
    if (state.touch.down) picture.grip = grip_of(cues, plan, state.contact, centre_m);
    picture.grip.centre_m = centre_m;
    render::Indenter& indenter = picture.indenter;
    indenter.kind = static_cast<render::IndenterKind>(plan.indenter);
    indenter.centre_m = centre_m;
    indenter.height_m = static_cast<float>(radius_m - cues.drawn_depth_m);
    if (scene::on_tissue(state.view, state.touch.p_m) && state.timeline.started)
        indenter.radius_m = static_cast<float>(radius_m);
    constexpr float kHovering = 0.35f;
    indenter.opacity = state.touch.down ? 1.0f : kHovering;
    constexpr float kMostCovered = 0.2f;
    const auto depth_r = static_cast<float>(cues.drawn_depth_m / radius_m);
    indenter.covered = kMostCovered * glm::smoothstep(0.7f, 2.0f, depth_r);
}

}  // namespace palpa::app
