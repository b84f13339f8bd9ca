#include "scene/part_tissue.h"

#include <algorithm>
#include <cmath>

namespace palpa::scene {
namespace {

using parts::Response;
using parts::StationPlace;

Eigen::Vector2d direction_of(const PartTissue& tissue) { return {tissue.direction_m[0], tissue.direction_m[1]}; }

// The axis of the plane along which the load is largest, and its sign.
int pressed_axis(const PartTissue& tissue) {
    return std::abs(tissue.direction_m[1]) >= std::abs(tissue.direction_m[0]) ? 1 : 0;
}

std::array<double, 2> in_design(const PartDesign& design, const Eigen::Vector2d& p_m) {
    return {p_m.x() - design.origin_m.x(), p_m.y() - design.origin_m.y()};
}

// The pen came down: its proxy comes from outside, along the load.
void begin_touch(const PartTissue& tissue, const Press& press, PartWork& work) {
    work.down = true;
    work.from_m = press.p_m;
    work.design = 0;
    if (tissue.designs.size() > 1) {
        const auto far = [&](const PartDesign& design) {
            return std::abs(press.p_m.y() - design.origin_m.y() - 0.5 * design.size_m.y());
        };
        work.design = far(tissue.designs[1]) < far(tissue.designs[0]) ? 1 : 0;
    }
    const PartDesign& design = tissue.designs[work.design];
    work.proxy_m = in_design(design, press.p_m);
    if (!in_plane(tissue)) return;
    const auto axis = static_cast<std::size_t>(pressed_axis(tissue));
    const double voxel_m = design.part.voxels.frame.pitch_m;
    const double outside_m = tissue.direction_m[axis] < 0.0 ? design.size_m[pressed_axis(tissue)] + voxel_m : -voxel_m;
    work.proxy_m[axis] = tissue.direction_m[axis] < 0.0 ? std::max(outside_m, work.proxy_m[axis])
                                                        : std::min(outside_m, work.proxy_m[axis]);
}

// In a picture that the load goes into, the part is under the pen if there is material in that line.
bool material_below(const PartDesign& design, const std::array<double, 2>& at_m) {
    const mechanics::Voxels& voxels = design.part.voxels;
    const std::size_t third = 3 - static_cast<std::size_t>(design.slice.view[0] + design.slice.view[1]);
    parts::Slice slice = design.slice;
    const double pitch_m = voxels.frame.pitch_m;
    const int i = static_cast<int>(std::floor(std::clamp(at_m[0] / pitch_m, -1.0, 1e6)));
    const int j = static_cast<int>(std::floor(std::clamp(at_m[1] / pitch_m, -1.0, 1e6)));
    for (slice.depth = 0; slice.depth < voxels.size[third]; ++slice.depth) {
        if (parts::filled_at(voxels, slice, i, j)) return true;
    }
    return false;
}

void move_proxy(const PartTissue& tissue, const Press& press, PartWork& work) {
    const PartDesign& design = tissue.designs[work.design];
    const std::array<double, 2> pen_m = in_design(design, press.p_m);
    if (!in_plane(tissue)) {
        work.proxy_m = pen_m;
        work.touching = material_below(design, pen_m);
        return;
    }
    parts::follow_pen(design.part.voxels, design.slice, pen_m, work.proxy_m);
    const int axis = pressed_axis(tissue);
    const int sign = tissue.direction_m[axis] > 0.0 ? 1 : -1;
    work.touching = parts::rests_on(design.part.voxels, design.slice, axis, sign, work.proxy_m);
}

// Where along its axis the proxy stands, in each design; the load's own place for a part without one.
StationPlace station_of(const PartTissue& tissue, std::size_t design, const PartWork& work) {
    const PartDesign& its = tissue.designs[design];
    const Response& response = its.responses[work.method];
    const double named_m = response.station_m[response.named];
    if (!its.part.axis) return place_of(response, named_m);
    for (std::size_t k = 0; k < 2; ++k) {
        if (its.slice.view[k] == *its.part.axis) return place_of(response, work.proxy_m[k]);
    }
    return place_of(response, named_m);
}

void load_design(const PartTissue& tissue, std::size_t i, double force_N, PartWork& work) {
    const PartDesign& design = tissue.designs[i];
    work.force_N[i] = force_N;
    if (design.button) {
        mechanics::move_button(*design.button, force_N, work.button[i]);
        work.depth_m[i] = work.button[i].travel_m;
        return;
    }
    work.station[i] = station_of(tissue, i, work);
    work.depth_m[i] = force_N * parts::compliance_at(design.responses[work.method], work.station[i]);
}

void end_touch(const PartTissue& tissue, PartWork& work) {
    work.down = work.touching = false;
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) load_design(tissue, i, 0.0, work);
}

void press_part(const PartTissue& tissue, const Press& press, PartWork& work, Contact& contact) {
    move_proxy(tissue, press, work);
    // forces are scaled instead of stiffnesses
    const double force_N = work.touching ? press.force_N / press.stiffness_scale : 0.0;
    for (std::size_t i = 0; i < tissue.designs.size(); ++i)
        load_design(tissue, i, i == work.design || tissue.options.both ? force_N : 0.0, work);
    contact.depth_m = work.depth_m[work.design];
    contact.measured = work.touching;
    contact.saturated = tissue.designs[work.design].button && work.button[work.design].stopped;
    if (!work.touching) contact.normal_N = 0.0;
}

// A finger that leads the button by its travel; it goes on and off as under a force, and is pushed as when pressed.
Push push_button(const mechanics::ButtonCurve& curve, double travel_m, mechanics::ButtonState& state) {
    constexpr double kStep = 1e-4;  // of the travel, for the slope
    state.stopped = travel_m >= curve.travel_m;
    state.travel_m = std::min(travel_m, curve.travel_m);
    if (curve.on_m && !state.on && state.travel_m >= *curve.on_m) ++state.switched, state.on = true;
    if (curve.off_m && state.on && state.travel_m < *curve.off_m) state.on = false;
    const auto force_N = [&](double at_m) { return mechanics::press_force_N(curve, state.on, at_m); };
    const double h = kStep * curve.travel_m;
    const double low_m = std::max(0.0, state.travel_m - h), high_m = std::min(curve.travel_m, state.travel_m + h);
    return {.force_N = force_N(state.travel_m),
            .slope_N_per_m = (force_N(high_m) - force_N(low_m)) / (high_m - low_m),
            .depth_m = state.travel_m,
            .saturated = state.stopped};
}

RiseOnPart rise_of(const PartTissue& tissue, const PartWork& work) {
    const PartDesign& design = tissue.designs[work.design];
    RiseOnPart out{0.0, work.from_m, direction_of(tissue)};
    if (!work.touching || design.responses.empty()) return out;
    const double compliance = parts::compliance_at(design.responses[work.method], work.station[work.design]);
    if (compliance > 0.0) out.stiffness_N_per_m = 1.0 / compliance;
    return out;
}

// The drag moves the part as far as the pen goes along the load's direction.
void pull_part(const PartTissue& tissue, const Press& press, PartWork& work, Contact& contact) {
    const double dragged_m = std::max(0.0, (press.p_m - work.from_m).dot(direction_of(tissue)));
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) {
        const bool moves = work.touching && (i == work.design || tissue.options.both);
        const double compliance = parts::compliance_at(tissue.designs[i].responses[work.method], work.station[i]);
        work.depth_m[i] = moves ? dragged_m : 0.0;
        work.force_N[i] = moves && compliance > 0.0 ? dragged_m / compliance : 0.0;
    }
    contact.depth_m = work.depth_m[work.design];
    contact.measured = work.touching;
}

