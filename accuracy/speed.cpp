#include "accuracy/speed.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <limits>

#include "accuracy/timing.h"
#include "files/text.h"
#include "scene/advance.h"
#include "session/raster_trace.h"
#include "session/session.h"

namespace palpa::accuracy {
namespace {

Eigen::SparseMatrix<double> laplacian(int n) {
    std::vector<Eigen::Triplet<double>> entries;
    const std::array<int, 3> stride{1, n, n * n};
    for (int i = 0; i < n * n * n; ++i) {
        entries.emplace_back(i, i, 6.1);
        for (const int step : stride) {
            if (i / step % n + 1 == n) continue;
            entries.emplace_back(i, i + step, -1.0);
            entries.emplace_back(i + step, i, -1.0);
        }
    }
    Eigen::SparseMatrix<double> out(n * n * n, n * n * n);
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
}

// Times all samples together: the mean per sample, without the clock's own cost.
double mean_us(const scene::Scene& scene, const scene::Plan& plan, const platform::Trace& trace, scene::State& state) {
    Timing timing;
    time_call(timing, [&] {
        for (const platform::Sample& sample : trace.samples) scene::advance(scene, plan, sample, state);
    });
    return timing.us[0] / static_cast<double>(trace.samples.size());
}

double single_p99_us(const scene::Scene& scene, const scene::Plan& plan, const platform::Trace& trace,
                     scene::State& state) {
    Timing timing;
    timing.us.reserve(trace.samples.size());
    for (const platform::Sample& sample : trace.samples)
        time_call(timing, [&] { scene::advance(scene, plan, sample, state); });
    return quantile_us(timing, 0.99);
}

SpeedRow row_of(const std::string& what, const Timing& timing) {
    const double median_us = files::quantile(timing.us, 0.5, files::QuantileType::between);
    return {what, quantile_us(timing, 0.0), median_us, kUnknown, static_cast<int>(timing.us.size())};
}

}  // namespace

struct LaplacianUnit::Solver {
    Eigen::SparseMatrix<double> matrix = laplacian(16);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

LaplacianUnit::LaplacianUnit() : solver_(std::make_unique<Solver>()) {
    solver_->factor.analyzePattern(solver_->matrix);
}
LaplacianUnit::~LaplacianUnit() = default;

void LaplacianUnit::time() {
    time_call(timing_, [&] { solver_->factor.factorize(solver_->matrix); });
}

SpeedRow machine_unit(int repetitions) {
    LaplacianUnit unit;
    for (int i = 0; i < repetitions; ++i) unit.time();
    return row_of("unit: SimplicialLDLT of the Laplacian on 16^3 points", unit.timing());
}

SpeedRow sample_speed(const scene::Scene& scene, const scene::Plan& plan, double seconds, int repetitions) {
    session::RasterOptions raster;
    raster.rate_Hz = 1000.0;
    raster.seconds = seconds;
    const platform::Trace trace = session::raster_trace(scene, plan, raster);
    Timing timing;
    double p99_us = std::numeric_limits<double>::infinity();
    for (int i = 0; i < repetitions; ++i) {
        scene::State state = scene::start(scene, plan, session::screen_of(trace.info));
        timing.us.push_back(mean_us(scene, plan, trace, state));
        state = scene::start(scene, plan, session::screen_of(trace.info));
        p99_us = std::min(p99_us, single_p99_us(scene, plan, trace, state));
    }
    SpeedRow row = row_of(scene.name, timing);
    row.p99_us = p99_us;
    return row;
}

files::Json machine_json(const Machine& machine) {
    return {
        {"processor", machine.processor}, {"threads", machine.threads}, {"load", machine.load}, {"date", machine.date}};
}

files::Json speed_json(const SpeedRow& unit, const std::vector<SpeedRow>& rows, const Machine& machine) {
    files::Json out{{"machine", machine_json(machine)},
                    {"unit_us", {{"what", unit.what}, {"least", unit.least_us}, {"median", unit.median_us}}},
                    {"rows", files::Json::array()}};
    for (const SpeedRow& row : rows) {
        out["rows"].push_back({{"what", row.what},
                               {"least_us", row.least_us},
                               {"median_us", row.median_us},
                               {"p99_us", row.p99_us},
                               {"least_in_units", row.least_us / unit.least_us},
                               {"p99_in_units", row.p99_us / unit.least_us},
                               {"repetitions", row.repetitions}});
    }
    return out;
}

std::string speed_table(const SpeedRow& unit, const std::vector<SpeedRow>& rows) {
    std::string out = unit.what + ": least " + files::short_number(unit.least_us) + " us, median " +
                      files::short_number(unit.median_us) + " us\n";
    for (const SpeedRow& row : rows) {
        out += row.what + ": a sample takes " + files::short_number(row.least_us) + " us on average (" +
               files::short_number(row.least_us / unit.least_us) + " units; median of " +
               files::counted(row.repetitions, "repetition") + " " + files::short_number(row.median_us) +
               " us); single ones, clock included: p99 " + files::short_number(row.p99_us) + " us (" +
               files::short_number(row.p99_us / unit.least_us) + " units)\n";
    }
    return out;
}

}  // namespace palpa::accuracy
