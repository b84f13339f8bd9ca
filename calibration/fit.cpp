#include "calibration/fit.h"

namespace palpa::calibration {

std::optional<Curve> fit_curve(const FitPoints& points, const FitOptions& options) {
    if (options.model == CurveModel::monotone_cubic) return fit_cubic(points, cubic_bins(points, options.knots));
    FitWorkspace work;
    FitStart start;
    if (!start_fit(points, options, work, start)) return std::nullopt;
    return curve_at(options, start);
}

std::string_view name_of(ErrorModel error) { return error == ErrorModel::newton ? "newton" : "log"; }

int parameter_count(CurveModel model) { return model == CurveModel::exponential_offset ? 3 : 2; }

int distinct_levels(const FitPoints& points) {
    int n = 0;
    for (Eigen::Index i = 0; i < points.level.size(); ++i) n += i == 0 || points.level(i) != points.level(i - 1);
    return n;
}

}  // namespace palpa::calibration
