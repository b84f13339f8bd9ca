// palpa bench speed: what a sample costs, in microseconds and in units of the machine.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "accuracy/speed.h"
#ifdef PALPA_TANGIBLE
#include "accuracy/tangible_speed.h"
#endif
#include "app/assets.h"
#include "app/commands/command_line.h"
#include "app/scene_choices.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "session/plan_in_progress.h"

namespace palpa::app {
namespace {

struct SpeedOptions {
    std::vector<std::string> scenes;
    double seconds = 10.0;
    int repetitions = 5;
    bool json = false;
};

void run_speed(const SpeedOptions& options) {
    std::vector<std::string> scenes = options.scenes;
    if (scenes.empty()) {
        for (const char* name : {"default", "delay", "off", "linear", "toothbrush", "button"}) {
            scenes.push_back((assets_folder() / "scenes" / (std::string(name) + ".json")).string());
        }
    }
    const accuracy::SpeedRow unit = accuracy::machine_unit(20);
    std::vector<accuracy::SpeedRow> rows;
    for (const std::string& name : scenes) {
        const scene::Scene scene = load_scene(name);
        rows.push_back(
            accuracy::sample_speed(scene, session::make_plan_here(scene), options.seconds, options.repetitions));
    }
    const accuracy::Machine machine = accuracy::this_machine();
    if (options.json) {
        std::fputs(files::json_text(accuracy::speed_json(unit, rows, machine)).c_str(), stdout);
    } else {
        std::printf("%s, %u threads, load %s, %s\n%s", machine.processor.c_str(), machine.threads,
                    files::short_number(machine.load).c_str(), machine.date.c_str(),
                    accuracy::speed_table(unit, rows).c_str());
    }
}

#ifdef PALPA_TANGIBLE
void run_tangible_speed(bool json, const std::string& folder) {
    const accuracy::TangibleSpeed speed = accuracy::tangible_speed(assets_folder() / "devices");
    const accuracy::Machine machine = accuracy::this_machine();
    const std::string text = files::json_text(accuracy::tangible_speed_json(speed, machine));
    if (!folder.empty()) files::write_text_atomically(std::filesystem::path(folder) / "tangible-speed.json", text);
    if (json)
        std::fputs(text.c_str(), stdout);
    else
        std::printf("%s, %u threads, load %s, %s\n%s", machine.processor.c_str(), machine.threads,
                    files::short_number(machine.load).c_str(), machine.date.c_str(),
                    accuracy::tangible_speed_table(speed).c_str());
}

void add_tangible_speed(CLI::App& speed) {
    struct Options {
        bool json = false;
        std::string folder;
    };
    auto options = std::make_shared<Options>();
    CLI::App* tangible = speed.add_subcommand("tangible", "The inverse step of soft devices, in units of the machine");
    tangible->add_flag("--json", options->json, "one JSON object on standard output");
    tangible->add_option("-o", options->folder, "also write tangible-speed.json here")->check(CLI::ExistingDirectory);
    tangible->callback([options] { run_tangible_speed(options->json, options->folder); });
}
#endif

}  // namespace

void add_bench_speed(CLI::App& bench) {
    auto options = std::make_shared<SpeedOptions>();
    CLI::App* speed = bench.add_subcommand("speed", "What a sample costs, pressure to avatar, at 1,000 Hz");
    speed->add_option("SCENES", options->scenes,
                      "scene JSON, map folder or the name of a shipped one (default: six that ship)");
    speed->add_option("--seconds", options->seconds, "of input, in each repetition (default 10)")
        ->check(CLI::Range(0.1, 1e4));
    speed->add_option("--repetitions", options->repetitions, "default 5")->check(CLI::Range(1, 1000));
    speed->add_flag("--json", options->json, "one JSON object on standard output");
#ifdef PALPA_TANGIBLE
    add_tangible_speed(*speed);
#endif
    speed->callback([options, speed] {
        if (speed->get_subcommands().empty()) run_speed(*options);
    });
}

}  // namespace palpa::app
