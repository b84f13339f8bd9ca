// palpa calibrate fit | check | compare

#include "calibration/calibrate.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "calibration/profile_file.h"
#include "figures/calibration_report.h"
#include "figures/gnuplot.h"
#include "files/input_error.h"
#include "files/quantile.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::app {
namespace {

std::vector<calibration::RowFilter> parse_where(const std::vector<std::string>& texts) {
    std::vector<calibration::RowFilter> where;
    for (const std::string& text : texts) {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw files::bad_input("--where", "", files::shown(text), "COLUMN=VALUE");
        where.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    return where;
}

void add_where(CLI::App& command, std::vector<std::string>& where) {
    command.add_option("--where", where, "COLUMN=VALUE: use only these rows; repeatable")
        ->take_all()
        ->allow_extra_args(false);
}

struct FitArguments {
    std::string data;
    std::string output;
    std::string figure;
    std::string model = "auto";
    std::string error = "auto";
    std::string robust = "huber";
    std::string level = "auto";
    std::vector<double> range;
    std::vector<std::string> where;
    calibration::CalibrateOptions options;
    calibration::DeviceNames device;
    bool keep_lag = false;
    bool any_force = false;
    bool full_area_given = false;
    bool json = false;
};

template <class Enum>
std::optional<Enum> parsed(const std::string& name, std::initializer_list<Enum> values) {
    for (const Enum value : values) {
        if (name == name_of(value)) return value;
    }
    return std::nullopt;  // auto
}

constexpr auto kLevels = {calibration::LevelField::pressure, calibration::LevelField::pressure_raw,
                          calibration::LevelField::contact_area};

// `calibrate record` keeps beside its points what their levels are. Empty for other data.
std::filesystem::path session_of(const std::filesystem::path& data) {
    return data.filename() == "points.csv" ? data.parent_path() / "session.json" : std::filesystem::path();
}

// What it says; null if there is none.
files::Json read_session(const std::filesystem::path& data) {
    const std::filesystem::path file = session_of(data);
    if (file.empty() || !std::filesystem::exists(file)) return {};
    files::Json session = files::read_json(file);
    return session.is_object() ? session : files::Json();
}

// What the session says of the levels; options take precedence.
void take_session(const FitArguments& arguments, calibration::CalibrateOptions& options) {
    const files::Json session = read_session(arguments.data);
    if (session.is_null()) return;
    const files::Json level = session.value("level", files::Json());
    const files::Json area = session.value("full_contact_area_px2", files::Json());
    if (!options.level && level.is_string()) options.level = parsed(level.get<std::string>(), kLevels);
    const bool by_area = options.level == calibration::LevelField::contact_area;
    if (by_area && !arguments.full_area_given && area.is_number() && area > 0.0)
        options.full_contact_area_px2 = area.get<double>();
}

calibration::CalibrateOptions fit_options(const FitArguments& arguments) {
    calibration::CalibrateOptions options = arguments.options;
    options.model =
        parsed(arguments.model, {calibration::CurveModel::exponential, calibration::CurveModel::exponential_offset,
                                 calibration::CurveModel::power, calibration::CurveModel::monotone_cubic});
    options.error = parsed(arguments.error, {calibration::ErrorModel::newton, calibration::ErrorModel::log});
    options.robust = arguments.robust == "none"    ? calibration::Robust::none
                     : arguments.robust == "huber" ? calibration::Robust::huber
                                                   : calibration::Robust::tukey;
    options.level = parsed(arguments.level, kLevels);
    take_session(arguments, options);
    options.remove_lag = !arguments.keep_lag;
    constexpr int kFewestFits = 100;  // fewer give an interval that may not even hold the curve itself
    if (options.bootstrap_fits > 0 && options.bootstrap_fits < kFewestFits) {
        throw files::bad_input("--bootstrap", "", std::to_string(options.bootstrap_fits),
                               "0 (no intervals) or 100 to 100000");
    }
    if (!arguments.range.empty()) {
        if (!(arguments.range[0] < arguments.range[1])) {
            throw files::bad_input(
                "--level-range", "",
                files::short_number(arguments.range[0]) + " " + files::short_number(arguments.range[1]),
                "the lower level first");
        }
        options.range = calibration::LevelRange{arguments.range[0], arguments.range[1]};
    }
    return options;
}

// What the options say about the device takes precedence over the columns of the file.
void name_device(const calibration::DeviceNames& given, calibration::DeviceNames& device) {
    for (const auto field :
         {&calibration::DeviceNames::pen, &calibration::DeviceNames::tablet, &calibration::DeviceNames::driver,
          &calibration::DeviceNames::os, &calibration::DeviceNames::date}) {
        if (!(given.*field).empty()) device.*field = given.*field;
        if ((device.*field).empty()) device.*field = "n/a";
    }
}

void fit(const FitArguments& arguments) {
    const std::vector<std::filesystem::path> inputs{arguments.data, session_of(arguments.data)};
    files::check_output(arguments.output, inputs);
    if (!arguments.figure.empty()) {
        figures::check_figure(arguments.figure);
        files::check_output(arguments.figure, inputs);
        if (std::filesystem::weakly_canonical(arguments.figure) == std::filesystem::weakly_canonical(arguments.output))
            throw files::bad_input(arguments.figure, "", "the profile's own name", "another one for the figure");
    }
    const calibration::CalibrateOptions options = fit_options(arguments);
    const calibration::CalibrationRows rows =
        calibration::read_points(arguments.data, {parse_where(arguments.where), arguments.any_force});
    if (arguments.keep_lag && rows.time_s.empty())
        throw files::bad_input("--keep-lag", "", "no column time_s in " + rows.file,
                               "one: a lag is only found by times");
    if (options.range) {
        const double highest = *std::max_element(rows.level.begin(), rows.level.end());
        if (highest > options.range->highest) {
            throw files::bad_input(rows.file, "level", "levels up to " + files::short_number(highest),
                                   "at most " + files::short_number(options.range->highest) + " as --level-range says");
        }
    }
    calibration::Calibration calibration = calibration::calibrate(rows, options);
    name_device(arguments.device, calibration.profile.device);
    calibration::write_profile(calibration.profile, figures::quality_json(calibration), arguments.output);
    if (arguments.json) {
        std::fputs(files::json_text(figures::calibration_json(calibration)).c_str(), stdout);
    } else {
        figures::print_calibration(calibration);
        std::printf("  profile     %s\n", arguments.output.c_str());
    }
    if (!arguments.figure.empty()) figures::plot_calibration(calibration, arguments.figure);
}

void add_fit(CLI::App& calibrate) {
    auto arguments = std::make_shared<FitArguments>();
    CLI::App* command = calibrate.add_subcommand("fit", "Fit a profile to measured points");
    command
        ->add_option("DATA", arguments->data,
                     "CSV with level (or pressure_norm) and force_N or force_gf; optional: time_s, repeat, phase")
        ->required();
    command->add_option("-o,--output", arguments->output, "PROFILE.json to write; replaces a file of that name")
        ->required();
    command
        ->add_option("--model", arguments->model,
                     "curve to fit; auto chooses the model that best predicts points left out of the fit")
        ->check(one_of({"auto", "exponential", "exponential_offset", "power", "monotone_cubic"}))
        ->capture_default_str();
    command
        ->add_option("--error", arguments->error,
                     "error assumed to be equally large everywhere: newton, or log (a share of the force)")
        ->check(one_of({"auto", "newton", "log"}))
        ->capture_default_str();
    command
        ->add_option("--robust", arguments->robust, "robust weights that keep slips of the pen from pulling the curve")
        ->check(one_of({"none", "huber", "tukey"}))
        ->capture_default_str();
    command
        ->add_option(
            "--level", arguments->level,
            "field of a sample that is the level (auto: that of a recorded session, else pressure, or pressure_raw if "
            "levels exceed 1)")
        ->check(one_of({"auto", "pressure", "pressure_raw", "contact_area"}))
        ->capture_default_str();
    command
        ->add_option("--level-range", arguments->range,
                     "LOWEST HIGHEST level that the device can report (default: 0 1, or 0 and the next 2^n - 1)")
        ->expected(2)
        ->check(CLI::Range(0.0, 1e9));
    command
        ->add_option("--full-contact-area-px2", arguments->options.full_contact_area_px2,
                     "contact_area only: area of the ellipse whose level is 1")
        ->check(CLI::Range(1.0, 1e9))
        ->capture_default_str();
    add_where(*command, arguments->where);
    command->add_option("--plot", arguments->figure, "draw a figure: FILE.png, .svg or .pdf");
    command
        ->add_option("--bootstrap", arguments->options.bootstrap_fits,
                     "number of resampled fits for the 95 % intervals, 100 or more; 0: no intervals")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    command->add_option("--seed", arguments->options.seed, "seed of the resampling")->capture_default_str();
    command->add_flag("--keep-lag", arguments->keep_lag, "do not remove the pen's lag behind the sensor");
    command->add_flag("--any-force", arguments->any_force, "accept forces that no pen or finger can exert");
    command->add_option("--pen", arguments->device.pen, "name of the pen in the profile");
    command->add_option("--tablet", arguments->device.tablet, "name of the tablet in the profile");
    command->add_option("--driver", arguments->device.driver, "name of the driver in the profile");
    command->add_option("--os", arguments->device.os, "operating system in the profile");
    command->add_option("--date", arguments->device.date, "date of the recording in the profile");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([command, arguments] {
        refuse_unused(*command, "--seed", arguments->options.bootstrap_fits > 0, "--bootstrap above 0");
        arguments->full_area_given = command->count("--full-contact-area-px2") > 0;
        const files::Json session = arguments->level == "auto" ? read_session(arguments->data) : files::Json();
        const bool by_area = !session.is_null() && session.value("level", files::Json()) == "contact_area";
        refuse_unused(*command, "--full-contact-area-px2", by_area || arguments->level == "contact_area",
                      "--level contact_area");
        fit(*arguments);
    });
}

struct CheckArguments {
    std::string profile;
    std::string data;
    std::vector<std::string> where;
    bool json = false;
};

void check(const CheckArguments& arguments) {
    const calibration::Profile profile = calibration::read_profile(arguments.profile);
    calibration::ReadOptions options{parse_where(arguments.where), false};
    options.for_fit = false;
    const calibration::CalibrationRows rows = calibration::read_points(arguments.data, options);
    const calibration::LevelRange range{profile.level_lowest, profile.level_highest};
    const auto n = static_cast<Eigen::Index>(rows.level.size());
    const Eigen::Map<const Eigen::ArrayXd> level(rows.level.data(), n);
    if (n > 0) calibration::check_level(profile.level, {level.minCoeff(), level.maxCoeff()}, arguments.data);
    const Eigen::Map<const Eigen::ArrayXd> measured_N(rows.force_N.data(), n);
    std::int64_t clamped = 0;
    const Eigen::ArrayXd predicted_N = Eigen::ArrayXd::NullaryExpr(
        n, [&](Eigen::Index i) { return calibration::force_N(profile, level(i), clamped); });
    const auto bands = calibration::error_bands(level, measured_N, predicted_N, range);
    const double median = calibration::median_relative_error(level, measured_N, predicted_N, range);
    if (!std::isfinite(median))
        throw files::bad_input(arguments.data, "", "no point whose level and force are above 0",
                               "presses to check with");
    const calibration::FitQuality quality = calibration::fit_quality(measured_N, predicted_N);
    std::vector<std::string> warnings = rows.notes;
    if (clamped > 0)
        warnings.push_back(std::to_string(clamped) + " of " + std::to_string(n) +
                           " levels are outside the profile's range and taken at its end");
    if (median > 0.1)
        warnings.push_back("the profile is off by " + files::short_number(100.0 * median) +
                           " % of the force (median): recalibrate this device");
    if (arguments.json) {
        const files::Json json{{"profile", profile.id},
                               {"n_points", n},
                               {"median_relative_error", median},
                               {"relative_error_bands", figures::bands_json(bands)},
                               {"r2_newton", quality.r2_newton},
                               {"r2_log", quality.r2_log},
                               {"rmse_N", quality.rmse_N},
                               {"predicted_N", std::vector<double>(predicted_N.begin(), predicted_N.end())},
                               {"warnings", warnings}};
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    std::printf("%s on %lld points: off by %s %% of the force (median), RMSE %s N\n", profile.id.c_str(),
                static_cast<long long>(n), files::short_number(100.0 * median).c_str(),
                files::short_number(quality.rmse_N).c_str());
    figures::print_bands(bands, "these points");
    for (const std::string& warning : warnings) std::fprintf(stderr, "palpa: warning: %s\n", warning.c_str());
}

void add_check(CLI::App& calibrate) {
    auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = calibrate.add_subcommand("check", "Show a profile's error on new points");
    command->add_option("PROFILE", arguments->profile, "profile JSON")->required();
    command->add_option("DATA", arguments->data, "CSV with the same columns as for fit")->required();
    add_where(*command, arguments->where);
    command->add_flag("--json", arguments->json,
                      "print one JSON object on standard output, with predicted_N in the order of the rows");
    command->callback([arguments] { check(*arguments); });
}

struct CompareProfilesArguments {
    std::string a;
    std::string b;
    bool json = false;
};

void compare(const CompareProfilesArguments& arguments) {
    const calibration::Profile a = calibration::read_profile(arguments.a);
    const calibration::Profile b = calibration::read_profile(arguments.b);
    constexpr int kPlaces = 20;
    files::Json share = files::Json::array(), a_N = files::Json::array(), b_N = files::Json::array();
    std::vector<double> apart;
    double greatest = 0.0;
    double at = 0.0;
    std::int64_t ignored = 0;
    // each profile over its own range, so that counts can be compared with levels of 0 to 1; areas at equal areas
    const bool areas =
        a.level == calibration::LevelField::contact_area && b.level == calibration::LevelField::contact_area;
    const double full_px2 = std::min(a.full_contact_area_px2, b.full_contact_area_px2);
    const auto force_at = [&](const calibration::Profile& profile, double s) {
        const double part = areas ? s * full_px2 / profile.full_contact_area_px2 : s;
        const double level = profile.level_lowest + part * (profile.level_highest - profile.level_lowest);
        return calibration::force_N(profile, level, ignored);
    };
    for (int i = 0; i <= kPlaces; ++i) {
        const double s = static_cast<double>(i) / kPlaces;
        const double F_a = force_at(a, s), F_b = force_at(b, s);
        share.push_back(s);
        a_N.push_back(F_a);
        b_N.push_back(F_b);
        const double mean_N = 0.5 * (F_a + F_b);
        if (!(mean_N > 0.0)) continue;
        apart.push_back(std::abs(F_b - F_a) / mean_N);
        if (apart.back() <= greatest) continue;
        greatest = apart.back();
        at = s;
    }
    const double median = files::median(apart);
    if (arguments.json) {
        const files::Json json{{"a", a.id},
                               {"b", b.id},
                               {"same_level", a.level == b.level},
                               {"level_share", share},
                               {"a_N", a_N},
                               {"b_N", b_N},
                               {"median_relative_difference", median},
                               {"greatest_relative_difference", greatest},
                               {"greatest_at", at}};
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    std::printf("%-8s %12s %12s %10s\n", "level", a.id.substr(0, 12).c_str(), b.id.substr(0, 12).c_str(), "apart");
    for (std::size_t i = 0; i < share.size(); i += 2) {
        const double F_a = a_N[i].get<double>();
        const double F_b = b_N[i].get<double>();
        const std::string apart_percent =
            F_a + F_b > 0.0 ? files::short_number(200.0 * (F_b - F_a) / (F_a + F_b)) + " %" : "-";
        std::printf("%5.0f %%  %10s N %10s N %10s\n", 100.0 * share[i].get<double>(), files::short_number(F_a).c_str(),
                    files::short_number(F_b).c_str(), apart_percent.c_str());
    }
    std::printf("apart, as a share of the mean of both, by %s %% (median), at most %s %% at %s %% of the range\n",
                files::short_number(100.0 * median).c_str(), files::short_number(100.0 * greatest).c_str(),
                files::short_number(100.0 * at).c_str());
    if (a.level != b.level)
        std::fprintf(stderr, "palpa: warning: the profiles read different fields: %s and %s\n", name_of(a.level),
                     name_of(b.level));
}

void add_compare(CLI::App& calibrate) {
    auto arguments = std::make_shared<CompareProfilesArguments>();
    CLI::App* command = calibrate.add_subcommand(
        "compare", "Compare two profiles, each over its own range of levels; of contact areas at equal areas");
    command->add_option("A", arguments->a, "profile JSON")->required();
    command->add_option("B", arguments->b, "profile JSON")->required();
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { compare(*arguments); });
}

}  // namespace

void add_calibrate(CLI::App& app) {
    CLI::App* calibrate =
        app.add_subcommand("calibrate", "Calibrate pressure levels to newtons: record, fit, check, compare");
    calibrate->require_subcommand(1);
    add_calibrate_record(*calibrate);
    add_fit(*calibrate);
    add_check(*calibrate);
    add_compare(*calibrate);
}

}  // namespace palpa::app
