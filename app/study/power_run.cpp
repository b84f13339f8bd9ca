#include "app/study/power_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>
#include <unistd.h>

#include "app/study/simulated_trial.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/sha256.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kColumns = "effect\tnoise\tparticipants\tquantity\ta\tb\tmethod\tlabel\tp\testimate\tlow\thigh\n";

struct PowerPlan {
    const study::Protocol& protocol;
    const PowerOptions& options;
    StudyScenes scenes;
    std::string fingerprint;  // of power_run.json
    std::size_t reference = 0;
    std::vector<int> missing;  // studies that this call computes
};

files::Json settings_of(const PowerPlan& plan) {
    const study::Protocol& protocol = plan.protocol;
    const PowerOptions& options = plan.options;
    return {{"program", "palpa " PALPA_VERSION},
            {"protocol", protocol.name},
            {"protocol_sha256", protocol.sha256},
            {"orders_version", study::kOrdersVersion},
            {"files", identities_of(plan.scenes)},
            {"reference", protocol.conditions[plan.reference].id},
            {"participants", options.participants},
            {"effects", options.effects},
            {"noises", options.noises},
            {"seed", options.seed},
            {"rate_Hz", options.rate_Hz},
            {"level", options.report.bootstrap.level},
            {"resamples", options.report.bootstrap.resamples}};
}

fs::path piece_of(const PowerPlan& plan, int run) {
    char name[64];
    std::snprintf(name, sizeof name, "run-%05d-%s.tsv", run, plan.fingerprint.substr(0, 12).c_str());
    return plan.options.output / "runs" / name;
}

// The first key in which a folder's power_run.json differs from what is asked for.
void refuse_other_run(const fs::path& file, const files::Json& found, const files::Json& wanted) {
    for (const auto& [key, value] : wanted.items()) {
        if (found.is_object() && found.contains(key) && found[key] == value) continue;
        const std::string there = found.is_object() && found.contains(key) ? found[key].dump() : "nothing";
        throw files::bad_input(file.string(), key, there, value.dump() + ": two power runs never share a folder");
    }
}

void open_power_folder(const files::Json& settings, PowerPlan& plan) {
    const fs::path& folder = plan.options.output;
    const fs::path file = folder / "power_run.json";
    if (plan.options.merge && !fs::exists(file))
        throw files::bad_input(file.string(), "", "nothing", "the parts of a power run, before --merge");
    std::error_code error;
    fs::create_directories(folder / "runs", error);
    if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
    if (fs::exists(file)) {
        refuse_other_run(file, files::read_json(file), settings);
    } else {
        files::write_text_atomically(file, files::json_text(settings));
    }
    const std::string ending = "-" + plan.fingerprint.substr(0, 12) + ".tsv";
    for (const auto& entry : fs::directory_iterator(folder / "runs")) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("run-", 0) != 0 || !name.ends_with(".tsv") || name.ends_with(ending)) continue;
        throw files::bad_input(
            entry.path().string(), "", "a study of another power run",
            "studies of this one alone (run-NNNNN" + ending + "): two power runs never share a folder");
    }
}

std::string rows_text(const std::vector<study::PowerRow>& rows) {
    std::string out = kColumns;
    for (const study::PowerRow& row : rows) {
        const study::Finding& f = row.finding;
        const auto word = [](const std::string& text) { return text.empty() ? std::string("n/a") : text; };
        for (const std::string& cell :
             {files::number_text(row.effect), files::number_text(row.noise), std::to_string(row.participants),
              f.quantity, f.a, word(f.b), f.method, word(f.label), files::number_text(f.p),
              files::number_text(f.estimate), files::number_text(f.ci.low), files::number_text(f.ci.high)}) {
            out += cell + "\t";
        }
        out.back() = '\n';
    }
    return out;
}

void read_rows(const fs::path& file, std::vector<study::PowerRow>& out) {
    files::Table table(files::read_text(file), file.string(), '\t');
    const auto column = [&](const char* name) { return table.column(name); };
    const std::size_t effect = column("effect"), noise = column("noise"), participants = column("participants");
    const std::size_t quantity = column("quantity"), a = column("a"), b = column("b"), method = column("method");
    const std::size_t label = column("label"), p = column("p"), estimate = column("estimate"), low = column("low");
    const std::size_t high = column("high");
    const auto word = [&](std::size_t i) {
        const std::string_view text = table.field(i);
        return text == "n/a" ? std::string() : std::string(text);
    };
    while (table.next()) {
        out.push_back({table.number(effect),
                       table.number(noise),
                       static_cast<int>(table.number(participants)),
                       {word(quantity),
                        word(a),
                        word(b),
                        word(method),
                        word(label),
                        table.number(p),
                        table.number(estimate),
                        {table.number(low), table.number(high)}}});
    }
}

