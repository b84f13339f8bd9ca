#include "accuracy/tangible_speed.h"

#include <array>
#include <cmath>
#include <random>

#include "accuracy/timing.h"
#include "files/text.h"
#include "mechanics/bounded_least_squares.h"
#include "tangible/inverse.h"

namespace palpa::accuracy {
namespace {

using tangible::DeviceModel;
using tangible::DeviceState;
using tangible::Fidelity;

constexpr int kPressTicks = 240;
constexpr double kPressRate_Hz = 100.0;
constexpr double kPressDepth_m = 6e-3;
constexpr double kPressed_N_per_m = 100.0;

// Depth at a tick: there and back with minimum jerk.
double press_depth_m(int tick) {
    const double there = 2.0 * tick / kPressTicks;
    const double t = there <= 1.0 ? there : 2.0 - there;
    return kPressDepth_m * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
}

struct PressedDevice {
    std::string name;
    DeviceModel model;
    DeviceState state;
    std::vector<double> converged_N;  // force that the exact plant gives, per tick
    double kept_MB = kUnknown;
};

// One press: the actuation of every tick, with a call around each that may time it.
template <class Around>
std::vector<tangible::Actuation> press(const PressedDevice& device, Fidelity fidelity, Around&& around) {
    DeviceState state = device.state;
    std::vector<tangible::Actuation> out;
    for (int tick = 0; tick <= kPressTicks; ++tick) {
        const double depth_m = press_depth_m(tick);
        tangible::InverseAnswer answer;
        around(tick, [&] {
            answer = inverse_step(device.model, state, {depth_m, kPressed_N_per_m * depth_m, {}},
                                  {fidelity, 1.0 / kPressRate_Hz, true, true});
        });
        out.push_back(answer.actuation);
    }
    return out;
}

std::vector<double> plant_force_N(const PressedDevice& device, const std::vector<tangible::Actuation>& actuation) {
    DeviceState plant = device.state;
    std::vector<double> out;
    for (int tick = 0; tick <= kPressTicks; ++tick)
        out.push_back(
            press_to_depth(device.model, plant, actuation[static_cast<std::size_t>(tick)], press_depth_m(tick))
                .force_N);
    return out;
}

PressedDevice prepare_device(const std::filesystem::path& file) {
    const double before_MB = heap_MB();
    PressedDevice device;
    device.model = tangible::make_device_model(tangible::read_soft_device(file));
    device.name = device.model.device.name;
    device.state = tangible::rest_state(device.model);
    prepare_press(device.model, device.state, kPressed_N_per_m * device.model.device.depth_floor_m);
    device.kept_MB = heap_MB() - before_MB;
    device.converged_N = plant_force_N(device, press(device, Fidelity::converged, [](int, auto&& call) { call(); }));
    return device;
}

double error_percent(const PressedDevice& device, const std::vector<double>& force_N) {
    double sum = 0.0;
    double most = 0.0;
    for (std::size_t i = 0; i < force_N.size(); ++i) {
        sum += (force_N[i] - device.converged_N[i]) * (force_N[i] - device.converged_N[i]);
        most = std::max(most, std::abs(device.converged_N[i]));
    }
    return 100.0 * std::sqrt(sum / static_cast<double>(force_N.size())) / most;
}

TangibleSpeedRow timed_row(const std::string& what, const Timing& timing) {
    TangibleSpeedRow row;
    row.what = what;
    row.median_ms = 1e-3 * quantile_us(timing, 0.5);
    row.p99_ms = 1e-3 * quantile_us(timing, 0.99);
    return row;
}

// Times a fidelity over one press, the unit after every eighth tick.
TangibleSpeedRow press_row(const PressedDevice& device, Fidelity fidelity, LaplacianUnit& unit) {
    Timing timing;
    const auto actuation = press(device, fidelity, [&](int tick, auto&& call) {
        if (tick % 8 == 0) unit.time();
        time_call(timing, call);
    });
    TangibleSpeedRow row = timed_row(
        device.name + ", " + std::string(tangible::kFidelityNames[static_cast<std::size_t>(fidelity)]), timing);
    row.force_error_percent = error_percent(device, plant_force_N(device, actuation));
    row.allocated_MB = device.kept_MB;
    return row;
}

// Random problems of four actuators and three rows, as a device with tilt has.
TangibleSpeedRow qp_row(LaplacianUnit& unit) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    Timing timing;
    double sum = 0.0;
    for (int i = 0; i < 4000; ++i) {
        mechanics::BoundedProblem problem;
        problem.W.resize(3, 4);
        problem.d.resize(3);
        for (Eigen::Index k = 0; k < problem.W.size(); ++k) problem.W.data()[k] = 1e-3 * normal(random);
        problem.W.col(3) *= 1e-4;
        for (Eigen::Index k = 0; k < 3; ++k) problem.d(k) = 1e-3 * normal(random);
        problem.lower.setZero(4);
        problem.upper.setConstant(4, 5.0);
        problem.upper(3) = 5000.0;
        problem.tikhonov = 1e-8;
        if (i % 200 == 0) unit.time();
        time_call(timing, [&] { sum += mechanics::solve_bounded(problem).x(0); });
    }
    TangibleSpeedRow row = timed_row("bounded least squares, 4 actuators", timing);
    row.peer_units = 0.06 / 16.9;
    row.bound_units = 0.010 / 16.9;
    if (!std::isfinite(sum)) row.median_ms = kUnknown;
    return row;
}

}  // namespace

