#include "tactile/characterise.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "files/quantile.h"

namespace palpa::tactile {
namespace {

// The readings that count: within the tissue, and about as fast as most.
std::vector<const StrokeRow*> counting_rows(const std::vector<StrokeRow>& rows) {
    constexpr double kMargin = 0.05, kSlower = 0.3, kFaster = 3.0;
    double deepest_m = 0.0;
    for (const StrokeRow& row : rows) deepest_m = std::max(deepest_m, row.depth_m);
    std::vector<const StrokeRow*> inside, out;
    std::vector<double> speed_m_per_s;
    for (const StrokeRow& row : rows) {
        if (!(row.depth_m > kMargin * deepest_m && row.depth_m < (1.0 - kMargin) * deepest_m)) continue;
        inside.push_back(&row);
        speed_m_per_s.push_back(std::abs(row.velocity_m_per_s));
    }
    if (inside.empty()) return out;
    const double usual_m_per_s = files::median(speed_m_per_s);
    for (const StrokeRow* row : inside) {
        const double speed = std::abs(row->velocity_m_per_s);
        if (speed > kSlower * usual_m_per_s && speed < kFaster * usual_m_per_s) out.push_back(row);
    }
    return out;
}

// k, c and h of F = k d + c + h sign(v).
template <class Force>
Eigen::Vector3d line_through(const std::vector<const StrokeRow*>& rows, const Force& force_N) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const StrokeRow* row : rows) {
        const Eigen::Vector3d a(row->depth_m, 1.0, row->velocity_m_per_s > 0.0 ? 1.0 : -1.0);
        normal += a * a.transpose();
        right += a * force_N(*row);
    }
    return normal.ldlt().solve(right);
}

}  // namespace

StiffnessRun stiffness_of(const std::function<double(double depth_m)>& law_N, std::vector<StrokeRow> rows) {
    const std::vector<const StrokeRow*> counting = counting_rows(rows);
    constexpr std::size_t kFewest = 100;
    if (counting.size() < kFewest)
        throw std::runtime_error("characterise: found " + std::to_string(counting.size()) +
                                 " readings within the tissue, expected at least 100: did the hand press?");
    const Eigen::Vector3d line = line_through(counting, [](const StrokeRow& row) { return row.sensor_N; });
    StiffnessRun run;
    run.wanted_N_per_m = line_through(counting, [&](const StrokeRow& row) { return law_N(row.depth_m); })[0];
    run.rendered_N_per_m = line[0];
    run.error_share = line[0] / run.wanted_N_per_m - 1.0;
    run.hysteresis_N = std::abs(line[2]);
    run.force_at_0_N = line[1];
    double squares = 0.0, pressing = 0.0;
    for (const StrokeRow& row : rows) {
        if (!(row.depth_m > 0.0)) continue;
        const double off_N = row.sensor_N - law_N(row.depth_m);
        squares += off_N * off_N;
        pressing += 1.0;
    }
    run.force_rms_N = std::sqrt(squares / pressing);
    run.rows = std::move(rows);
    return run;
}

double hand_depth_m(double depth_m, double stiffness_N_per_m, double hand_N_per_m) {
    return depth_m * (1.0 + stiffness_N_per_m / hand_N_per_m);
}

}  // namespace palpa::tactile
