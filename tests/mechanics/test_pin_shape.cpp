#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <random>

#include "mechanics/error.h"
#include "mechanics/layer.h"
#include "mechanics/pin_shape.h"
#include "mechanics/sheet.h"
#include "mechanics/statics.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"

using namespace palpa::mechanics;
using namespace palpa::test;
using Eigen::VectorXd;
using palpa::test::close_to;

namespace {

// 17.5 kPa, 0.304 N/mm under a finger of 16 mm.
const Layer kSlab{17500.0, 0.45, 0.05};

VectorXd bowl_m(const Eigen::Matrix2Xd& points_m, double force_N) {
    VectorXd u_m(points_m.cols());
    for (Eigen::Index k = 0; k < u_m.size(); ++k)
        u_m(k) = layer_depression_m(kSlab, {8e-3, force_N}, points_m.col(k).norm());
    return u_m;
}

Eigen::Matrix2Xd lattice_m(int n, double spacing_m) {
    Eigen::Matrix2Xd out(2, n * n);
    for (int k = 0; k < n * n; ++k)
        out.col(k) << (k % n - 0.5 * (n - 1)) * spacing_m, (k / n - 0.5 * (n - 1)) * spacing_m;
    return out;
}

// Root mean square over 21 x 21 points of what pins with these sinks show minus what is wanted.
double error_on_top_m(const PinShape& shape, const VectorXd& sink_m, const VectorXd& wanted_m) {
    const Eigen::MatrixXd top =
        sheet_forward(shape.grid, shape.options.sheet, shape.options.sheet_thickness_m, lattice_m(21, 0.5e-3));
    return std::sqrt((top * sink_m - wanted_m).squaredNorm() / static_cast<double>(wanted_m.size()));
}

// The amplitude of the top of a sheet of thickness 1 m on an underside of shape cos(k x), by finite elements in plane
// strain; above_m of the same rubber on top of it.
double amplitude_by_elements(double k, double above_m) {
    const double half_wave_m = std::numbers::pi / k;
    const int n_x = 24;
    const int n_sheet = 20;
    const int n_above = above_m > 0.0 ? 24 : 0;
    VectorXd z_m(n_sheet + n_above + 1);
    z_m.head(n_sheet + 1) = VectorXd::LinSpaced(n_sheet + 1, 0.0, 1.0);
    if (n_above > 0) z_m.tail(n_above) = 1.0 + graded_coordinates_m(above_m, n_above, 0.0, 0.06).tail(n_above).array();
    const Eigen::Vector2d y_m(0.0, half_wave_m / n_x);
    Problem problem;
    problem.mesh = hex_box(VectorXd::LinSpaced(n_x + 1, 0.0, half_wave_m), y_m, z_m);
    problem.materials.assign(static_cast<std::size_t>(problem.mesh.cells.cols()), {1000.0, 0.4999});
    const Faces outer = boundary_faces(problem.mesh);
    std::vector<int> all;
    for (int node = 0; node < problem.mesh.nodes_m.cols(); ++node) all.push_back(node);
    fix(all, "y", 0.0, problem.supports);
    for (const Side side : {Side::xmin, Side::xmax})
        fix(nodes_of(faces_on(problem.mesh, outer, side)), "x", 0.0, problem.supports);
    for (const int node : nodes_of(faces_on(problem.mesh, outer, Side::zmin))) {
        fix({node}, "x", 0.0, problem.supports);
        fix({node}, "z", std::cos(k * problem.mesh.nodes_m(0, node)), problem.supports);
    }
    const Factored factored = factorise(problem, best_solver());
    const Solution solution = solve(factored, Eigen::Matrix3Xd::Zero(3, problem.mesh.nodes_m.cols()));
    // the share of cos(k x) in u_z at z = 1, by the trapezoidal rule
    double sum = 0.0;
    for (int node = 0; node < problem.mesh.nodes_m.cols(); ++node) {
        const Eigen::Vector3d x = problem.mesh.nodes_m.col(node);
        if (x.y() != 0.0 || std::abs(x.z() - 1.0) > 1e-9) continue;
        const bool end = x.x() == 0.0 || x.x() == half_wave_m;
        sum += (end ? 0.5 : 1.0) * solution.u_m(2, node) * std::cos(k * x.x());
    }
    return 2.0 * sum / n_x;
}

}  // namespace