// A pull holds the part where the touch began.
void grip_part(const PartTissue& tissue, const Press& press, PartWork& work) {
    const PartDesign& design = tissue.designs[work.design];
    work.proxy_m = in_design(design, press.p_m);
    work.touching = material_below(design, work.proxy_m);
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) work.station[i] = station_of(tissue, i, work);
}

}  // namespace

bool in_plane(const PartTissue& tissue) { return tissue.direction_m[0] != 0.0 || tissue.direction_m[1] != 0.0; }

bool is_on_part(const PartDesign& design, const Eigen::Vector2d& p_m) {
    return material_below(design, in_design(design, p_m));
}

double RiseOnPart::resistance_N(const Eigen::Vector2d& p_m) const {
    return stiffness_N_per_m * std::max(0.0, (p_m - from_m).dot(direction));
}

double RiseOnPart::operator()(const Eigen::Vector2d& p_m, const Eigen::Vector2d& u, double reference_m) const {
    return (resistance_N(p_m) - resistance_N(p_m - reference_m * u)) * u.dot(direction);
}

PartWork make_work(const PartTissue& tissue) {
    PartWork work;
    work.method = tissue.first_method;
    return work;
}

void answer(const PartTissue& tissue, StageId stage, const Press& press, PartWork& work, Contact& contact) {
    if (stage == StageId::tangential) {
        if (work.down && tissue.options.gesture == PartGesture::pull)
            contact.tangential_N = press.stiffness_scale * rise_of(tissue, work).resistance_N(press.p_m) *
                                   press.heading.dot(direction_of(tissue));
        return;
    }
    if (stage != StageId::depth) return;
    const bool down = press.down && std::isfinite(press.force_N) && press.p_m.allFinite();
    if (!down) return end_touch(tissue, work);
    if (!work.down) {
        begin_touch(tissue, press, work);
        if (tissue.options.gesture == PartGesture::pull) grip_part(tissue, press, work);
    }
    if (tissue.options.gesture == PartGesture::pull) return pull_part(tissue, press, work, contact);
    press_part(tissue, press, work, contact);
}

