#include "tactile/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "files/input_error.h"
#include "files/text.h"
#include "scene/tissue.h"
#include "tactile/finger_file.h"

namespace palpa::tactile {
namespace {

using scene::ArmImpedance;
using scene::DisplayKind;

mechanics::PinGrid grid_of(const std::optional<devices::PinDevice>& device) {
    mechanics::PinGrid grid;
    if (!device) return grid;
    grid.rows = device->rows;
    grid.columns = device->columns;
    grid.pitch_m = device->pitch_m;
    grid.diameter_m = device->diameter_m;
    grid.stroke_m = device->stroke_m;
    grid.step_m = device->step_m;
    grid.speed_m_per_s = device->speed_m_per_s;
    return grid;
}

mechanics::PinShapeOptions shape_options(const scene::DisplayOptions& display) {
    mechanics::PinShapeOptions options;
    options.zero = static_cast<mechanics::PinZero>(display.zero);
    options.over_stroke = static_cast<mechanics::OverStroke>(display.over_stroke);
    options.sheet = static_cast<mechanics::Sheet>(display.sheet);
    options.dither = display.dither;
    return options;
}

mechanics::Finger finger_of(const scene::FingerOptions& options) {
    mechanics::Finger finger;
    finger.contact = static_cast<mechanics::FingerContact>(options.contact);
    finger.diameter_m = options.diameter_m;
    if (!options.pad.empty()) finger.pad = read_pad_law(options.pad);
    return finger;
}

TableOptions table_options(const TactilePlan& plan) {
    TableOptions options;
    options.spacing_m = plan.options.table->spacing_m;
    options.error = plan.options.table->error;
    return options;
}

void take_arm(const scene::ArmOptions& options, const std::string& scene_file, TactilePlan& plan) {
    if (options.device.empty()) return;
    plan.arm = devices::read_arm_device(options.device);
    const bool high = options.impedance == ArmImpedance::high;
    if (high != (plan.arm->impedance == devices::ArmImpedance::high)) {
        throw files::bad_input(scene_file, "tactile.arm.impedance", name_of(options.impedance),
                               "that of the device " + plan.arm->name + ", " +
                                   (high ? name_of(ArmImpedance::low) : name_of(ArmImpedance::high)));
    }
    if (high && !plan.arm->sensor) {
        throw files::bad_input(scene_file, "tactile.arm.device",
                               "a high-impedance arm without a force sensor (" + plan.arm->name + ")",
                               "a force sensor between the arm and the display: the force is the input");
    }
    if (!high && !plan.arm->compensation.empty()) plan.compensation = read_compensation(plan.arm->compensation);
}

void take_display(const scene::DisplayOptions& options, TactilePlan& plan) {
    if (options.kind != DisplayKind::shape) {
        plan.pressure_m = mechanics::make_pin_shape({}, {}).pin_m;
        return;
    }
    if (!options.device.empty()) plan.pin_device = devices::read_pin_device(options.device);
    plan.pins = mechanics::make_pin_shape(grid_of(plan.pin_device), shape_options(options));
    plan.pin_dynamics.speed_m_per_s = plan.pins->grid.speed_m_per_s;
    if (plan.pin_device) plan.pin_dynamics.frame_s = plan.pin_device->frame_s;
    plan.pin_rest_m = plan.pin_device ? plan.pin_device->rest_m : mechanics::rest_height_m(*plan.pins);
}

// The steepest of twenty steps up to the force limit.
double greatest_stiffness_N_per_m(const Eigen::Vector2d& middle_m, const TactilePlan& plan) {
    RendererWork work = make_work(plan.renderer);
    constexpr int kSteps = 20;
    double greatest = 0.0, force_N = 0.0, depth_m = 0.0;
    for (int i = 1; i <= kSteps; ++i) {
        const Press press = press_with_force(plan.renderer, middle_m, plan.options.force_limit_N * i / kSteps, work);
        if (!(press.depth_m > depth_m)) continue;
        greatest = std::max(greatest, (press.force_N - force_N) / (press.depth_m - depth_m));
        force_N = press.force_N;
        depth_m = press.depth_m;
    }
    return greatest;
}

// Presses the middle of the tissue lightly, then up to the force limit.
void try_middle(const Eigen::Vector2d& middle_m, TactilePlan& plan) {
    RendererWork work = make_work(plan.renderer);
    const double force_N = 0.1 * plan.options.force_limit_N;
    const Press press = press_with_force(plan.renderer, middle_m, force_N, work);
    if (!(press.depth_m > 0.0) || !(press.force_N > 0.0)) return;
    plan.stiffness_N_per_m = press.force_N / press.depth_m;
    plan.greatest_stiffness_N_per_m = greatest_stiffness_N_per_m(middle_m, plan);
    if (!plan.pins || plan.options.display->schedule == scene::PinSchedule::locked) return;
    Eigen::VectorXd sink_m(plan.pins->pin_m.cols());
    shape_m(plan.renderer, work, sink_m);
    plan.stroke_used_up_N =
        mechanics::stroke_used_up_at_N(*plan.pins, press.depth_m / press.force_N, sink_m / press.force_N);
    if (plan.options.finger.contact == scene::FingerContact::parabola) return;
    // the contact of the others widens with the force, and the shape grows less than it
    const auto fits = [&](double at_N) {
        const Press there = press_with_force(plan.renderer, middle_m, at_N, work);
        shape_m(plan.renderer, work, sink_m);
        mechanics::PinReport report;
        Eigen::VectorXd height_m(sink_m.size());
        mechanics::pins_from_sinks_m(*plan.pins, there.depth_m, sink_m, height_m, report);
        return report.clipped == 0 && report.scale > 1.0 - 1e-9;
    };
    plan.stroke_used_up_N = std::numeric_limits<double>::infinity();
    if (fits(plan.options.force_limit_N)) return;
    double low_N = 0.0, high_N = plan.options.force_limit_N;
    while (high_N - low_N > 1e-4 * plan.options.force_limit_N) {
        const double middle_N = 0.5 * (low_N + high_N);
        (fits(middle_N) ? low_N : high_N) = middle_N;
    }
    plan.stroke_used_up_N = high_N;
}

void add_plan_notes(TactilePlan& plan) {
    if (plan.pins && plan.stroke_used_up_N < plan.options.force_limit_N) {
        plan.notes.push_back("in the middle of the tissue the pins' stroke is used up at " +
                             files::short_number(plan.stroke_used_up_N) + " N; from there on shapes are " +
                             (plan.options.display->over_stroke == scene::OverStroke::clip ? "cut off" : "scaled"));
    }
    if (plan.pins && !plan.pin_device) plan.notes.push_back("the pins are only drawn: the display has no device");
    if (plan.options.arm && !plan.arm) plan.notes.push_back("the arm has no device: its force is computed and logged");
}

TactilePlan plan_of_devices(const scene::TactileOptions& options, const std::string& file) {
    TactilePlan plan;
    plan.options = options;
    if (options.arm) take_arm(*options.arm, file, plan);
    if (options.display) take_display(*options.display, plan);
    const bool high = options.arm && options.arm->impedance == ArmImpedance::high;
    plan.input = high ? InputKind::force : InputKind::depth;
    return plan;
}

// Enough points that lines between them follow the law to about 1e-6 of the greatest force.
DepthForce points_of(const scene::ForceCurve& curve) {
    if (!curve.depth_m.empty())
        return {{curve.depth_m.begin() + 1, curve.depth_m.end()}, {curve.force_N.begin() + 1, curve.force_N.end()}};
    constexpr int kPoints = 1000;
    DepthForce points;
    for (int k = 1; k <= kPoints; ++k) {
        points.depth_m.push_back(curve.greatest_depth_m * k / kPoints);
        points.force_N.push_back(scene::force_at_N(curve, points.depth_m.back()));
    }
    return points;
}

void finish(const Eigen::Vector2d& middle_m, const std::string& tissue, TactilePlan& plan) {
    try_middle(middle_m, plan);
    add_plan_notes(plan);
    plan.stages = stages_of(plan, tissue);
}

}  // namespace

TactilePlan make_tactile_plan(const scene::Scene& scene, const scene::Plan& scene_plan) {
    const std::string file = scene.file.empty() ? scene.name : scene.file.string();  // a map has no file of a scene
    if (!scene.tactile)
        throw files::bad_input(file, "tactile", "no such key", "one that says which arm or display there is");
    if (const scene::ForceCurve* curve = scene::curve_of(scene_plan.tissue))
        return make_tactile_plan(*scene.tactile, points_of(*curve), scene.stiffness_scale, scene_plan.tissue_name,
                                 file);
    const scene::LinearTissue* block = scene::block_of(scene_plan.tissue);
    if (block == nullptr)
        throw files::bad_input(file, "tactile", "a tissue without a surface", "linear: a map knows no surface");
    TactilePlan plan = plan_of_devices(*scene.tactile, file);
    plan.renderer = make_renderer(*block, finger_of(plan.options.finger), scene.stiffness_scale,
                                  plan.options.force_limit_N, plan.pins ? observation_of(*plan.pins) : Observation{});
    finish(scene_plan.area.centre_m, std::to_string(block->mesh_nodes) + " nodes", plan);
    return plan;
}

TactilePlan make_tactile_plan(const scene::TactileOptions& options, DepthForce curve, double stiffness_scale,
                              const std::string& tissue, const std::string& file) {
    if (options.display)
        throw files::bad_input(file, "tactile.display", "a display", "none: " + tissue + " knows no surface to show");
    TactilePlan plan = plan_of_devices(options, file);
    plan.renderer = make_renderer(std::move(curve), stiffness_scale, options.force_limit_N);
    finish(Eigen::Vector2d::Zero(), tissue, plan);
    return plan;
}

void make_table_now(const std::filesystem::path& cache, const mechanics::Progress& progress, TactilePlan& plan) {
    if (!plan.options.table || plan.renderer.compliance == nullptr) return;
    auto table = std::make_shared<const Table>(make_table(plan.renderer, table_options(plan), cache, progress));
    if (!table->note.empty()) plan.notes.push_back(table->note);
    if (table->good) plan.table = std::move(table);
}

void make_table_meanwhile(const std::filesystem::path& cache, TactilePlan& plan) {
    if (plan.options.table && plan.renderer.compliance != nullptr)
        plan.table_to_be = std::make_shared<const TableInProgress>(plan.renderer, table_options(plan), cache);
}

const Table* table_of(const TactilePlan& plan) noexcept {
    return plan.table_to_be ? plan.table_to_be->ready() : plan.table.get();
}

}  // namespace palpa::tactile