TEST_CASE("pin shape: the bowl of 17.5 kPa uses up the stroke at 0.85 N at the latest") {
    PinShapeOptions options;
    options.zero = PinZero::top;
    const PinShape shape = make_pin_shape({}, options);
    const double depth_m_per_N = layer_mean_depression_m(kSlab, {8e-3, 1.0});
    CHECK(1e-3 / depth_m_per_N == close_to(0.304).epsilon(0.005));
    const VectorXd u_m = bowl_m(shape.sample_m, 1.0);
    // from the centre to the corner pin 0.715 of the depth
    const double centre_m = layer_depression_m(kSlab, {8e-3, 1.0}, 0.0);
    CHECK((centre_m - u_m.minCoeff()) / depth_m_per_N == close_to(0.715).epsilon(0.01));
    CHECK(stroke_used_up_at_N(shape, depth_m_per_N, u_m) == close_to(0.85).epsilon(0.05));
    options.zero = PinZero::skel;
    const PinShape middle = make_pin_shape({}, options);
    const double from_middle_N = stroke_used_up_at_N(middle, depth_m_per_N, u_m);
    CHECK(from_middle_N <= 0.9);
    // just below it nothing is clipped, just above it something is
    VectorXd height_m(36);
    PinReport report;
    pin_heights_m(middle, 0.99 * from_middle_N * depth_m_per_N, 0.99 * from_middle_N * u_m, height_m, report);
    CHECK(report.clipped == 0);
    pin_heights_m(middle, 1.01 * from_middle_N * depth_m_per_N, 1.01 * from_middle_N * u_m, height_m, report);
    CHECK(report.clipped > 0);
}

TEST_CASE("pin shape: height is rest minus what the surface sinks beyond the depth") {
    const PinShape shape = make_pin_shape({2, 3, 2e-3, 1e-3, 2e-3, 1e-4, 0.03}, {});
    VectorXd u_m(6);
    u_m << 3.0, 3.1, 2.9, 3.4, 2.6, 3.0;
    u_m *= 1e-3;
    VectorXd height_m(6);
    PinReport report;
    pin_heights_m(shape, 3e-3, u_m, height_m, report);
    CHECK((height_m - (1e-3 + 3e-3 - u_m.array()).matrix()).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(report.scale == 1.0);
    CHECK(report.clipped == 0);
    // pin 0 stands at row 0, column 0: -x, -y; columns run along x
    CHECK(shape.pin_m(0, 0) == close_to(-2e-3));
    CHECK(shape.pin_m(1, 0) == close_to(-1e-3));
    CHECK(shape.pin_m(0, 1) == 0.0);
}

TEST_CASE("pin shape: top brings the highest pin to the top, and the flat surface all of them") {
    PinShapeOptions options;
    options.zero = PinZero::top;
    const PinShape shape = make_pin_shape({}, options);
    VectorXd height_m(36);
    PinReport report;
    pin_heights_m(shape, 1e-3, bowl_m(shape.sample_m, 0.3), height_m, report);
    CHECK(height_m.maxCoeff() == close_to(2e-3));
    pin_heights_m(shape, 0.0, VectorXd::Zero(36), height_m, report);
    CHECK((height_m.array() == rest_height_m(shape)).all());
    CHECK(rest_height_m(shape) == 2e-3);
    CHECK(rest_height_m(make_pin_shape({}, {})) == 1e-3);
}

TEST_CASE("pin shape: more than the stroke is clipped or scaled, never more") {
    for (const PinZero zero : {PinZero::skel, PinZero::top}) {
        PinShapeOptions options;
        options.zero = zero;
        const PinShape clip = make_pin_shape({}, options);
        options.over_stroke = OverStroke::scale;
        const PinShape scale = make_pin_shape({}, options);
        const double force_N = 2.5;
        const double depth_m = layer_mean_depression_m(kSlab, {8e-3, force_N});
        const VectorXd u_m = bowl_m(clip.sample_m, force_N);
        VectorXd height_m(36);
        PinReport report;
        pin_heights_m(clip, depth_m, u_m, height_m, report);
        CHECK(report.clipped > 0);
        CHECK(height_m.minCoeff() >= 0.0);
        CHECK(height_m.maxCoeff() <= 2e-3);
        pin_heights_m(scale, depth_m, u_m, height_m, report);
        CHECK(report.clipped == 0);
        CHECK(report.scale < 1.0);
        // still the same shape
        const VectorXd above_m = (depth_m - u_m.array()).matrix();
        const double slope = (height_m(0) - height_m(14)) / (above_m(0) - above_m(14));
        CHECK(slope == close_to(report.scale).epsilon(1e-9));
    }
}

TEST_CASE("pin shape: few pins") {
    for (const Sheet sheet : {Sheet::off, Sheet::free, Sheet::backed}) {
        for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 2}, {3, 1}, {2, 2}}) {
            PinGrid grid;
            grid.rows = rows;
            grid.columns = columns;
            PinShapeOptions options;
            options.sheet = sheet;
            const PinShape shape = make_pin_shape(grid, options);
            VectorXd height_m(pin_count(grid));
            PinReport report;
            const VectorXd u_m = bowl_m(shape.sample_m, 0.2);
            pin_heights_m(shape, 0.6e-3, u_m, height_m, report);
            CHECK(height_m.allFinite());
            CHECK(height_m.minCoeff() >= 0.0);
            CHECK(height_m.maxCoeff() <= 2e-3);
            if (pin_count(grid) == 1) CHECK(height_m(0) == close_to(1e-3 + 0.6e-3 - u_m(0)));
        }
    }
}

