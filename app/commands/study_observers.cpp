// palpa study observers

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "app/commands/study.h"
#include "files/input_error.h"
#include "files/json.h"
#include "study/simulated_observer.h"

namespace palpa::app {
namespace {

struct ObserversOptions {
    study::ObserverOptions observer;
    study::ObservedPeople people{0};
    std::vector<int> trials{40, 80, 240};
    int resamples = 500;
    bool json = false;
};

double percent(int held, int of) { return 100.0 * held / of; }

files::Json json_of(int trials, const study::Held& held) {
    return {{"trials", trials},
            {"of", held.of},
            {"pse_held_percent", percent(held.pse, held.of)},
            {"sd_held_percent", percent(held.sd, held.of)},
            {"jnd_ratio_held_percent", percent(held.jnd_ratio, held.of)},
            {"open", held.open},
            {"separated", held.separated}};
}

void measure(const ObserversOptions& options) {
    files::Json json{{"seed", options.observer.seed}, {"people", options.people.n}, {"rows", files::Json::array()}};
    if (!options.json) {
        std::printf("seed %llu; %s; level %g\n", static_cast<unsigned long long>(options.observer.seed),
                    options.people.n == 0 ? "single observers" : "groups of people", options.observer.fit.level);
        std::printf("trials  experiments  PSE held %%  sd held %%  JND ratio held %%  open  separated\n");
    }
    for (const int trials : options.trials) {
        study::ObserverOptions observer = options.observer;
        observer.trials = trials;
        const study::Held held = options.people.n == 0
                                     ? study::coverage_of_profiles(observer)
                                     : study::coverage_of_bootstrap(observer, options.people, options.resamples);
        json["rows"].push_back(json_of(trials, held));
        if (options.json) continue;
        std::printf("%6d  %11d  %10.1f  %9.1f  %16.1f  %4d  %9d\n", trials, held.of, percent(held.pse, held.of),
                    percent(held.sd, held.of), percent(held.jnd_ratio, held.of), held.open, held.separated);
        std::fflush(stdout);
    }
    if (options.json) std::fputs(files::json_text(json).c_str(), stdout);
}

}  // namespace

void add_study_observers(CLI::App& study) {
    auto options = std::make_shared<ObserversOptions>();
    study::ObserverOptions& observer = options->observer;
    CLI::App* command = study.add_subcommand(
        "observers", "Measure how often the intervals of psychometric functions hold the truth of simulated observers");
    command
        ->add_option("--trials", options->trials, "answers of each observer under each condition (default 40 80 240)")
        ->check(CLI::Range(20, 100000));
    command->add_option("--experiments", observer.repeats, "number of simulated experiments (default 1000)")
        ->check(CLI::Range(1, 1000000));
    CLI::Option* people =
        command
            ->add_option("--people", options->people.n,
                         "people in each experiment, whose intervals are by bootstrap; 0: single observers (default 0)")
            ->check(CLI::Range(0, 10000));
    command->add_option("--pse", observer.truth.pse, "point of subjective equality, ln(second/first) (default 0.05)")
        ->check(CLI::Range(-1.0, 1.0));
    command->add_option("--sd", observer.truth.sd, "standard deviation of the noise (default 0.257)")
        ->check(CLI::Range(0.001, 100.0));
    command->add_option("--lapse", observer.truth.lapse, "probability of an answer by mistake (default 0.02)")
        ->check(CLI::Range(0.0, 0.2));
    command
        ->add_option("--pse-spread", options->people.pse_spread, "standard deviation of PSE over people (default 0.1)")
        ->needs(people)
        ->check(CLI::Range(0.0, 1.0));
    command
        ->add_option("--sd-spread", options->people.log_sd_spread,
                     "standard deviation of ln sd over people (default 0.3)")
        ->needs(people)
        ->check(CLI::Range(0.0, 1.0));
    command->add_option("--greatest-lapse", observer.fit.greatest_lapse, "of the fit (default 0.05)")
        ->check(CLI::Range(0.0, 0.2));
    command->add_option("--level", observer.fit.level, "confidence level (default 0.95)")
        ->check(CLI::Range(0.5, 0.9999));
    command->add_option("--resamples", options->resamples, "of each bootstrap over people (default 500)")
        ->needs(people)
        ->check(CLI::Range(100, 100000));
    command->add_option("--seed", observer.seed, "seed of all draws (default 1)");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] {
        if (options->people.n == 1) throw files::bad_input("--people", "", "1", "0, or two people at least");
        measure(*options);
    });
}

}  // namespace palpa::app
