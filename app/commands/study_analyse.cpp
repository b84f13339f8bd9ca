// palpa study analyse DIR|COUNTS.tsv

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/study.h"
#include "figures/froc_figure.h"
#include "figures/psychometric_figure.h"
#include "figures/study_figures.h"
#include "files/folder_lock.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/table.h"
#include "files/text.h"
#include "study/long_tables.h"
#include "study/protocol.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/stard.h"
#include "study/table_dictionary.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReport =
    "report.json";  // written first: where it stands, the other names are an earlier report's

struct AnalyseOptions {
    std::string input;
    std::string output;
    study::ReportOptions report;
    std::vector<double> scale;  // of ratings: lowest and highest; empty: all numbers
    bool lapse = false;         // its greatest probability was given
    bool json = false;
};

bool is_folder_of_logs(const fs::path& folder) {
    if (fs::exists(folder / "study.json") || fs::exists(folder / "participants.tsv")) return true;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        if (entry.path().filename().string().rfind("sub-", 0) == 0) return true;
    }
    return false;
}

// A report has tables of the same names as a study (exclusions.tsv), which it would overwrite.
void refuse_folder_of_logs(const std::string& output) {
    const fs::path folder = fs::weakly_canonical(output);
    fs::path inner;
    for (fs::path outer = folder; outer != inner; outer = outer.parent_path()) {
        const bool of_participant = inner.filename().string().rfind("sub-", 0) == 0;
        if ((outer == folder || of_participant) && is_folder_of_logs(outer))
            throw files::bad_input(output, "", "a folder of logs (" + outer.string() + ")",
                                   "another folder for the report, such as " + (outer / "report").string());
        inner = outer;
    }
}

// The tables and figures that a report may have.
std::vector<std::string> result_names() {
    std::vector<std::string> names{"figures.gp",    "froc.gp",  "psychometric.gp",
                                   "mixed_model.R", "stard.md", "report.md"};
    for (const std::string& table : study::long_table_names())
        names.insert(names.end(), {table + ".tsv", table + ".json"});
    for (const std::string& table : study::table_names()) names.insert(names.end(), {table + ".tsv", table + ".json"});
    for (const char* figure : {"sensitivity", "nodules", "ppv", "froc", "psychometric"}) {
        for (const char* kind : {".svg", ".pdf", ".png"}) names.push_back(std::string(figure) + kind);
    }
    return names;
}

// Removes what an earlier report has left in its folder, since not every report has all tables and figures.
void remove_earlier_report(const fs::path& folder) {
    if (!fs::exists(folder / kReport)) return;
    std::error_code ignored;
    for (const std::string& name : result_names()) {
        if (fs::is_regular_file(fs::symlink_status(folder / name))) fs::remove(folder / name, ignored);
    }
}

// The protocol beside logs; nothing for a table, and for single runs.
std::optional<study::Protocol> protocol_of(const fs::path& input) {
    if (!fs::is_directory(input) || !fs::exists(input / "protocol.json")) return std::nullopt;
    return study::read_protocol(input / "protocol.json");
}

// The logs know which answers were typed in, without the scenes.
std::string stard_of(const study::Report& report, const study::Observations& seen,
                     std::optional<study::Protocol> protocol) {
    if (!protocol) return study::stard_checklist(report, nullptr);
    for (study::Condition& condition : protocol->conditions) {
        const auto typed = [&](const study::ConditionDisplay& one) {
            return one.condition == condition.id && one.typed_in;
        };
        condition.typed_in = condition.typed_in || std::any_of(seen.displays.begin(), seen.displays.end(), typed);
    }
    return study::stard_checklist(report, &*protocol);
}

void write_report(const study::Report& report, const study::Observations& seen,
                  const std::optional<study::Protocol>& protocol, const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
    const files::FolderLock lock(folder, "another palpa study analyse");  // two would remove each other's figures
    remove_earlier_report(folder);
    files::write_text_atomically(folder / kReport, files::json_text(study::report_json(report)));
    for (const study::ReportTable& table : study::report_tables(report)) {
        files::write_text_atomically(folder / (table.name + ".tsv"), study::tsv_text(table));
        files::write_text_atomically(folder / (table.name + ".json"), files::json_text(study::dictionary_of(table)));
    }
    for (const study::LongTable& one : study::long_tables(seen)) {
        files::write_text_atomically(folder / (one.table.name + ".tsv"), study::tsv_text(one.table));
        files::write_text_atomically(folder / (one.table.name + ".json"), files::json_text(one.dictionary));
    }
    const std::string script = study::lme4_script(report.mixed);
    if (!script.empty()) files::write_text_atomically(folder / "mixed_model.R", script);
    files::write_text_atomically(folder / "stard.md", stard_of(report, seen, protocol));
    files::write_text_atomically(folder / "report.md", study::report_markdown(report));
    std::string failed;
    for (const auto draw : {&figures::draw_figures, &figures::draw_froc_figure, &figures::draw_psychometric_figure}) {
        try {
            const std::string trouble = draw(report, folder);
            if (!trouble.empty()) std::fprintf(stderr, "palpa: %s\n", trouble.c_str());
        } catch (const std::runtime_error& failure) {
            failed += (failed.empty() ? "" : "\n") + std::string(failure.what());
        }
    }
    if (!failed.empty()) throw std::runtime_error(failed);
}