TEST_CASE("pin shape: NaN anywhere lets the pin rest") {
    for (const PinZero zero : {PinZero::skel, PinZero::top}) {
        PinShapeOptions options;
        options.zero = zero;
        options.over_stroke = OverStroke::scale;
        const PinShape shape = make_pin_shape({}, options);
        VectorXd sink_m = bowl_m(shape.pin_m, 0.3);
        sink_m(7) = std::numeric_limits<double>::quiet_NaN();
        sink_m(9) = -std::numeric_limits<double>::infinity();
        VectorXd height_m(36);
        VectorXd carried_m = VectorXd::Zero(36);
        PinReport report;
        pins_from_sinks_m(shape, 1e-3, sink_m, height_m, report);
        CHECK(height_m.allFinite());
        CHECK(height_m(7) == rest_height_m(shape));
        CHECK(height_m(9) == rest_height_m(shape));
        CHECK(std::isfinite(report.scale));
        pins_from_sinks_m(shape, std::numeric_limits<double>::quiet_NaN(), sink_m, height_m, report);
        CHECK((height_m.array() == rest_height_m(shape)).all());
        VectorXd slewed_m = VectorXd::Constant(36, 1e-3);
        slew_pins_m(shape.grid, 1e-3, sink_m, slewed_m);
        CHECK(slewed_m.allFinite());
    }
}

TEST_CASE("pin shape: steps, and dither that keeps the mean") {
    PinShapeOptions options;
    const PinShape plain = make_pin_shape({}, options);
    options.dither = true;
    const PinShape dithered = make_pin_shape({}, options);
    VectorXd carried_m = VectorXd::Zero(36);
    VectorXd height_m = VectorXd::LinSpaced(36, -1e-4, 2.3e-3);
    round_to_steps_m(plain, carried_m, height_m);
    CHECK(carried_m.isZero());
    for (Eigen::Index k = 0; k < 36; ++k) CHECK(std::abs(height_m(k) / 1e-4 - std::round(height_m(k) / 1e-4)) < 1e-9);
    CHECK(height_m.minCoeff() == 0.0);
    CHECK(height_m.maxCoeff() <= 2e-3 + 1e-15);

    const VectorXd wanted_m = VectorXd::LinSpaced(36, 0.0, 2e-3);
    VectorXd mean_m = VectorXd::Zero(36);
    for (int k = 0; k < 1000; ++k) {
        height_m = wanted_m;
        round_to_steps_m(dithered, carried_m, height_m);
        mean_m += height_m / 1000.0;
        CHECK((height_m - wanted_m).cwiseAbs().maxCoeff() <= 1.0001e-4);
    }
    CHECK((mean_m - wanted_m).cwiseAbs().maxCoeff() < 2e-7);
}

