#include "app/screens/pins_preview.h"

#include <algorithm>

#include "scene/tactile_options.h"
#include "scene/tissue.h"

namespace palpa::app {
namespace {

// Both enumerations name the same alternatives in the same order.
mechanics::PinShapeOptions shape_options(const scene::DisplayOptions& display) {
    mechanics::PinShapeOptions options;
    options.zero = display.zero == scene::PinZero::skel ? mechanics::PinZero::skel : mechanics::PinZero::top;
    options.over_stroke =
        display.over_stroke == scene::OverStroke::clip ? mechanics::OverStroke::clip : mechanics::OverStroke::scale;
    options.sheet = display.sheet == scene::SheetBacking::off    ? mechanics::Sheet::off
                    : display.sheet == scene::SheetBacking::free ? mechanics::Sheet::free
                                                                 : mechanics::Sheet::backed;
    return options;
}

mechanics::FingerContact contact_of(scene::FingerContact contact) {
    switch (contact) {
        case scene::FingerContact::rigid:
            return mechanics::FingerContact::rigid;
        case scene::FingerContact::pad:
            return mechanics::FingerContact::pad;
        case scene::FingerContact::parabola:
            break;
    }
    return mechanics::FingerContact::parabola;
}

}  // namespace

std::shared_ptr<PinsPreview> make_pins_preview(const scene::Scene& scene,
                                               const std::shared_ptr<const scene::Plan>& plan) {
    const scene::LinearTissue* block = scene::block_of(plan->tissue);
    if (!scene.tactile || !scene.tactile->display || block == nullptr) return nullptr;
    const scene::DisplayOptions& display = *scene.tactile->display;
    auto preview = std::make_shared<PinsPreview>();
    preview->plan = plan;
    preview->compliance = &block->compliance;
    preview->stiffness_scale = scene.stiffness_scale;
    preview->force_limit_N = scene.tactile->force_limit_N;
    preview->pressure = display.kind == scene::DisplayKind::pressure;
    preview->finger.contact = contact_of(scene.tactile->finger.contact);
    preview->finger.diameter_m = scene.tactile->finger.diameter_m;
    preview->finger.pad = mechanics::scaled(preview->finger.pad, scene.stiffness_scale);
    preview->shape = mechanics::make_pin_shape({}, shape_options(display));
    const Eigen::Matrix2Xd& points_m = preview->pressure ? preview->shape.pin_m : preview->shape.sample_m;
    preview->points_m = points_m;
    preview->sampled.setZero(points_m.cols());
    preview->height_m.setZero(preview->shape.pin_m.cols());
    preview->work =
        mechanics::make_finger_work(block->compliance, preview->finger, {}, static_cast<int>(points_m.cols()));
    return preview;
}

void preview_pins(const scene::State& state, PinsPreview& preview, session::TactileMoment& moment) {
    const Eigen::Vector2d& place_m = state.touch.p_m;
    const double asked_N = state.touch.down ? state.touch.force_N : 0.0;
    const double force_N = std::min(asked_N, preview.force_limit_N);
    const mechanics::Compliance& compliance = *preview.compliance;
    const mechanics::FingerPress press = mechanics::finger_with_force(compliance, preview.finger, place_m,
                                                                      force_N / preview.stiffness_scale, preview.work);
    const Eigen::Matrix2Xd& relative_m = preview.pressure ? preview.shape.pin_m : preview.shape.sample_m;
    for (Eigen::Index i = 0; i < relative_m.cols(); ++i) preview.points_m.col(i) = place_m + relative_m.col(i);
    mechanics::PinReport report;
    const double stroke_m = preview.shape.grid.stroke_m;
    if (preview.pressure) {
        mechanics::finger_pressure_Pa(compliance, preview.work, preview.points_m, preview.sampled);
        const double most = std::max(preview.sampled.maxCoeff(), 1e-9);
        preview.height_m = preview.sampled * (force_N > 0.0 ? stroke_m / most : 0.0);
    } else {
        mechanics::finger_surface_m(compliance, preview.work, preview.points_m, preview.sampled);
        mechanics::pin_heights_m(preview.shape, press.depth_m, preview.sampled, preview.height_m, report);
    }
    moment.time_s = state.contact.time_s;
    moment.x_m = place_m.x();
    moment.y_m = place_m.y();
    moment.depth_m = press.depth_m;
    moment.force_N = press.force_N * preview.stiffness_scale;
    moment.rows = preview.shape.grid.rows;
    moment.columns = preview.shape.grid.columns;
    moment.stroke_m = stroke_m;
    for (Eigen::Index i = 0; i < preview.height_m.size(); ++i)
        moment.wanted_m[static_cast<std::size_t>(i)] = preview.height_m[i];
    moment.shape_scale = report.scale;
    moment.clipped = report.clipped;
    moment.linearity = press.linearity;
    moment.over_edge = press.over_edge;
    moment.held = asked_N > preview.force_limit_N;
}

}  // namespace palpa::app