std::vector<study::PowerRow> one_study(const PowerPlan& plan, int run, PowerSessions& sessions) {
    const PowerOptions& options = plan.options;
    const int most = *std::max_element(options.participants.begin(), options.participants.end());
    const std::uint64_t seed = study::derived_seed(options.seed, kStudies, static_cast<std::uint64_t>(run));
    std::vector<study::PowerRow> rows;
    for (const double effect : options.effects) {
        for (const double noise : options.noises) {
            const study::Observations seen = study_in_memory(
                plan.protocol, plan.scenes, most, seed, {effect, noise, plan.reference}, options.rate_Hz, sessions);
            for (const int n : options.participants) {
                const study::Report report = make_report(first_people(plan.protocol, seen, n), options.report);
                for (study::Finding& finding : study::findings_of(report))
                    rows.push_back({effect, noise, n, std::move(finding)});
            }
        }
    }
    return rows;
}

struct PowerWork {
    const PowerPlan& plan;
    std::atomic<std::size_t> next{0};
    std::atomic<std::size_t> done{0};
    std::atomic<bool> stop{false};
    std::mutex mutex;
    std::vector<study::PowerRow> rows;  // where nothing is kept in a folder
    std::exception_ptr error;
};

void compute_studies(PowerWork& work) {
    PowerSessions sessions(work.plan.protocol.conditions.size());
    try {
        while (!work.stop) {
            const std::size_t i = work.next++;
            if (i >= work.plan.missing.size()) return;
            const int run = work.plan.missing[i];
            std::vector<study::PowerRow> rows = one_study(work.plan, run, sessions);
            if (!work.plan.options.output.empty()) {
                files::write_text_atomically(piece_of(work.plan, run), rows_text(rows));
            } else {
                const std::lock_guard lock(work.mutex);
                work.rows.insert(work.rows.end(), rows.begin(), rows.end());
            }
            ++work.done;
        }
    } catch (...) {
        const std::lock_guard lock(work.mutex);
        if (!work.error) work.error = std::current_exception();
        work.stop = true;
    }
}

// A line that is written over on a terminal once a second, and a new line every minute elsewhere.
void tell_progress(const PowerWork& work, double wall_s) {
    const std::size_t done = work.done, all = work.plan.missing.size();
    const double left_s = done > 0 ? wall_s * static_cast<double>(all - done) / static_cast<double>(done) : 0.0;
    const bool terminal = isatty(STDERR_FILENO) != 0;
    std::fprintf(stderr, "%s%zu of %zu studies, %.0f s left%s", terminal ? "\r" : "", done, all, left_s,
                 terminal ? " " : "\n");
}

void compute_all(PowerWork& work) {
    const PowerOptions& options = work.plan.options;
    const double began_s = files::steady_s();
    std::vector<std::thread> threads;
    for (int i = 0; i < options.jobs; ++i) threads.emplace_back([&work] { compute_studies(work); });
    const int ticks_between = isatty(STDERR_FILENO) != 0 ? 20 : 1200;
    for (int tick = 1; !work.stop && work.done < work.plan.missing.size(); ++tick) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        if (!options.quiet && tick % ticks_between == 0) tell_progress(work, files::steady_s() - began_s);
    }
    for (std::thread& thread : threads) thread.join();
    if (!options.quiet && isatty(STDERR_FILENO) != 0) std::fputc('\n', stderr);
    if (work.error) std::rethrow_exception(work.error);
}

}  // namespace

PowerOutcome measure_power(const study::Protocol& protocol, const PowerOptions& options) {
    PowerPlan plan{protocol, options, load_study_scenes(protocol), "", 0, {}};
    check_power_protocol(protocol, plan.scenes);
    plan.reference = reference_of(protocol, plan.scenes, options.reference);
    const files::Json settings = settings_of(plan);
    plan.fingerprint = files::sha256_hex(files::json_text(settings));
    const bool kept = !options.output.empty();
    if (kept) open_power_folder(settings, plan);
    PowerOutcome out;
    out.reference = protocol.conditions[plan.reference].id;
    int first_missing = 0, missing = 0;
    for (int run = 1; run <= options.runs; ++run) {
        if (kept && fs::exists(piece_of(plan, run))) {
            ++out.already_there;
            continue;
        }
        if (missing++ == 0) first_missing = run;
        if (!options.merge && (run - 1) % options.parts == options.part - 1) plan.missing.push_back(run);
    }
    if (options.merge && missing > 0) {
        throw files::bad_input(options.output.string(), "",
                               std::to_string(out.already_there) + " of " + std::to_string(options.runs) +
                                   " studies (" + std::to_string(first_missing) + " is the first that is missing)",
                               "all of them before --merge");
    }
    PowerWork work{plan, {}, {}, {}, {}, {}, {}};
    compute_all(work);
    out.computed = static_cast<int>(plan.missing.size());
    if (options.parts > 1) return out;
    for (int run = 1; kept && run <= options.runs; ++run) read_rows(piece_of(plan, run), work.rows);
    out.complete = true;
    out.results = study::summarise_power(work.rows, options.runs, options.alpha);
    return out;
}

std::string simulated_people_text() {
    return "strips (75 %) or spirals, 12 mm apart (sd 2); 35 mm/s (sd of ln 0.2); force 1.4 times the deep zone (sd of "
           "ln "
           "0.15); noise of the eye for the lag 0.1 mm (sd of ln 0.3) and for the dent 20 %, both times the factor "
           "noise; "
           "criterion 3.5 (sd 0.3) standard deviations; felt stiffness 20 % times noise. These are choices of the "
           "program, "
           "fitted to no person's data";
}

}  // namespace palpa::app