TEST_CASE("pin shape: slew is that of the servos") {
    const PinGrid grid;
    VectorXd height_m = VectorXd::Zero(36);
    const VectorXd target_m = VectorXd::Constant(36, 2e-3);
    int steps = 0;
    while (height_m.maxCoeff() < 2e-3 - 1e-12 && steps < 1000) {
        slew_pins_m(grid, 1e-3, target_m, height_m);
        ++steps;
    }
    CHECK(steps == 67);  // 2 mm at 30 mm/s: 7.5 Hz there and back
}

TEST_CASE("sheet: share of a wave that arrives on top") {
    // derived and checked against the boundary value problem
    CHECK(sheet_transfer(Sheet::free, 0.5) == close_to(0.91235).epsilon(1e-5));
    CHECK(sheet_transfer(Sheet::free, 1.0) == close_to(0.80396).epsilon(1e-5));
    CHECK(sheet_transfer(Sheet::free, 2.0) == close_to(0.60680).epsilon(1e-5));
    CHECK(sheet_transfer(Sheet::free, std::numbers::pi) == close_to(0.33189).epsilon(2e-5));
    CHECK(sheet_transfer(Sheet::backed, 0.5) == close_to(0.90980).epsilon(1e-5));
    CHECK(sheet_transfer(Sheet::backed, 2.0) == close_to(0.40601).epsilon(2e-5));
    for (const Sheet sheet : {Sheet::off, Sheet::free, Sheet::backed}) CHECK(sheet_transfer(sheet, 0.0) == 1.0);
    CHECK(std::isfinite(sheet_transfer(Sheet::free, 1e4)));
}

TEST_CASE("sheet: the formula agrees with hexahedra to 1 % for k h from 0.5 to 3") {
    for (const double x : {0.5, 1.0, 2.0, 3.0}) {
        CAPTURE(x);
        CHECK(amplitude_by_elements(x, 0.0) == close_to(sheet_transfer(Sheet::free, x)).epsilon(0.01));
        CHECK(amplitude_by_elements(x, 8.0 / x) == close_to(sheet_transfer(Sheet::backed, x)).epsilon(0.01));
    }
}

TEST_CASE("sheet: its kernel passes a wave on as the formula says") {
    // 40 x 40 pins as a wave along x; far from the edges
    PinGrid grid;
    grid.rows = grid.columns = 20;
    const Eigen::Matrix2Xd middle_m = Eigen::Matrix2Xd::Zero(2, 1);
    const double wave_m = 12e-3;
    const double k = 2.0 * std::numbers::pi / wave_m;
    for (const Sheet sheet : {Sheet::free, Sheet::backed}) {
        const Eigen::MatrixXd top = sheet_forward(grid, sheet, 2e-3, middle_m);
        double sum = 0.0;
        for (int pin = 0; pin < 400; ++pin) sum += top(0, pin) * std::cos(k * (pin % 20 - 9.5) * 2e-3);
        // the underside is linear between pins, which alone takes away sinc^2
        const double linear = std::pow(std::sin(0.5 * k * 2e-3) / (0.5 * k * 2e-3), 2.0);
        CHECK(sum == close_to(linear * sheet_transfer(sheet, k * 2e-3)).epsilon(0.02));
    }
}

TEST_CASE("sheet inverse: a level surface stays level, whatever the regularisation") {
    for (const Sheet sheet : {Sheet::free, Sheet::backed}) {
        PinShapeOptions options;
        options.sheet = sheet;
        const PinShape shape = make_pin_shape({}, options);
        VectorXd height_m(36);
        PinReport report;
        pin_heights_m(shape, 3e-3, VectorXd::Constant(shape.sample_m.cols(), 3e-3), height_m, report);
        CHECK((height_m.array() - 1e-3).abs().maxCoeff() < 1e-12);
        VectorXd top_m(shape.sample_m.cols());
        shape_on_top_m(shape, height_m, top_m);
        CHECK((top_m.array() - 1e-3).abs().maxCoeff() < 1e-12);
        CHECK(shape_mismatch_m(shape, 3e-3, VectorXd::Constant(shape.sample_m.cols(), 3e-3), height_m) < 1e-12);
    }
}

