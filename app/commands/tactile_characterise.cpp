// palpa tactile characterise: the stiffness that a force arm really renders.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "app/commands/command_line.h"
#include "app/commands/tactile_identified.h"
#include "app/scene_choices.h"
#include "figures/stiffness_figure.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "session/plan_in_progress.h"
#include "tactile/characterise.h"
#include "tactile/plan.h"

namespace palpa::app {
namespace {

constexpr double kCurved = 0.02;  // from here on the line wanted is told from the stiffness asked for

struct CharacteriseOptions {
    RigOptions rig;
    std::string scene;
    std::vector<double> stiffness_N_per_mm{0.25, 0.33, 0.5, 1.0};
    double depth_mm = 10.0;
    bool depth_asked = false;
    int cycles = 3;
    double cycle_s = 4.0;
    double force_limit_N = 15.0;
    std::string compensation;  // a file, "off", or empty: identified first
    std::string folder;
    bool json = false;
};

// What the arm renders: the scene's tissue, pressed in its middle by the scene's finger.
struct CharacterisedTissue {
    scene::Scene scene;
    std::shared_ptr<const scene::Plan> plan;
    double stiffness_N_per_m = 0.0;  // in the middle, as the scene has it
};

CharacterisedTissue tissue_of(const CharacteriseOptions& options, const scene::Scene& scene) {
    CharacterisedTissue tissue;
    tissue.scene = scene;
    scene::TactileOptions asked = tissue.scene.tactile.value_or(scene::TactileOptions{});
    if (asked.arm && asked.arm->impedance == scene::ArmImpedance::high)
        throw files::bad_input(options.scene, "tactile.arm.impedance", "high",
                               "low: what a high-impedance arm renders is a depth");
    asked.arm = scene::ArmOptions{};  // the rig is the arm here
    asked.display.reset();
    asked.table.reset();
    asked.force_limit_N = options.force_limit_N;
    tissue.scene.tactile = asked;
    tissue.plan = std::make_shared<const scene::Plan>(session::make_plan_here(tissue.scene));
    tissue.stiffness_N_per_m = tactile::make_tactile_plan(tissue.scene, *tissue.plan).stiffness_N_per_m;
    if (!(tissue.stiffness_N_per_m > 0.0))
        throw files::bad_input(options.scene, "tissue", "a tissue that does not yield in its middle", "one that does");
    return tissue;
}

// The tissue made so stiff that its stiffness in the middle is the wanted one.
std::function<double(double)> law_of(double wanted_N_per_m, CharacterisedTissue tissue) {
    tissue.scene.stiffness_scale *= wanted_N_per_m / tissue.stiffness_N_per_m;
    struct Pressed {
        CharacterisedTissue tissue;
        tactile::TactilePlan plan;
        tactile::RendererWork work;
    };
    tactile::TactilePlan plan = tactile::make_tactile_plan(tissue.scene, *tissue.plan);
    tactile::RendererWork work = tactile::make_work(plan.renderer);
    auto pressed = std::make_shared<Pressed>(Pressed{std::move(tissue), std::move(plan), std::move(work)});
    return [pressed](double depth_m) {
        return tactile::press_to_depth(pressed->plan.renderer, pressed->tissue.plan->area.centre_m, depth_m,
                                       pressed->work)
            .force_N;
    };
}

// Beyond the depth that the tissue is known for its force holds, too. Presses go as deep as that at most; one that was asked to go
// deeper is refused.
void limit_depth(const CharacterisedTissue& tissue, CharacteriseOptions& options) {
    // so soft that no force limit holds it
    const auto law = law_of(0.05 * options.force_limit_N / (1e-3 * options.depth_mm), tissue);
    double depth_m = 1e-3 * options.depth_mm;
    while (law(0.99 * depth_m) > 0.9999 * law(depth_m)) depth_m *= 0.99;
    if (depth_m < 1e-3 * options.depth_mm && options.depth_asked)
        throw files::bad_input("--depth-mm", "", files::short_number(options.depth_mm),
                               "at most " + files::short_number(1e3 * depth_m) + ", as deep as the tissue is known");
    options.depth_mm = 1e3 * depth_m;
}

// Above the limit the force holds, and a line through it is no stiffness that the arm renders.
void check_force(const CharacteriseOptions& options, const CharacterisedTissue& tissue,
                 const devices::ArmDevice& device) {
    const double limit_N = devices::limits_of(&device, nullptr, options.force_limit_N).force_N;
    for (const double stiffness : options.stiffness_N_per_mm) {
        const auto law = law_of(1e3 * stiffness, tissue);
        const auto held = [&](double depth_mm) { return !(law(1e-3 * depth_mm) < 0.999 * limit_N); };
        if (!held(options.depth_mm)) continue;
        double free_mm = 0.0;  // the tissue need not be straight: where its own curve meets the limit
        for (double step_mm = 0.5 * options.depth_mm; step_mm > 1e-3 * options.depth_mm; step_mm *= 0.5)
            if (!held(free_mm + step_mm)) free_mm += step_mm;
        throw files::bad_input(
            "--stiffness-N-per-mm", "",
            files::short_number(stiffness) + " at a depth of " + files::short_number(options.depth_mm) +
                " mm, where the force limit of " + files::short_number(limit_N) + " N holds the force",
            "a softer tissue, " + std::string(limit_N < options.force_limit_N ? "" : "a greater --force-limit-N, ") +
                "or a --depth-mm of at most " + files::short_number(0.999 * free_mm));  // rounded, it is taken, too
    }
}

std::optional<tactile::ArmCompensation> compensation_for(const CharacteriseOptions& options,
                                                         const devices::ArmDevice& device, files::Json& json) {
    if (options.compensation == "off") {
        json["compensation"] = "off";
        return std::nullopt;
    }
    if (!options.compensation.empty()) {
        json["compensation"] = options.compensation;
        return tactile::read_compensation(options.compensation);
    }
    RigResult result;
    const tactile::CompensationFit fit = identify(options.rig, device, result);
    json["compensation"] = identified_json(fit);
    if (!options.folder.empty())
        tactile::write_compensation(fit, arm_name(device, options.rig),
                                    std::filesystem::path(options.folder) / "compensation.json");
    return fit.compensation;
}

// The hand of the simulator gives way, so it has to aim deeper.
std::vector<devices::PressRow> path_of(const CharacteriseOptions& options, double stiffness_N_per_m) {
    const double depth_m = 1e-3 * options.depth_mm;
    const double hand_N_per_m = devices::simulators::ArmPlantParameters{}.hand_N_per_m;
    const double aimed_m =
        options.rig.simulate ? tactile::hand_depth_m(depth_m, stiffness_N_per_m, hand_N_per_m) : depth_m;
    return tactile::cycles(aimed_m, options.cycles, options.cycle_s);
}

std::string table_name(double stiffness_N_per_m) {
    return "stiffness-" + files::number_text(stiffness_N_per_m / 1e3) + "-N-per-mm.tsv";
}

void write_table(const tactile::StiffnessRun& run, const std::filesystem::path& folder) {
    std::string text = "depth_mm\tforce_N\ttime_s\tvelocity_mm_per_s\tmotor_N\n";
    for (const tactile::StrokeRow& row : run.rows) {
        for (const double value : {1e3 * row.depth_m, row.sensor_N, row.time_s, 1e3 * row.velocity_m_per_s}) {
            files::append_number(value, text);
            text.push_back('\t');
        }
        files::append_number(row.motor_N, text);
        text.push_back('\n');
    }
    files::write_text_whole(folder / table_name(run.asked_N_per_m), text);
}

files::Json run_json(const tactile::StiffnessRun& run, const RigResult& result) {
    return {{"asked_N_per_mm", 1e-3 * run.asked_N_per_m},
            {"wanted_N_per_mm", 1e-3 * run.wanted_N_per_m},
            {"rendered_N_per_mm", 1e-3 * run.rendered_N_per_m},
            {"error_percent", 100.0 * run.error_share},
            {"hysteresis_N", run.hysteresis_N},
            {"force_rms_N", run.force_rms_N},
            {"loop_delay_ms", 1e3 * result.loop_delay_s},
            {"link", link_json(result)}};
}

void write_results(const std::vector<tactile::StiffnessRun>& runs, const CharacteriseOptions& options,
                   const files::Json& json) {
    const std::filesystem::path folder = options.folder;
    std::vector<figures::StiffnessPanel> panels;
    for (const tactile::StiffnessRun& run : runs) {
        write_table(run, folder);
        panels.push_back({1e-3 * run.wanted_N_per_m, 1e-3 * run.rendered_N_per_m, run.hysteresis_N, run.force_at_0_N,
                          table_name(run.asked_N_per_m)});
    }
    files::write_text_atomically(folder / "characterise.json", files::json_text(json));
    const std::string warning = figures::draw_stiffness(panels, options.rig.simulate, folder);
    if (!warning.empty()) std::fprintf(stderr, "palpa: warning: %s\n", files::printable(warning).c_str());
}

void print_runs(const std::vector<tactile::StiffnessRun>& runs, const files::Json& json) {
    std::printf("wanted   rendered   error    hysteresis  off the wanted force (rms)\n");
    for (const tactile::StiffnessRun& run : runs) {
        std::printf("%.3g N/mm  %.4f N/mm  %+5.1f %%  +-%.3f N  %.3f N\n", 1e-3 * run.wanted_N_per_m,
                    1e-3 * run.rendered_N_per_m, 100.0 * run.error_share, run.hysteresis_N, run.force_rms_N);
    }
    const bool curved = std::any_of(runs.begin(), runs.end(), [](const tactile::StiffnessRun& run) {
        return std::abs(run.wanted_N_per_m / run.asked_N_per_m - 1.0) > kCurved;
    });
    if (curved) std::printf("wanted: the same line through the tissue's own force, which is not straight\n");
    std::printf("the line is of the middle nine tenths of the depth at the usual speed, the rms of all readings\n");
    std::printf("mean error %.2f %%, worst hysteresis +-%.3f N%s\n", json["mean_error_percent"].get<double>(),
                json["worst_hysteresis_N"].get<double>(),
                json["simulated"].get<bool>() ? " (SIMULATED arm and hand)" : "");
}

void check_characterise(const CharacteriseOptions& options) {
    for (const double stiffness : options.stiffness_N_per_mm) {
        if (stiffness < 0.01 || stiffness > 10.0)
            throw files::bad_input("--stiffness-N-per-mm", "", files::short_number(stiffness), "from 0.01 to 10");
    }
    std::vector<double> sorted = options.stiffness_N_per_mm;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())  // both would go to one table
        throw files::bad_input("--stiffness-N-per-mm", "", files::short_number(*twice) + " twice", "each number once");
    if (options.folder.empty()) return;
    files::check_output_folder(options.folder);
    // tables of two runs would stand side by side
    files::check_new(std::filesystem::path(options.folder) / "characterise.json");
    if (options.compensation.empty()) files::check_new(std::filesystem::path(options.folder) / "compensation.json");
    for (const double stiffness : options.stiffness_N_per_mm)
        files::check_new(std::filesystem::path(options.folder) / table_name(1e3 * stiffness));
}

// One stiffness: strokes, line, and its entry in the report.
tactile::StiffnessRun characterise_one(double asked_N_per_m, const CharacteriseOptions& options,
                                       const CharacterisedTissue& tissue, const devices::ArmDevice& device,
                                       const std::optional<tactile::ArmCompensation>& compensation, files::Json& json) {
    tactile::StrokeOptions stroke;
    stroke.law = law_of(asked_N_per_m, tissue);
    stroke.compensation = compensation;
    stroke.limits = devices::limits_of(&device, nullptr, options.force_limit_N);
    RigResult result = stroke_along(options.rig, device, path_of(options, asked_N_per_m), stroke,
                                    files::short_number(1e-3 * asked_N_per_m) + " N/mm");
    if (const std::string warning = devices::delay_warning(asked_N_per_m, result.loop_delay_s); !warning.empty()) {
        json["warnings"].push_back(warning);
        std::fprintf(stderr, "palpa: warning: %s\n", warning.c_str());
    }
    tactile::StiffnessRun run = tactile::stiffness_of(stroke.law, std::move(result.strokes.rows));
    run.asked_N_per_m = asked_N_per_m;
    json["runs"].push_back(run_json(run, result));
    return run;
}

void characterise(CharacteriseOptions options) {
    check_characterise(options);
    const scene::Scene scene = load_scene(options.scene);
    const bool has_arm = scene.tactile && scene.tactile->arm;
    const devices::ArmDevice device =
        rig_device(options.rig, has_arm ? scene.tactile->arm->device : std::filesystem::path());
    const CharacterisedTissue tissue = tissue_of(options, scene);
    limit_depth(tissue, options);
    check_force(options, tissue, device);
    if (!options.folder.empty()) std::filesystem::create_directories(options.folder);
    files::Json json{{"scene", options.scene}, {"simulated", options.rig.simulate}, {"depth_mm", options.depth_mm}};
    if (options.rig.simulate) json["seed"] = options.rig.seed;
    const auto compensation = compensation_for(options, device, json);
    json["runs"] = files::Json::array();
    json["warnings"] = files::Json::array();
    std::vector<tactile::StiffnessRun> runs;
    double error_sum = 0.0, worst_N = 0.0;
    for (const double stiffness : options.stiffness_N_per_mm) {
        runs.push_back(characterise_one(1e3 * stiffness, options, tissue, device, compensation, json));
        error_sum += std::abs(runs.back().error_share);
        worst_N = std::max(worst_N, runs.back().hysteresis_N);
    }
    json["mean_error_percent"] = 100.0 * error_sum / static_cast<double>(runs.size());
    json["worst_hysteresis_N"] = worst_N;
    if (!options.folder.empty()) write_results(runs, options, json);
    if (options.json) {
        std::fputs(files::json_text(json).c_str(), stdout);
    } else {
        print_runs(runs, json);
    }
}

}  // namespace