TangibleSpeed tangible_speed(const std::filesystem::path& devices) {
    struct Asked {
        Fidelity fidelity;
        double peer_units, bound_units;
    };
    LaplacianUnit unit;
    TangibleSpeed out;
    const auto measure = [&](const char* file, std::initializer_list<Asked> list) {
        const PressedDevice device = prepare_device(devices / file);
        for (const Asked& asked : list) {
            out.rows.push_back(press_row(device, asked.fidelity, unit));
            out.rows.back().peer_units = asked.peer_units;
            out.rows.back().bound_units = asked.bound_units;
        }
    };
    measure("strip.json", {{Fidelity::step, 0.58, 0.18}, {Fidelity::stale, kUnknown, 0.06}});
    measure("accordion.json",
            {{Fidelity::step, 0.93, 0.30}, {Fidelity::stale, kUnknown, 0.06}, {Fidelity::linear, kUnknown, 0.006}});
    out.rows.push_back(qp_row(unit));
    out.unit_ms = 1e-3 * quantile_us(unit.timing(), 0.5);
    for (TangibleSpeedRow& row : out.rows) row.units = row.median_ms / out.unit_ms;
    return out;
}

files::Json tangible_speed_json(const TangibleSpeed& speed, const Machine& machine) {
    files::Json rows = files::Json::array();
    for (const TangibleSpeedRow& row : speed.rows) {
        rows.push_back({{"what", row.what},
                        {"median_ms", files::number_or_null(row.median_ms)},
                        {"p99_ms", files::number_or_null(row.p99_ms)},
                        {"units", files::number_or_null(row.units)},
                        {"peer_units", files::number_or_null(row.peer_units)},
                        {"bound_units", files::number_or_null(row.bound_units)},
                        {"force_error_percent", files::number_or_null(row.force_error_percent)},
                        {"memory_MB", files::number_or_null(row.allocated_MB)}});
    }
    return {{"unit_ms", speed.unit_ms}, {"rows", rows}, {"machine", machine_json(machine)}};
}

std::string tangible_speed_table(const TangibleSpeed& speed) {
    std::string out = "unit (SimplicialLDLT of the Laplacian on 16^3 points, between the steps): " +
                      files::short_number(speed.unit_ms) + " ms\n";
    out += "what                                 median ms   p99 ms   units   bound   SOFA   force error\n";
    for (const TangibleSpeedRow& row : speed.rows) {
        const auto cell = [](double value) {
            return std::isfinite(value) ? files::short_number(value) : std::string("-");
        };
        std::array<char, 200> line{};
        std::snprintf(line.data(), line.size(), "%-36s %9s %8s %7s %7s %6s %10s %%\n", row.what.c_str(),
                      cell(row.median_ms).c_str(), cell(row.p99_ms).c_str(), cell(row.units).c_str(),
                      cell(row.bound_units).c_str(), cell(row.peer_units).c_str(),
                      cell(row.force_error_percent).c_str());
        out += line.data();
    }
    return out;
}

}  // namespace palpa::accuracy
