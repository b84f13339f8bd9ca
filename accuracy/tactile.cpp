#include "accuracy/tactile.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "accuracy/mechanics_blocks.h"
#include "files/text.h"
#include "mechanics/layer.h"
#include "mechanics/sheet.h"
#include "tactile/motion.h"
#include "tactile/pin_estimate.h"
#include "tactile/table.h"

namespace palpa::accuracy {

using namespace mechanics;
using Eigen::Vector2d;
using Eigen::VectorXd;
using tactile::Renderer;
using tactile::RendererWork;
using tactile::Table;

namespace {

constexpr Material kFingerTissue{17500.0, 0.45};  // 0.30 N/mm under a finger of 16 mm
constexpr double kStroke_m = 2e-3;

std::string text_mm(double metres) { return files::short_number(1e3 * metres) + " mm"; }

// The slab of the paper, or a wide one, graded about its middle; what is touched is a square about it.
scene::LinearTissue finger_slab(double width_m, int cells, double finest_m, double half_m, AccuracyRow& row) {
    const Mesh mesh =
        hex_box(Box{{width_m, width_m, 0.05}, {cells, cells, 8}, Grading{{0.5 * width_m, 0.5 * width_m}, finest_m}});
    const Problem problem = block(mesh, Element::hex8_bbar, kFingerTissue);
    const double middle_m = 0.5 * width_m;
    const SurfaceRequest request =
        request_rectangle(problem.mesh, boundary_faces(problem.mesh),
                          {middle_m - half_m, middle_m + half_m, middle_m - half_m, middle_m + half_m});
    scene::LinearTissue out;
    set_offline(time_calls(1, 1, 0.0,
                           [&](int) {
                               const Factored factored = factorise(problem, best_solver());
                               set_size(problem, factored, row);
                               out.compliance = surface_compliance(problem.mesh, factored, request);
                           }),
                row);
    row.memory_MB = compliance_MB(out.compliance);
    return out;
}

// A hand over a patch of +-4 mm at 1 kHz: place and depth.
Vector2d hand_m(int k, double middle_m) {
    return {middle_m + 4e-3 * std::sin(2e-3 * k), middle_m + 4e-3 * std::sin(2.7e-3 * k)};
}
double hand_depth_m(int k) { return 2e-3 + 1.5e-3 * std::sin(7e-3 * k); }

Eigen::Matrix2Xd pin_places_m() { return make_pin_shape({}, {}).pin_m; }

// Depth and surface at the pins against the exact layer, on a slab 400 mm wide.
AccuracyRow depth_row(int cells, double finest_m, const Effort& effort) {
    AccuracyRow row{.group = "finger depth", .series = "parabola on hex8-bbar"};
    row.choice = "finest " + text_mm(finest_m);
    row.reference = "exact bonded layer (Hankel integral): depth; worst also over the surface at 36 pins";
    row.reference_error_percent = 0.1;
    const scene::LinearTissue slab = finger_slab(0.4, cells, finest_m, 16e-3, row);
    const Renderer renderer = tactile::make_renderer(slab, {}, 1.0, 2.5, {pin_places_m(), {}});
    RendererWork work = tactile::make_work(renderer);
    const Vector2d middle_m(0.2, 0.2);
    VectorXd u_m(36);
    const Layer layer{kFingerTissue.young_Pa, kFingerTissue.poisson, 0.05};
    const ParabolicPatch patch{8e-3, 0.5};
    const double depth_m = tactile::press_with_force(renderer, middle_m, patch.force_N, work).depth_m;
    shape_m(renderer, work, u_m);
    row.error_percent = 100.0 * (depth_m / layer_mean_depression_m(layer, patch) - 1.0);
    double worst = std::abs(row.error_percent);
    for (int k = 0; k < 36; ++k) {
        const double exact_m = layer_depression_m(layer, patch, renderer.observed.points_m.col(k).norm());
        worst = std::max(worst, 100.0 * std::abs(u_m(k) / exact_m - 1.0));
    }
    row.worst_error_percent = worst;
    set_steps(time_calls(1000, 20000, effort.steps_s,
                         [&](int k) {
                             tactile::press_to_depth(renderer, hand_m(k, 0.2), hand_depth_m(k), work);
                             shape_m(renderer, work, u_m);
                         }),
              row);
    return row;
}

// A pad of constant modulus on rigid ground against Hertz, by spacings across the contact's radius.
AccuracyRow hertz_pad_row(double spacings, const Effort& effort) {
    constexpr int kNodes = 25;
    const double spacing_m = 0.5e-3;
    Compliance rigid;
    rigid.revision = new_revision();
    rigid.n_touch = kNodes * kNodes;
    rigid.position_m.setZero(3, rigid.n_touch);
    for (int k = 0; k < rigid.n_touch; ++k)
        rigid.position_m.col(k) << k % kNodes * spacing_m, k / kNodes * spacing_m, 1.0;
    rigid.area_m2.setConstant(rigid.n_touch, spacing_m * spacing_m);
    rigid.surface_z_m = rigid.thickness_m = 1.0;
    rigid.normal_m_per_N.setZero(rigid.n_touch, rigid.n_touch);
    const Finger finger{FingerContact::pad, 40e-3, {60e3, 0.0, 0.5}};
    AccuracyRow row{.group = "finger pad", .series = "pad against Hertz"};
    row.choice = files::short_number(spacings) + " spacings across the contact's radius";
    row.reference = "Hertz, force at the same approach, nine places of the finger between nodes";
    row.nodes = rigid.n_touch;
    FingerWork work = make_finger_work(rigid, finger);
    const double approach_m = std::pow(spacings * spacing_m, 2.0) / 20e-3;
    const double force_N = hertz_force_N(pad_modulus_Pa(finger.pad, 0.0), 20e-3, approach_m);
    const auto between_nodes = [&](int k, int axis) {
        const int step = axis == 0 ? k % 3 : k / 3 % 3;
        return (12.0 + 0.25 * step) * spacing_m;
    };
    ErrorSum sum;
    for (int k = 0; k < 9; ++k) {
        finger_with_force(rigid, finger, {between_nodes(k, 0), between_nodes(k, 1)}, force_N, work);
        // the force that Hertz has at the approach that was found
        add_error(force_N / hertz_force_N(pad_modulus_Pa(finger.pad, 0.0), 20e-3, work.contact.tool[0].depth_m) - 1.0,
                  sum);
    }
    set_error(sum, row);
    set_steps(time_calls(1000, 20000, 0.2 * effort.steps_s,
                         [&](int k) {
                             finger_with_force(rigid, finger, {between_nodes(k, 0), between_nodes(k, 1)},
                                               force_N * (1.0 + 0.1 * std::sin(0.01 * k)), work);
                         }),
              row);
    return row;
}

const char* name_of(FingerContact contact) {
    constexpr const char* kNames[] = {"parabola", "rigid", "pad"};
    return kNames[static_cast<int>(contact)];
}

// What the mesh does to the force while a finger slides 6 mm over plain tissue at one depth.
AccuracyRow ripple_row(const scene::LinearTissue& slab, FingerContact contact, double finest_m, const Effort& effort,
                       AccuracyRow row) {
    row.group = "finger ripple";
    row.series = name_of(contact);
    row.choice = std::string(name_of(contact)) + ", finest " + text_mm(finest_m);
    row.reference = "mean force of a slide of 6 mm over plain tissue, 3 mm deep";
    const Renderer renderer = tactile::make_renderer(slab, {contact, 16e-3, {}}, 1.0, 50.0, {pin_places_m(), {}});
    RendererWork work = tactile::make_work(renderer);
    std::vector<double> force_N;
    for (int k = 0; k < 600; ++k)
        force_N.push_back(tactile::press_to_depth(renderer, {0.047 + 1e-5 * k, 0.0503}, 3e-3, work).force_N);
    double mean_N = 0.0;
    for (const double f : force_N) mean_N += f / static_cast<double>(force_N.size());
    ErrorSum sum;
    for (const double f : force_N) add_error(f / mean_N - 1.0, sum);
    set_error(sum, row);
    VectorXd u_m(36);
    set_steps(time_calls(1000, 20000, effort.steps_s,
                         [&](int k) {
                             tactile::press_to_depth(renderer, hand_m(k, 0.05), hand_depth_m(k), work);
                             shape_m(renderer, work, u_m);
                         }),
              row);
    return row;
}

// A table by the error that is asked of it.
AccuracyRow table_row(const scene::LinearTissue& slab, double error, double shape_error_m, const Effort& effort) {
    AccuracyRow row{.group = "finger table", .series = "parabola"};
    row.choice = "asked " + files::short_number(100.0 * error) + " % and " + text_mm(shape_error_m);
    row.reference = "live answers at places of chance: force over the force limit";
    const Renderer renderer = tactile::make_renderer(slab, {}, 1.0, 2.5, {pin_places_m(), {}});
    tactile::TableOptions options;
    options.error = error;
    options.shape_error_m = shape_error_m;
    Table table;
    set_offline(time_calls(1, 1, 0.0, [&](int) { table = tactile::make_table(renderer, options, {}); }), row);
    RendererWork live = tactile::make_work(renderer);
    RendererWork fast = tactile::make_work(renderer);
    if (table.good) adopt(&table, fast);
    VectorXd live_m(36);
    VectorXd fast_m(36);
    ErrorSum sum;
    double shape_worst_m = 0.0;
    for (int k = 0; k < 400; ++k) {
        const Vector2d place_m(0.012 + 0.076 * std::fmod(0.6180339887 * k, 1.0),
                               0.012 + 0.076 * std::fmod(0.7548776662 * k, 1.0));
        const tactile::Press truth = tactile::press_with_force(renderer, place_m, 0.1 + 0.006 * k, live);
        const tactile::Press answer = tactile::press_to_depth(renderer, place_m, truth.depth_m, fast);
        add_error((answer.force_N - truth.force_N) / renderer.force_limit_N, sum);
        shape_m(renderer, live, live_m);
        shape_m(renderer, fast, fast_m);
        shape_worst_m = std::max(shape_worst_m, (live_m - fast_m).cwiseAbs().maxCoeff());
    }
    set_error(sum, row);
    row.memory_MB = 4e-6 * static_cast<double>(table.value_m.size() + table.depth_m.size() + table.linearity.size());
    row.nodes = table.count[0] * table.count[1];
    row.note = table.good ? "shape " + text_mm(shape_worst_m) + " at worst; nodes: places of the table" : table.note;
    set_steps(time_calls(1000, 20000, effort.steps_s,
                         [&](int k) {
                             tactile::press_to_depth(renderer, hand_m(k, 0.05), hand_depth_m(k), fast);
                             shape_m(renderer, fast, fast_m);
                         }),
              row);
    return row;
}

// What arrives on top of the sheet against what is wanted there, on 21 x 21 points of the pins' square.
double shown_error_m(const PinShape& shape, const Eigen::MatrixXd& top, const Eigen::Matrix2Xd& top_m, bool inverse,
                     const std::function<double(double)>& wanted_m) {
    const auto at = [&](const Eigen::Matrix2Xd& points_m) {
        VectorXd out(points_m.cols());
        for (Eigen::Index k = 0; k < out.size(); ++k) out(k) = wanted_m(points_m.col(k).norm());
        return out;
    };
    VectorXd sink_m = at(shape.pin_m);
    if (inverse) pin_sinks_m(shape, at(shape.sample_m), sink_m);
    const VectorXd miss_m = top * sink_m - at(top_m);
    return std::sqrt(miss_m.squaredNorm() / static_cast<double>(miss_m.size()));
}

void sheet_rows(Sheet sheet, std::vector<AccuracyRow>& rows) {
    Eigen::Matrix2Xd top_m(2, 441);
    for (int k = 0; k < 441; ++k) top_m.col(k) << 0.5e-3 * (k % 21 - 10), 0.5e-3 * (k / 21 - 10);
    const Layer layer{kFingerTissue.young_Pa, kFingerTissue.poisson, 0.05};
    const auto depression_m = [&](double r) { return layer_depression_m(layer, {8e-3, 1.0}, r); };
    const double bowl = kStroke_m / (depression_m(0.0) - depression_m(std::hypot(5e-3, 5e-3)));
    const auto bump_m = [](double r) { return 1e-3 * std::exp(-std::pow(r / 1.5e-3, 2.0)); };
    for (const double penalty : {0.0, 1e-1, 1e-2, 1e-3}) {
        PinShapeOptions options;
        options.sheet = sheet;
        if (penalty > 0.0) options.penalty = penalty;
        PinShape shape;
        AccuracyRow row{.group = "sheet", .series = sheet == Sheet::free ? "free top" : "backed by the finger"};
        row.choice = penalty > 0.0 ? "inverse, penalty " + files::short_number(penalty) : "surface at the pins";
        row.reference =
            "bowl of 2 mm on 6 x 6 pins, sheet 2 mm, rms over the stroke; worst: bump of 1 mm and 3 mm width";
        set_offline(time_calls(1, 1, 0.0, [&](int) { shape = make_pin_shape({}, options); }), row);
        const Eigen::MatrixXd top = sheet_forward(shape.grid, sheet, options.sheet_thickness_m, top_m);
        row.error_percent = 100.0 / kStroke_m * shown_error_m(shape, top, top_m, penalty > 0.0, [&](double r) {
                                return bowl * depression_m(r);
                            });
        row.worst_error_percent = 100.0 / kStroke_m * shown_error_m(shape, top, top_m, penalty > 0.0, bump_m);
        const VectorXd u_m = VectorXd::LinSpaced(shape.sample_m.cols(), 0.0, 1e-3);
        VectorXd sink_m(36);
        if (penalty > 0.0) set_steps(time_calls(2000, 2000, 1.0, [&](int) { pin_sinks_m(shape, u_m, sink_m); }), row);
        rows.push_back(row);
    }
}

// Held still at 40 heights for a second each: the mean over a second is what a slow touch feels.
AccuracyRow steps_row(bool dither) {
    PinShapeOptions options;
    options.dither = dither;
    PinGrid grid;
    grid.rows = grid.columns = 1;
    const PinShape shape = make_pin_shape(grid, options);
    AccuracyRow row{.group = "steps", .series = dither ? "dither" : "rounding"};
    row.choice = std::string(dither ? "dithered" : "rounded") + ", 0.1 mm, 50 frames a second";
    row.reference = "wanted height, mean over a second; in per cent of the stroke";
    ErrorSum sum;
    for (int k = 0; k < 40; ++k) {
        const double wanted_m = kStroke_m * (k + 0.37) / 40.0;
        VectorXd carried_m = VectorXd::Zero(1);
        double mean_m = 0.0;
        for (int frame = 0; frame < 50; ++frame) {
            VectorXd height_m = VectorXd::Constant(1, wanted_m);
            round_to_steps_m(shape, carried_m, height_m);
            mean_m += height_m(0) / 50.0;
        }
        add_error((mean_m - wanted_m) / kStroke_m, sum);
    }
    set_error(sum, row);
    row.note = "the servos' own dead band is not known";
    return row;
}

AccuracyRow schedule_row(double speed_m_per_s, double lead_s, bool dither) {
    AccuracyRow row{.group = "schedule", .series = lead_s > 0.0 ? "lead" : "free"};
    row.choice = std::string(lead_s > 0.0 ? "lead 20 ms" : "free") + (dither ? ", dithered, " : ", ") +
                 files::short_number(1e3 * speed_m_per_s) + " mm/s";
    row.reference = "wanted height, rms over presses of 4 mm, in per cent of the stroke; servos assumed";
    const double mismatch_m = schedule_mismatch_m(speed_m_per_s, lead_s, dither);
    row.error_percent = 100.0 * mismatch_m / kStroke_m;
    row.note = text_mm(mismatch_m);
    return row;
}

}  // namespace

double schedule_mismatch_m(double speed_m_per_s, double lead_s, bool dither) {
    constexpr double kPress_m = 4e-3;
    constexpr double kGain = 0.4;  // height per depth, as at the corner of 6 x 6 pins
    constexpr double kTick_s = 1e-3;
    PinShapeOptions options;
    options.dither = dither;
    PinGrid grid;
    grid.rows = grid.columns = 1;
    const PinShape shape = make_pin_shape(grid, options);
    // depth = press/2 (1 - cos w t), whose greatest speed is w press/2
    const double w = 2.0 * speed_m_per_s / kPress_m;
    const auto depth_m = [&](double t) { return 0.5 * kPress_m * (1.0 - std::cos(w * t)); };
    const auto height_of = [&](double depth) { return kGain * depth; };
    tactile::Motion motion;
    tactile::PinEstimate pin;
    const tactile::PinDynamics dynamics;
    VectorXd carried_m = VectorXd::Zero(1);
    const int ticks = static_cast<int>(4.0 * 2.0 * std::numbers::pi / w / kTick_s);  // four presses
    double sum = 0.0;
    for (int k = 0; k < ticks; ++k) {
        const double t = kTick_s * k;
        remember({t, 0.0, 0.0, depth_m(t)}, motion);
        VectorXd height_m = VectorXd::Constant(1, height_of(lead_s > 0.0 ? ahead(motion, lead_s).value : depth_m(t)));
        round_to_steps_m(shape, carried_m, height_m);
        tactile::estimate_pins(dynamics, 0.0, t, {height_m.data(), 1}, pin);
        sum += std::pow(pin.height_m[0] - height_of(depth_m(t)), 2.0);
    }
    return std::sqrt(sum / ticks);
}

std::vector<Measurement> tactile_measurements(const Effort& effort) {
    std::vector<Measurement> list;
    struct Wide {
        int cells;
        double finest_m;
    };
    std::vector<Wide> wides{{26, 2.5e-3}, {32, 1.8e-3}};
    if (!effort.quick) wides.insert(wides.end(), {{36, 1.4e-3}, {42, 1.0e-3}});
    for (const Wide& wide : wides)
        list.push_back({"finger on a wide slab, finest " + text_mm(wide.finest_m),
                        1.0 + 1e-8 / std::pow(wide.finest_m, 3.0),
                        [=](auto& rows) { rows.push_back(depth_row(wide.cells, wide.finest_m, effort)); }});
    for (const double spacings : {2.1, 4.1, 6.1, 8.1})
        list.push_back(
            {"pad against Hertz", 0.3, [=](auto& rows) { rows.push_back(hertz_pad_row(spacings, effort)); }});
    const double finest_m = effort.quick ? 2.5e-3 : 1.5e-3;
    list.push_back(
        {"finger on the slab, and its table", effort.quick ? 4.0 : 20.0, [=](auto& rows) {
             AccuracyRow made;
             const scene::LinearTissue slab = finger_slab(0.1, effort.quick ? 22 : 31, finest_m, 0.05, made);
             for (const FingerContact contact : {FingerContact::parabola, FingerContact::rigid, FingerContact::pad})
                 rows.push_back(ripple_row(slab, contact, finest_m, effort, made));
             rows.push_back(table_row(slab, 0.02, 2e-4, effort));
             rows.push_back(table_row(slab, 0.005, 1e-4, effort));
             if (!effort.quick) rows.push_back(table_row(slab, 0.005, 2e-5, effort));
         }});
    list.push_back({"sheet", 1.0, [](auto& rows) {
                        sheet_rows(Sheet::free, rows);
                        sheet_rows(Sheet::backed, rows);
                    }});
    list.push_back({"steps and schedule", 0.5, [](auto& rows) {
                        for (const bool dither : {false, true}) rows.push_back(steps_row(dither));
                        for (const double speed : {0.01, 0.02, 0.05, 0.1}) {
                            rows.push_back(schedule_row(speed, 0.0, false));
                            rows.push_back(schedule_row(speed, 20e-3, false));
                        }
                    }});
    return list;
}

}  // namespace palpa::accuracy
