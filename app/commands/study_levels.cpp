// palpa study levels

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/study.h"
#include "files/progress_line.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "study/levels.h"

namespace palpa::app {
namespace {

struct LevelsOptions {
    std::vector<int> people{10, 12, 20};
    std::vector<int> repeats{1, 3, 10};
    std::vector<double> slope_sd{0.7, 1.0};
    study::LevelOptions options;
    std::string output;
};

void measure(const LevelsOptions& asked) {
    if (!asked.output.empty()) files::check_output(asked.output);
    std::vector<study::LevelResult> results;
    const std::size_t cases = asked.people.size() * asked.repeats.size() * asked.slope_sd.size();
    files::ProgressLine line;
    for (const int people : asked.people) {
        for (const int repeats : asked.repeats) {
            for (const double slope_sd : asked.slope_sd) {
                line.show(std::to_string(results.size()) + " of " + std::to_string(cases) + " cases",
                          static_cast<double>(results.size()) / static_cast<double>(cases));
                results.push_back(study::measure_levels({people, repeats, slope_sd}, asked.options));
            }
        }
    }
    const std::string text = study::levels_markdown(results, asked.options);
    if (!asked.output.empty()) files::write_text_atomically(asked.output, text);
    std::fputs(text.c_str(), stdout);
}

}  // namespace

void add_study_levels(CLI::App& study) {
    auto asked = std::make_shared<LevelsOptions>();
    CLI::App* command = study.add_subcommand(
        "levels", "Measure how often the report's tests reject by chance, and how often its intervals cover");
    command->add_option("--people", asked->people, "numbers of participants (default 10,12,20)")
        ->delimiter(',')
        ->check(CLI::Range(3, 1000));
    command->add_option("--repeats", asked->repeats, "numbers of trials under each condition (default 1,3,10)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1000));
    command
        ->add_option("--slope-sd", asked->slope_sd,
                     "how much the difference of the conditions varies between people, in logits (default 0.7,1)")
        ->delimiter(',')
        ->check(CLI::Range(0.0, 10.0));
    command->add_option("--studies", asked->options.studies, "number of drawn studies for each case (default 2000)")
        ->check(CLI::Range(10, 1000000));
    command->add_option("--resamples", asked->options.resamples, "number of resamples of the bootstrap (default 1000)")
        ->check(CLI::Range(100, 1000000));
    command->add_option("--seed", asked->options.seed, "seed of all draws (default 1)");
    command->add_option("--level", asked->options.level, "confidence level (default 0.95)")
        ->check(CLI::Range(0.5, 0.9999));
    command->add_option("-o,--output", asked->output, "file for the tables, in Markdown");
    command->callback([asked] { measure(*asked); });
}

}  // namespace palpa::app
