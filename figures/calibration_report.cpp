#include "figures/calibration_report.h"

#include <cmath>
#include <cstdio>

#include "calibration/profile_file.h"
#include "figures/gnuplot.h"
#include "files/text.h"

namespace palpa::figures {
namespace {

files::Json pair(const calibration::CurveInterval& interval) { return {interval.low, interval.high}; }

files::Json intervals_json(const calibration::Bootstrap& bootstrap, calibration::CurveModel model) {
    files::Json json{
        {"level", 0.95}, {"fits", bootstrap.fits}, {"drawn", bootstrap.over_repeats ? "repeats" : "points"}};
    if (model != calibration::CurveModel::monotone_cubic) {
        json["a_N"] = pair(bootstrap.a_N);
        json["b"] = pair(bootstrap.b);
    }
    if (model == calibration::CurveModel::exponential_offset) json["offset_N"] = pair(bootstrap.offset_N);
    files::Json curve{
        {"level", files::Json::array()}, {"low_N", files::Json::array()}, {"high_N", files::Json::array()}};
    for (std::size_t i = 0; i < bootstrap.level.size(); i += 5) {
        curve["level"].push_back(bootstrap.level[i]);
        curve["low_N"].push_back(bootstrap.low_N[i]);
        curve["high_N"].push_back(bootstrap.high_N[i]);
    }
    json["curve"] = curve;
    return json;
}

std::string percent(double share) { return std::isnan(share) ? "-" : files::short_number(100.0 * share) + " %"; }

}  // namespace

files::Json bands_json(const std::vector<calibration::ErrorBand>& bands) {
    files::Json json = files::Json::array();
    for (const calibration::ErrorBand& band : bands) {
        json.push_back(
            {{"from", band.from}, {"to", band.to}, {"n", band.n}, {"median", band.median}, {"p90", band.p90}});
    }
    return json;
}

files::Json quality_json(const calibration::Calibration& calibration) {
    const calibration::Ends& ends = calibration.ends;
    files::Json json;
    json["r2_newton"] = calibration.quality.r2_newton;
    json["r2_log"] = calibration.quality.r2_log;
    json["rmse_N"] = calibration.quality.rmse_N;
    json["median_relative_error"] = calibration.median_relative_error;
    json["relative_error_bands"] = bands_json(calibration.bands);
    json["left_out_by"] = calibration.by_repeats ? "repeats" : "folds";
    json["error_model"] = name_of(calibration.chosen.error);
    json["score"] = calibration.chosen.score;
    json["activation_force_N"] = ends.activation_N;
    json["force_at_full_N"] = calibration.force_at_full_N;
    json["saturation_force_N"] = ends.saturation_N;
    json["n_points"] = calibration.n_points;
    json["n_fitted"] = calibration.points.level.size();
    json["n_slips"] = calibration.slips.count;
    json["slips_followed_at_levels"] = calibration.slips.followed_levels;
    json["levels"] = {{"distinct", calibration.levels.distinct},
                      {"smallest_step", calibration.levels.smallest_step},
                      {"widest_gap", calibration.levels.widest_gap}};
    json["lag_s"] = nullptr;
    if (calibration.lag_s) json["lag_s"] = *calibration.lag_s;
    json["hysteresis"] = nullptr;
    if (const auto& hysteresis = calibration.hysteresis) {
        json["hysteresis"] = {{"median_relative", hysteresis->median_relative},
                              {"greatest_N", hysteresis->greatest_N},
                              {"at_level", hysteresis->at_level}};
    }
    json["drift"] = nullptr;
    if (const auto& drift = calibration.drift) {
        json["drift"] = {
            {"per_repeat", drift->per_repeat}, {"spread", drift->spread}, {"repeat_offset", drift->repeat_offset}};
    }
    if (calibration.bootstrap.fits > 0)
        json["intervals"] = intervals_json(calibration.bootstrap, calibration.profile.curve.model);
    json["warnings"] = calibration.warnings;
    return json;
}

files::Json calibration_json(const calibration::Calibration& calibration) {
    files::Json json;
    json["model"] = name_of(calibration.profile.curve.model);
    json["parameters"] = calibration::parameters_json(calibration.profile.curve);
    json["level"] = name_of(calibration.profile.level);
    json["level_range"] = {calibration.profile.level_lowest, calibration.profile.level_highest};
    json["fitted_range"] = {calibration.profile.fitted_lowest, calibration.profile.fitted_highest};
    json.update(quality_json(calibration));
    return json;
}

void print_bands(const std::vector<calibration::ErrorBand>& bands, const char* of_what) {
    std::printf("  error       of %s\n", of_what);
    std::printf("              %-18s %6s %10s %10s\n", "level", "points", "median", "p90");
    for (const calibration::ErrorBand& band : bands) {
        const std::string range = files::short_number(band.from) + " - " + files::short_number(band.to);
        std::printf("              %-18s %6zu %10s %10s\n", range.c_str(), band.n, percent(band.median).c_str(),
                    percent(band.p90).c_str());
    }
}

void print_calibration(const calibration::Calibration& calibration) {
    const calibration::Curve& curve = calibration.profile.curve;
    const auto text = [](double value) { return files::short_number(value); };
    std::printf("%s, %s error", std::string(name_of(curve.model)).c_str(),
                std::string(name_of(calibration.chosen.error)).c_str());
    if (curve.model == calibration::CurveModel::monotone_cubic) {
        std::printf(": %zu knots\n", curve.knot_level.size());
    } else {
        const calibration::Bootstrap& boot = calibration.bootstrap;
        const auto with = [&](double value, const calibration::CurveInterval& interval) {
            return text(value) + (boot.fits > 0 ? " [" + text(interval.low) + ", " + text(interval.high) + "]" : "");
        };
        std::printf(": a %s N, b %s", with(curve.a_N, boot.a_N).c_str(), with(curve.b, boot.b).c_str());
        if (curve.model == calibration::CurveModel::exponential_offset)
            std::printf(", offset %s N", with(curve.offset_N, boot.offset_N).c_str());
        std::printf("\n");
    }
    std::printf("  points      %zu read, %lld fitted, %zu distinct levels\n", calibration.n_points,
                static_cast<long long>(calibration.points.level.size()), calibration.levels.distinct);
    std::printf("  fit         R2 %.4f in newtons, %.4f in log space; RMSE %s N\n", calibration.quality.r2_newton,
                calibration.quality.r2_log, text(calibration.quality.rmse_N).c_str());
    print_bands(calibration.bands,
                calibration.by_repeats ? "repeats left out of the fit" : "points left out of the fit");
    std::printf("  first response at %s N, full scale at %s N", text(calibration.ends.activation_N).c_str(),
                text(calibration.force_at_full_N).c_str());
    if (!std::isnan(calibration.ends.before_saturation_N))
        std::printf(" (extrapolated), saturated from between %s and %s N on",
                    text(calibration.ends.before_saturation_N).c_str(), text(calibration.ends.saturation_N).c_str());
    else if (!std::isnan(calibration.ends.saturation_N))
        std::printf(", saturated from %s N", text(calibration.ends.saturation_N).c_str());
    std::printf("\n");
    constexpr double kShown_s = 1e-3;  // finer than a lag is found
    if (calibration.lag_s && std::abs(*calibration.lag_s) < kShown_s) std::printf("  lag         below 1 ms\n");
    if (calibration.lag_s && std::abs(*calibration.lag_s) >= kShown_s)
        std::printf("  lag         the pen is %s ms behind the sensor (removed)\n",
                    text(1e3 * *calibration.lag_s).c_str());
    if (const auto& hysteresis = calibration.hysteresis) {
        std::printf("  hysteresis  %s of the force (median), at most %s N at level %s\n",
                    percent(hysteresis->median_relative).c_str(), text(hysteresis->greatest_N).c_str(),
                    text(hysteresis->at_level).c_str());
    }
    if (const auto& drift = calibration.drift) {
        std::printf("  repeats     %zu, %s apart, drifting by %s a repeat\n", drift->repeat_offset.size(),
                    percent(drift->spread).c_str(), percent(drift->per_repeat).c_str());
    }
    for (const std::string& warning : calibration.warnings)
        std::fprintf(stderr, "palpa: warning: %s\n", warning.c_str());
}

namespace {

std::string title_of(const calibration::Calibration& calibration) {
    const std::string& pen = calibration.profile.device.pen;
    return (pen.empty() || pen == "n/a" ? "" : pen + ": ") + std::string(name_of(calibration.profile.curve.model));
}

void append_row(std::initializer_list<double> values, std::string& out) {
    for (const double value : values) {
        if (std::isnan(value))
            out += "NaN ";
        else
            files::append_number(value, out), out += ' ';
    }
    out += '\n';
}

}  // namespace

void plot_calibration(const calibration::Calibration& calibration, const std::filesystem::path& file) {
    const calibration::Profile& profile = calibration.profile;
    std::string script = "$points << EOD\n";
    for (Eigen::Index i = 0; i < calibration.points.level.size(); ++i) {
        const double measured_N = calibration.points.force_N(i);
        const double off = measured_N > 0.0 ? 100.0 * (measured_N - calibration.chosen.predicted_N(i)) / measured_N
                                            : platform::kMissing;
        append_row({calibration.points.level(i), measured_N, off}, script);
    }
    script += "EOD\n$curve << EOD\n";
    constexpr int kPlaces = 300;
    for (int i = 0; i <= kPlaces; ++i) {
        const double level = profile.level_lowest + (profile.level_highest - profile.level_lowest) * i / kPlaces;
        append_row({level, calibration::value_N(profile.curve, level)}, script);
    }
    script += "EOD\n$band << EOD\n";
    for (std::size_t i = 0; i < calibration.bootstrap.level.size(); ++i) {
        append_row({calibration.bootstrap.level[i], calibration.bootstrap.low_N[i], calibration.bootstrap.high_N[i]},
                   script);
    }
    script += "EOD\n";
    const bool band = calibration.bootstrap.fits > 0;
    const std::string range = "set xrange [" + files::number_text(profile.level_lowest) + ":" +
                              files::number_text(profile.level_highest) + "]\n";
    const std::string shade = band ? "$band using 1:2:3 with filledcurves lc rgb '#56B4E9' fs transparent solid 0.35 "
                                     "noborder title '95 % band', "
                                   : "";
    const std::string three = shade +
                              "$points using 1:2 with points pt 7 ps 0.5 lc rgb '#000000' title 'measured', "
                              "$curve using 1:2 with lines lw 2 lc rgb '#D55E00' title 'curve'\n";
    script += "set multiplot layout 3,1 title " + single_quoted(title_of(calibration)) +
              " noenhanced\nset lmargin 10\nset grid\n" + range;
    script += "set ylabel 'force (N)'\nset yrange [0:*]\nset key top left\nplot " + three;
    script += "unset key\nset logscale y\nset yrange [*:*]\nset ylabel 'force (N), log scale'\nplot " + three;
    script += "unset logscale y\nset ylabel 'error, left out (%)'\nset xlabel '" + std::string(name_of(profile.level)) +
              "' noenhanced\nset xzeroaxis lw 2\nplot $points using 1:3 with points pt 7 ps 0.5 lc rgb "
              "'#0072B2'\nunset multiplot\n";
    draw_figure(script, file, 800, 1000);
}

}  // namespace palpa::figures
