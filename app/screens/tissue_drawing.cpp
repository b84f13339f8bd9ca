#include "app/screens/tissue_drawing.h"

#include <algorithm>

namespace palpa::app {
namespace {

glm::vec2 to_gl(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }

}  // namespace

render::TissueView tissue_view(const scene::Scene& scene, const scene::State& state, float window_width_px,
                               float window_height_px) {
    const scene::View& view = state.view;
    render::TissueView out;
    out.area_px = {window_width_px, window_height_px};
    out.centre_px = to_gl(view.centre_px);
    out.centre_m = to_gl(view.area.centre_m);
    out.size_m = to_gl(view.area.size_m);
    out.axes = glm::mat2(to_gl(view.axes.col(0)), to_gl(view.axes.col(1)));
    out.px_per_m = static_cast<float>(view.px_per_m);
    constexpr float kTilt_rad = 0.7f;  // 40 degrees
    out.tilt_rad = scene.mapping.kind == scene::MappingKind::indirect ? kTilt_rad : 0.0f;
    return out;
}

void drag_texture(const scene::Avatar& avatar, render::TissueView& view) {
    view.drag_at_m = to_gl(avatar.p_m);
    view.drag_m = to_gl(avatar.texture_m);
}

render::Dent dent_of(const avatar::SurfaceCurve& curve, const scene::Avatar& avatar) {
    static_assert(render::kSinkPoints == avatar::kSurfacePoints, "the curve goes to the shader as it is");
    render::Dent dent;
    dent.centre_m = to_gl(avatar.p_m);
    dent.reach_m = static_cast<float>(curve.reach_m);
    std::transform(curve.sink_m.begin(), curve.sink_m.end(), dent.sink_m.begin(),
                   [](double sink_m) { return static_cast<float>(sink_m); });
    return dent;
}

render::Relief relief_of(const scene::SurfaceShape& shape, const scene::Avatar& avatar) {
    render::Relief relief;
    relief.n_x = static_cast<int>(shape.n_x);
    relief.n_y = static_cast<int>(shape.n_y);
    const auto at = [&](int i, int j) {
        const int x = std::clamp(i, 0, relief.n_x - 1);
        const int y = std::clamp(j, 0, relief.n_y - 1);
        return shape.sink_m[y * relief.n_x + x];
    };
    const auto along_x = [&](int i, int j) { return 0.25 * at(i - 1, j) + 0.5 * at(i, j) + 0.25 * at(i + 1, j); };
    for (int j = 0; j < relief.n_y; ++j) {
        for (int i = 0; i < relief.n_x; ++i) {
            const double smooth = 0.25 * along_x(i, j - 1) + 0.5 * along_x(i, j) + 0.25 * along_x(i, j + 1);
            relief.sink_m.push_back(static_cast<float>(smooth));
        }
    }
    relief.shift_m = -to_gl(avatar.lag_m);
    return relief;
}

render::Ball ball_of(const scene::Plan& plan, const scene::State& state, const scene::Avatar& avatar) {
    render::Ball ball;
    ball.centre_m = to_gl(avatar.p_m);
    ball.height_m = static_cast<float>(plan.indenter_radius_m - state.contact.depth_m);
    if (scene::on_tissue(state.view, state.touch.p_m) && state.timeline.started) {
        ball.radius_m = static_cast<float>(plan.indenter_radius_m);
    }
    constexpr float kHovering = 0.35f;
    ball.opacity = state.touch.down ? 1.0f : kHovering;
    return ball;
}

}  // namespace palpa::app
