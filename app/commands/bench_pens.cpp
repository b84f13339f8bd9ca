// palpa bench pens: how well the curves predict points of real pens that they were not fitted to.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>

#include "app/commands/command_line.h"
#include "calibration/choose.h"
#include "calibration/points.h"
#include "calibration/quality.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/quantile.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::app {
namespace {

// One pen on one tablet on one day, with the rows as recorded.
struct Session {
    std::vector<double> level;
    std::vector<double> force_N;
    std::vector<std::size_t> line;
};

std::map<std::string, Session> read_sessions(const std::string& file) {
    files::Table table = files::read_csv(file);
    const std::size_t level = table.column("pressure_norm");
    const std::size_t force_N = table.column("force_N");
    std::vector<std::size_t> names;
    for (const char* name : {"inventory_id", "tablet", "date"}) names.push_back(table.column(name));
    std::map<std::string, Session> sessions;
    while (table.next()) {
        std::string name;
        for (const std::size_t column : names) name += (name.empty() ? "" : " ") + std::string(table.field(column));
        Session& session = sessions[name];
        session.level.push_back(table.finite_number(level));
        if (!(session.level.back() >= 0.0 && session.level.back() <= 1.0)) table.fail(level, "a pressure from 0 to 1");
        session.force_N.push_back(table.finite_number(force_N));
        if (session.force_N.back() < 0.0) table.fail(force_N, "a force of 0 or more");
        session.line.push_back(table.line());
    }
    return sessions;
}

struct Contestant {
    const char* name;
    std::optional<calibration::CurveModel> model;
    std::optional<calibration::ErrorModel> error;
    calibration::Robust robust = calibration::Robust::huber;
    bool all_rows = false;  // leaves out nothing at the ends, and gives a cubic a knot for each level
};

const Contestant kContestants[] = {
    {"exponential, newton, plain (as printed)", calibration::CurveModel::exponential, calibration::ErrorModel::newton,
     calibration::Robust::none, true},
    {"exponential, log", calibration::CurveModel::exponential, calibration::ErrorModel::log},
    {"exponential_offset, newton", calibration::CurveModel::exponential_offset, calibration::ErrorModel::newton},
    {"exponential_offset, log", calibration::CurveModel::exponential_offset, calibration::ErrorModel::log},
    {"power, log", calibration::CurveModel::power, calibration::ErrorModel::log},
    {"monotone_cubic, a knot for each level", calibration::CurveModel::monotone_cubic, calibration::ErrorModel::log,
     calibration::Robust::huber, true},
    {"auto", std::nullopt, std::nullopt},
};

struct Errors {
    std::vector<double> light;  // level up to a fifth
    std::vector<double> firm;
    int failed = 0;
};

constexpr calibration::LevelRange kRange{0.0, 1.0};

std::optional<calibration::Curve> fitted(const Contestant& contestant, const calibration::CalibrationRows& rows) {
    const calibration::FitPoints points =
        contestant.all_rows ? calibration::fit_points(rows, {-1.0, 1.0}, {})
                            : calibration::fit_points(rows, kRange, calibration::ends_of(rows, kRange));
    if (contestant.all_rows && contestant.model == calibration::CurveModel::monotone_cubic)
        return calibration::fit_cubic(points, calibration::cubic_bins(points, 0));
    const calibration::Candidate best = calibration::choose(
        points, calibration::candidates(points, contestant.model, contestant.error, contestant.robust, kRange.highest),
        contestant.error);
    if (best.predicted_N.size() == 0) return std::nullopt;
    return calibration::fit_curve(points, best.options);
}

// Fits to the rows 2, 4, ... of a session (or 1, 3, ...) and measures the error on the others.
void judge(const Contestant& contestant, const Session& session, std::size_t first_fitted, bool silent_too,
           Errors& errors) {
    calibration::CalibrationRows rows;
    for (std::size_t i = first_fitted; i < session.level.size(); i += 2) {
        rows.level.push_back(session.level[i]);
        rows.force_N.push_back(session.force_N[i]);
        rows.line.push_back(session.line[i]);
    }
    const std::optional<calibration::Curve> curve = fitted(contestant, rows);
    if (!curve) {
        ++errors.failed;
        return;
    }
    for (std::size_t i = 1 - first_fitted; i < session.level.size(); i += 2) {
        if (session.level[i] <= 0.0 && !silent_too) continue;
        const double predicted_N = std::max(0.0, calibration::value_N(*curve, session.level[i]));
        const double off = std::abs(predicted_N - session.force_N[i]) / session.force_N[i];
        (session.level[i] < 0.2 ? errors.light : errors.firm).push_back(off);
    }
}

files::Json row_json(const char* name, Errors& errors) {
    return {{"curve", name},
            {"n_light", errors.light.size()},
            {"median_light", files::median(errors.light)},
            {"p90_light", files::quantile(errors.light, 0.9)},
            {"n_firm", errors.firm.size()},
            {"median_firm", files::median(errors.firm)},
            {"p90_firm", files::quantile(errors.firm, 0.9)},
            {"failed", errors.failed}};
}

void print_row(const files::Json& row) {
    const auto percent = [&](const char* key) { return 100.0 * row[key].get<double>(); };
    std::printf("  %-42s %7.2f %7.1f    %7.2f %7.2f %8d\n", row["curve"].get_ref<const std::string&>().c_str(),
                percent("median_light"), percent("p90_light"), percent("median_firm"), percent("p90_firm"),
                row["failed"].get<int>());
}

struct PensOptions {
    std::string file;
    bool json = false;
};

void bench_pens(const PensOptions& options) {
    constexpr std::size_t kEnough = 12;
    const auto all = read_sessions(options.file);
    std::vector<const Session*> sessions;
    for (const auto& [name, session] : all) {
        if (session.level.size() >= kEnough) sessions.push_back(&session);
    }
    if (sessions.empty()) throw files::bad_input(options.file, "", "no session of 12 points or more", "one at least");
    struct Split {
        const char* name;
        std::size_t first_fitted;
        bool silent_too;
    };
    files::Json json{{"sessions", sessions.size()},
                     {"sessions_left_out", all.size() - sessions.size()},
                     {"splits", files::Json::array()}};
    if (!options.json && sessions.size() < all.size())
        std::printf("%zu of %zu sessions have fewer than %zu points and are left out\n", all.size() - sessions.size(),
                    all.size(), kEnough);
    for (const Split& split :
         {Split{"fitted to rows 2, 4, ..., judged on rows 1, 3, ... with a level above 0", 1, false},
          Split{"the same, rows with level 0 judged too", 1, true},
          Split{"fitted to rows 1, 3, ..., judged on rows 2, 4, ... with a level above 0", 0, false}}) {
        if (!options.json) {
            std::printf("%zu sessions, %s\n  %-42s %15s    %15s\n  %-42s %7s %7s    %7s %7s %8s\n", sessions.size(),
                        split.name, "relative error (%)", "below 20 %", "above 20 %", "", "median", "p90", "median",
                        "p90", "failed");
        }
        files::Json rows = files::Json::array();
        for (const Contestant& contestant : kContestants) {
            Errors errors;
            for (const Session* session : sessions)
                judge(contestant, *session, split.first_fitted, split.silent_too, errors);
            rows.push_back(row_json(contestant.name, errors));
            if (!options.json) print_row(rows.back());
        }
        json["splits"].push_back({{"split", split.name}, {"curves", rows}});
    }
    if (options.json) std::fputs(files::json_text(json).c_str(), stdout);
}

}  // namespace

void add_bench_pens(CLI::App& bench) {
    auto options = std::make_shared<PensOptions>();
    CLI::App* command = bench.add_subcommand(
        "pens", "Measure the calibration curves' error on recordings of real pens, on points left out of the fit");
    command->add_option("FILE", options->file, "CSV with inventory_id, tablet, date, pressure_norm, force_N")
        ->required();
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { bench_pens(*options); });
}

}  // namespace palpa::app
