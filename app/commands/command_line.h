#pragma once

namespace CLI {
class App;
}

namespace palpa::app {

// Exit status: 0 done, 1 the run failed, 2 wrong usage or bad input.
int run_command_line(int argc, char** argv);

// Each function adds a subcommand, whose work runs as a callback of CLI11 and throws on failure.
void add_run(CLI::App& app);
void add_explain(CLI::App& app);
void add_devices(CLI::App& app);
void add_maps(CLI::App& app);
void add_maps_import(CLI::App& maps);
void add_calibrate(CLI::App& app);
void add_calibrate_record(CLI::App& calibrate);
void add_fem(CLI::App& app);
void add_serve(CLI::App& app);
void add_study(CLI::App& app);
void add_tactile(CLI::App& app);
void add_tactile_identify(CLI::App& tactile);
void add_tactile_characterise(CLI::App& tactile);
void add_tactile_pins(CLI::App& tactile);
void add_tangible(CLI::App& app);  // only with the CMake option PALPA_TANGIBLE
void add_tangible_info(CLI::App& tangible);
void add_tangible_solve(CLI::App& tangible);
void add_tangible_run(CLI::App& tangible);
void add_tangible_characterise(CLI::App& tangible);
void add_tangible_fit(CLI::App& tangible);
void add_bench(CLI::App& app);
void add_bench_accuracy(CLI::App& bench);
void add_bench_pens(CLI::App& bench);
void add_bench_speed(CLI::App& bench);
void add_bench_visibility(CLI::App& bench);

}  // namespace palpa::app
