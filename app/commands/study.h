#pragma once

namespace CLI {
class App;
}

namespace palpa::app {

// The subcommands of `palpa study`, each in its own file.
void add_study_analyse(CLI::App& study);
void add_study_exclude(CLI::App& study);  // and replace
void add_study_import(CLI::App& study);
void add_study_levels(CLI::App& study);
void add_study_observers(CLI::App& study);
void add_study_order(CLI::App& study);
void add_study_power(CLI::App& study);
void add_study_preregister(CLI::App& study);
void add_study_run(CLI::App& study);
void add_study_simulate(CLI::App& study);
void add_study_watch(CLI::App& study);
void add_study_withdraw(CLI::App& study);

}  // namespace palpa::app