void add_tactile_characterise(CLI::App& tactile) {
    auto options = std::make_shared<CharacteriseOptions>();
    CLI::App* command = tactile.add_subcommand(
        "characterise", "Measure the stiffness that a force arm really renders (docs/tactile.md)");
    command->add_option("SCENE", options->scene, "scene JSON whose tissue is rendered, or the name of a shipped one")
        ->required();
    add_rig_options(*command, options->rig);
    command->add_option("--stiffness-N-per-mm", options->stiffness_N_per_mm, "to render, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    command
        ->add_option("--depth-mm", options->depth_mm,
                     "of each press (default: 10, or less where the tissue is known no deeper)")
        ->check(CLI::Range(1.0, 40.0));
    command->add_option("--cycles", options->cycles, "presses for each stiffness")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_option("--cycle-s", options->cycle_s, "how long a press takes, down and up")
        ->check(CLI::Range(0.5, 60.0))
        ->capture_default_str();
    command->add_option("--force-limit-N", options->force_limit_N, "greatest force")
        ->check(CLI::Range(0.1, 100.0))
        ->capture_default_str();
    command->add_option("--compensation", options->compensation,
                        "compensation file, or \"off\" (default: it is identified first)");
    command->add_option(
        "-o,--output", options->folder,
        "folder for tables, figure and the compensation file (these are never overwritten, but for the figure)");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options, command] {
        options->depth_asked = command->count("--depth-mm") > 0;
        characterise(*options);
    });
}

}  // namespace palpa::app