TEST_CASE("sheet inverse: against plain sampling a third of the error for a bowl, two thirds for a bump") {
    PinShapeOptions options;
    options.sheet = Sheet::free;
    const PinShape shape = make_pin_shape({}, options);
    const Eigen::Matrix2Xd top_m = lattice_m(21, 0.5e-3);
    const auto compare = [&](const auto& wanted) {
        const auto at = [&](const Eigen::Matrix2Xd& points_m) {
            VectorXd out(points_m.cols());
            for (Eigen::Index k = 0; k < out.size(); ++k) out(k) = wanted(points_m.col(k).norm());
            return out;
        };
        VectorXd sink_m(36);
        pin_sinks_m(shape, at(shape.sample_m), sink_m);
        const double inverse_m = error_on_top_m(shape, sink_m, at(top_m));
        const double plain_m = error_on_top_m(shape, at(shape.pin_m), at(top_m));
        MESSAGE("inverse " << 1e3 * inverse_m << " mm, sampling " << 1e3 * plain_m << " mm, span "
                           << 1e3 * (sink_m.maxCoeff() - sink_m.minCoeff()) << " mm");
        return inverse_m / plain_m;
    };
    // from centre to corner 2 mm
    const double scale = 2e-3 / (layer_depression_m(kSlab, {8e-3, 1.0}, 0.0) -
                                 layer_depression_m(kSlab, {8e-3, 1.0}, std::hypot(5e-3, 5e-3)));
    CHECK(compare([&](double r) { return scale * layer_depression_m(kSlab, {8e-3, 1.0}, r); }) < 1.0 / 3.0);
    CHECK(compare([](double r) { return 1e-3 * std::exp(-std::pow(r / 1.5e-3, 2.0)); }) < 2.0 / 3.0);
}

TEST_CASE("pin shape: from surface to steps nothing is allocated") {
    PinGrid grid;
    grid.rows = grid.columns = 10;
    PinShapeOptions options;
    options.sheet = Sheet::free;
    options.dither = true;
    const PinShape shape = make_pin_shape(grid, options);
    const VectorXd u_m = bowl_m(shape.sample_m, 0.5);
    VectorXd height_m = VectorXd::Zero(100);
    VectorXd carried_m = VectorXd::Zero(100);
    VectorXd reached_m = VectorXd::Zero(100);
    PinReport report;
    const auto run = [&] {
        pin_heights_m(shape, 1e-3, u_m, height_m, report);
        round_to_steps_m(shape, carried_m, height_m);
        slew_pins_m(grid, 1e-3, height_m, reached_m);
        shape_mismatch_m(shape, 1e-3, u_m, height_m);
    };
    run();
    const long before = allocation_count();
    run();
    CHECK(allocation_count() == before);
}

TEST_CASE("pin shape: wrong grids and sheets are refused") {
    const auto with = [](auto change) {
        PinGrid grid;
        PinShapeOptions options;
        change(grid, options);
        make_pin_shape(grid, options);
    };
    CHECK_THROWS_AS(with([](PinGrid& g, PinShapeOptions&) { g.rows = 0; }), LoadError);
    CHECK_THROWS_AS(with([](PinGrid& g, PinShapeOptions&) { g.rows = g.columns = 21; }), LoadError);
    CHECK_THROWS_AS(with([](PinGrid& g, PinShapeOptions&) { g.pitch_m = -1.0; }), LoadError);
    CHECK_THROWS_AS(with([](PinGrid& g, PinShapeOptions&) { g.step_m = 3e-3; }), LoadError);
    CHECK_THROWS_AS(with([](PinGrid& g, PinShapeOptions&) { g.stroke_m = std::nan(""); }), LoadError);
    CHECK_THROWS_AS(with([](PinGrid&, PinShapeOptions& o) {
                        o.sheet = Sheet::free;
                        o.sheet_thickness_m = 0.0;
                    }),
                    LoadError);
}