double rise_N(const PartTissue& tissue, const Station& station, PartWork& work) {
    if (tissue.options.gesture != PartGesture::pull || !work.down) return 0.0;
    return station.stiffness_scale * rise_of(tissue, work)(station.p_m, station.u, station.reference_m);
}

Push push_to(const PartTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, PartWork& work) {
    begin_touch(tissue, {.p_m = p_m}, work);
    const PartDesign& design = tissue.designs[work.design];
    if (design.button) return push_button(*design.button, depth_m, work.button[work.design]);
    work.proxy_m = in_design(design, p_m);
    const double compliance =
        parts::compliance_at(design.responses[work.method], station_of(tissue, work.design, work));
    return {.force_N = depth_m / compliance, .slope_N_per_m = 1.0 / compliance, .depth_m = depth_m};
}

void sample_surface(const PartTissue&, const SurfaceEffect&, const Contact& contact, const PartWork&,
                    SurfaceShape& shape) {
    shape.curve.reset();  // it has no surface to draw: prepare() refuses scenes that ask for one
    shape.centre_m = contact.p_m;
    shape.n_x = shape.n_y = 0;
}

std::optional<PartDoubt> doubt_of(const PartTissue& tissue, const PartWork& work, std::size_t design) {
    const PartDesign& its = tissue.designs[design];
    if (its.button) return std::nullopt;
    const Response& response = its.responses[work.method];
    if (response.validity.to_m == 0.0) return PartDoubt{0.0, response.validity.why_not};
    const double to_m = parts::applies_to_m(response, work.station[design]);
    if (!(work.depth_m[design] > to_m)) return std::nullopt;
    return PartDoubt{to_m, response.validity.why_not};
}

const char* next_method(const PartTissue& tissue, PartWork& work) {
    if (work.down || tissue.methods.size() < 2) return nullptr;
    work.method = (work.method + 1) % tissue.methods.size();
    // each method has stations of its own, beams more than cells
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) work.station[i] = station_of(tissue, i, work);
    return parts::name_of(tissue.methods[work.method]);
}

std::optional<std::int64_t> switch_events(const PartTissue& tissue, const PartWork& work) {
    std::int64_t events = 0;
    bool any = false;
    for (std::size_t i = 0; i < tissue.designs.size(); ++i) {
        any = any || tissue.designs[i].button;
        events += work.button[i].switched;
    }
    return any ? std::optional(events) : std::nullopt;
}

}  // namespace palpa::scene
