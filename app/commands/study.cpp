// palpa study: protocols, simulated participants, analysis

#include "app/commands/study.h"

#include <CLI/CLI.hpp>

#include "app/commands/command_line.h"

namespace palpa::app {

void add_study(CLI::App& app) {
    CLI::App* study =
        app.add_subcommand("study",
                           "Studies with people: order, power, preregister, run, simulate, import, exclude, replace, "
                           "withdraw, analyse, levels, watch, observers");
    study->require_subcommand(1);
    add_study_order(*study);
    add_study_power(*study);
    add_study_preregister(*study);
    add_study_run(*study);
    add_study_simulate(*study);
    add_study_import(*study);
    add_study_exclude(*study);
    add_study_analyse(*study);
    add_study_levels(*study);
    add_study_watch(*study);
    add_study_observers(*study);
    add_study_withdraw(*study);
}

}  // namespace palpa::app