study::Observations read_observations(const AnalyseOptions& options) {
    const std::string& input = options.input;
    if (!fs::exists(input)) throw files::bad_input(input, "", "nothing", "a folder of logs or a table COUNTS.tsv");
    if (fs::is_directory(input)) {
        if (!options.scale.empty())
            throw files::bad_input("--rating-scale", "", "the folder " + input,
                                   "a table: logs hold their protocol's scale");
        return study::read_study(input);
    }
    if (!options.scale.empty() && !files::read_tsv(input).has_column("kind"))
        throw files::bad_input("--rating-scale", "", input + ", which holds no ratings",
                               "a table of rated marks: condition participant case kind lesion rating");
    study::RatingScale scale;
    if (!options.scale.empty()) scale = {options.scale[0], options.scale[1]};
    if (!(scale.low < scale.high)) {
        throw files::bad_input("--rating-scale", "",
                               files::short_number(scale.low) + " " + files::short_number(scale.high),
                               "the lowest rating, then the highest");
    }
    return study::read_counts(input, scale);
}

// Neither the input nor a file of somebody's own may have the name of a result.
void check_results(const AnalyseOptions& options) {
    // the logs of a study have fixed names; a table of counts may have any name
    if (!fs::is_directory(options.input)) {
        std::vector<std::string> names = result_names();
        names.push_back(kReport);
        files::check_output_folder(options.output, {options.input}, names);
    }
    files::check_own_results(options.output, kReport, result_names());
}

void analyse(const AnalyseOptions& options) {
    if (!options.output.empty()) {
        files::check_output_folder(options.output);
        refuse_folder_of_logs(options.output);
    }
    const study::Observations seen = read_observations(options);
    if (options.lapse && seen.stiffer.empty())
        throw files::bad_input("--greatest-lapse", "", options.input + ", which has no psychometric functions",
                               "answers to pairs of two stiffnesses");
    const study::Report report = study::make_report(seen, options.report);
    if (!options.output.empty()) check_results(options);
    if (!options.output.empty()) write_report(report, seen, protocol_of(options.input), options.output);
    const std::string text =
        options.json ? files::json_text(study::report_json(report)) : study::report_markdown(report);
    std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_study_analyse(CLI::App& study) {
    auto options = std::make_shared<AnalyseOptions>();
    CLI::App* command = study.add_subcommand("analyse", "Make tables and figures from a study's logs, or from counts");
    command
        ->add_option("INPUT", options->input,
                     "folder of a study's logs; or a table COUNTS.tsv with the columns condition tp fn fp (also n, "
                     "nodule, participant, group), or condition correct n (also comparison, participant, group), or "
                     "condition reference_kPa comparison_kPa stiffer n (also participant); or a table of rated marks "
                     "with the columns "
                     "condition participant case kind lesion rating (also group)")
        ->required();
    command->add_option("-o,--output", options->output, "folder for report.md, report.json, tables and figures");
    command->add_option("--rating-scale", options->scale, "lowest and highest rating of a table of rated marks")
        ->expected(2);
    command
        ->add_option("--level", options->report.bootstrap.level,
                     "confidence level of all intervals but the staircases' (default 0.95)")
        ->check(CLI::Range(0.5, 0.9999));
    command
        ->add_option("--resamples", options->report.bootstrap.resamples,
                     "number of resamples of the bootstrap over participants (default 2000)")
        ->check(CLI::Range(100, 1000000));
    command->add_option("--seed", options->report.bootstrap.seed, "seed of the bootstrap (default 1)");
    command
        ->add_option("--greatest-lapse", options->report.greatest_lapse,
                     "greatest probability of an answer by mistake in psychometric functions; 0: none (default 0.05)")
        ->check(CLI::Range(0.0, 0.2));
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([command, options] {
        options->lapse = command->count("--greatest-lapse") > 0;
        analyse(*options);
    });
}

}  // namespace palpa::app
