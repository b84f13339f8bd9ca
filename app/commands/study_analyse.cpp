// palpa study analyse DIR|COUNTS.tsv

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/study.h"
#include "figures/psychometric_figure.h"
#include "figures/study_figures.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "study/read_logs.h"
#include "study/report.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

struct AnalyseOptions {
    std::string input;
    std::string output;
    study::ReportOptions report;
    bool json = false;
};

void write_report(const study::Report& report, const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
    for (const study::ReportTable& table : study::report_tables(report)) {
        files::write_text_atomically(folder / (table.name + ".tsv"), study::tsv_text(table));
    }
    files::write_text_atomically(folder / "report.md", study::report_markdown(report));
    files::write_text_atomically(folder / "report.json", files::json_text(study::report_json(report)));
    for (const std::string& trouble :
         {figures::draw_figures(report, folder), figures::draw_psychometric_figure(report, folder)}) {
        if (!trouble.empty()) std::fprintf(stderr, "palpa: %s\n", trouble.c_str());
    }
}

std::vector<std::string> names_of(const study::Report& report) {
    std::vector<std::string> names{"report.md",   "report.json", "figures.gp",
                                   "figures.png", "figures.svg", "figures.pdf"};
    for (const char* kind : {"gp", "png", "svg", "pdf"}) names.push_back(std::string("psychometric.") + kind);
    for (const study::ReportTable& table : study::report_tables(report)) names.push_back(table.name + ".tsv");
    return names;
}

study::Observations read_observations(const std::string& input) {
    if (!fs::exists(input)) throw files::bad_input(input, "", "nothing", "a folder of logs or a table COUNTS.tsv");
    return fs::is_directory(input) ? study::read_study(input) : study::read_counts(input);
}

void analyse(const AnalyseOptions& options) {
    if (!options.output.empty()) files::check_output_folder(options.output);
    const study::Report report = study::make_report(read_observations(options.input), options.report);
    // the logs of a study have fixed names; a table of counts may have any name
    if (!options.output.empty() && !fs::is_directory(options.input))
        files::check_output_folder(options.output, {options.input}, names_of(report));
    if (!options.output.empty()) write_report(report, options.output);
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
                     "condition reference_kPa comparison_kPa stiffer n (also participant)")
        ->required();
    command->add_option("-o,--output", options->output, "folder for report.md, report.json, tables and figures");
    command->add_option("--level", options->report.bootstrap.level, "confidence level of all intervals (default 0.95)")
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
    command->callback([options] { analyse(*options); });
}

}  // namespace palpa::app
