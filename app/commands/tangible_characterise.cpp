// palpa tangible characterise: the stiffness that a soft device really renders.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "app/commands/tangible_loop.h"
#include "app/scene_choices.h"
#include "figures/force_depth_figure.h"
#include "files/input_error.h"
#include "files/progress_line.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "session/plan_in_progress.h"
#include "tangible/characterise.h"
#include "tangible/tick_log.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;
using tangible::PlantOptions;
using tangible::PressFigures;
using tangible::TangiblePlan;

struct TangibleCharacteriseArguments {
    std::string device;
    std::vector<double> stiffness_N_per_mm;
    std::string scene;
    double depth_mm = 6.0;
    double speed_mm_per_s = 5.0;
    std::string plant = "exact";
    std::optional<double> modulus_factor, sensor_Hz, delay_ms, lag_ms;
    std::string command = "force";
    std::string fidelity = "step";
    double rate_Hz = 100.0;
    std::uint64_t seed = 1;
    std::string folder;
    bool json = false;
};

// A tissue that is pressed, kept with what its world points to.
struct PressedTissue {
    std::string label;
    std::string file;  // of its table, without ending
    std::unique_ptr<scene::Plan> of_scene;
    scene::Tissue curve;
    tangible::World world;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
};
using PressedTissues = std::vector<std::unique_ptr<PressedTissue>>;

PressedTissues tissues_of(const TangibleCharacteriseArguments& arguments) {
    PressedTissues out;
    if (!arguments.scene.empty()) {
        const scene::Scene scene = load_scene(arguments.scene);
        auto tissue = std::make_unique<PressedTissue>();
        tissue->label = scene.name;
        tissue->file = "press-scene";
        tissue->of_scene = std::make_unique<scene::Plan>(session::make_plan_here(scene));
        tissue->world = tangible::make_world(scene, *tissue->of_scene);
        tissue->place_m = tissue->of_scene->area.centre_m;
        if (scene.tangible && scene.tangible->at_m) tissue->place_m = *scene.tangible->at_m;
        out.push_back(std::move(tissue));
    }
    for (const double stiffness : arguments.stiffness_N_per_mm) {
        auto tissue = std::make_unique<PressedTissue>();
        tissue->label = files::short_number(stiffness) + " N/mm";
        tissue->file = "press-" + files::number_text(stiffness) + "-N-per-mm";
        scene::ForceCurveOptions options;
        options.curve.stiffness_N_per_m = 1e3 * stiffness;
        options.curve.greatest_depth_m = 2e-3 * arguments.depth_mm;
        tissue->curve = scene::ForceCurveTissue{options};
        tissue->world.tissue = &tissue->curve;
        out.push_back(std::move(tissue));
    }
    return out;
}

PlantOptions plant_of(const TangibleCharacteriseArguments& arguments, const tangible::DeviceFit& fit) {
    PlantOptions plant = tangible::of_fit(tangible::read_plant(arguments.plant), fit);
    if (plant.hand.mass_kg > 0.0)
        throw files::bad_input(arguments.plant, "hand", "a hand with mass", "none: here the finger follows a motion");
    plant.modulus_factor = arguments.modulus_factor.value_or(plant.modulus_factor);
    plant.sensor.rate_Hz = arguments.sensor_Hz.value_or(plant.sensor.rate_Hz);
    if (arguments.delay_ms) plant.sensor.delay_s = 1e-3 * *arguments.delay_ms;
    if (arguments.lag_ms) plant.lag_s = 1e-3 * *arguments.lag_ms;
    return plant;
}

struct Characterised {
    TangiblePlan plan;
    PressFigures figures;
};

Characterised press_on(const TangibleCharacteriseArguments& arguments,
                       const std::shared_ptr<const tangible::DeviceModel>& model, const PressedTissue& tissue,
                       const PlantOptions& plant) {
    tangible::LoopOptions loop;
    loop.rate_Hz = arguments.rate_Hz;
    loop.inverse.fidelity = tangible::fidelity_named(arguments.fidelity);
    loop.command = tangible::command_named(arguments.command);
    Characterised out{make_tangible_plan(model, tissue.world, tissue.place_m, loop), {}};
    files::ProgressLine line;
    out.figures = run_press(out.plan, make_plant(model, plant, loop),
                            {1e-3 * arguments.depth_mm, 1e-3 * arguments.speed_mm_per_s}, arguments.seed,
                            [&](double share) { line.show("pressing on " + tissue.label, share); });
    return out;
}

files::Json press_json(const PressedTissue& tissue, const PressFigures& figures) {
    return {{"tissue", tissue.label},
            {"wanted_N_per_mm", 1e-3 * figures.wanted_N_per_m},
            {"rendered_N_per_mm", 1e-3 * figures.rendered_N_per_m},
            {"force_rms_percent", figures.force_rms_percent},
            {"force_worst_percent", figures.force_worst_percent},
            {"hysteresis_N", figures.hysteresis_N},
            {"saturated_share", figures.saturated_share},
            {"rate_limited_share", figures.rate_limited_share},
            {"failed_ticks", figures.failed_ticks},
            {"failed_share", figures.failed_share}};
}

// What each difference of the plant costs alone: the rms error of the middle press with it and nothing else; 0 for a
// difference that the plant does not have.
files::Json contributions_json(const TangibleCharacteriseArguments& arguments,
                               const std::shared_ptr<const tangible::DeviceModel>& model, const PressedTissue& tissue,
                               const PlantOptions& plant) {
    const tangible::DeviceFit& fit = model->device.fit;
    const auto alone = [&](bool differs, const auto& take) {
        if (!differs) return 0.0;
        PlantOptions one = tangible::of_fit(tangible::read_plant("exact"), fit);
        take(one);
        return press_on(arguments, model, tissue, one).figures.force_rms_percent;
    };
    const bool noisy = plant.sensor.noise_m > 0.0 ||
                       (plant.sensor.rate_Hz > 0.0 && plant.sensor.rate_Hz < arguments.rate_Hz * (1.0 - 1e-9));
    files::Json json;
    json["model"] = alone(plant.modulus_factor != fit.modulus_factor,
                          [&](PlantOptions& one) { one.modulus_factor = plant.modulus_factor; });
    json["mesh"] = alone(!plant.device.empty(), [&](PlantOptions& one) { one.device = plant.device; });
    json["sensor"] = alone(noisy, [&](PlantOptions& one) {
        one.sensor = plant.sensor;
        one.sensor.delay_s = 0.0;
    });
    json["delay"] =
        alone(plant.sensor.delay_s > 0.0, [&](PlantOptions& one) { one.sensor.delay_s = plant.sensor.delay_s; });
    json["actuator"] =
        alone(plant.lag_s != fit.lag_s || plant.friction_share != fit.friction_share, [&](PlantOptions& one) {
            one.lag_s = plant.lag_s;
            one.friction_share = plant.friction_share;
        });
    return json;
}

// What the device can be made at the depth, with each tissue's own pretension, and whether that holds what was wanted.
struct ReachOfAll {
    tangible::Reach range{0.0, std::numeric_limits<double>::infinity(), 0.0};
    bool reachable = true;
};

void add_reach(const Characterised& pressed, double depth_m, ReachOfAll& all) {
    const tangible::Reach reach = reach_at(pressed.plan, depth_m);
    scene::TissueWork work = scene::make_work(*pressed.plan.world.tissue);
    const double wanted =
        tangible::world_force(pressed.plan.world, pressed.plan.place_m, depth_m, work).force_N / depth_m;
    all.reachable = all.reachable && wanted >= reach.lowest_N_per_m && wanted <= reach.highest_N_per_m;
    all.range.depth_m = depth_m;
    all.range.lowest_N_per_m = std::min(all.range.lowest_N_per_m, reach.lowest_N_per_m);
    all.range.highest_N_per_m = std::max(all.range.highest_N_per_m, reach.highest_N_per_m);
}

files::Json reach_json(const ReachOfAll& all) {
    return {{"depth_mm", 1e3 * all.range.depth_m},
            {"stiffness_N_per_mm", {1e-3 * all.range.lowest_N_per_m, 1e-3 * all.range.highest_N_per_m}},
            {"reachable", all.reachable}};
}

void write_press_table(const TangiblePlan& plan, const PressFigures& figures, const fs::path& file) {
    std::string text = tick_columns(*plan.model);
    for (const tangible::PressTick& tick : figures.ticks)
        append_tick(*plan.model, plan.loop.command, tick.command, tick.depth_m, tick.wanted_N, tick.rendered_N, text);
    files::write_text_atomically(file, text);
}

void print_press(const files::Json& press) {
    constexpr double kMostly = 0.5;
    const double failed_share = press["failed_share"].get<double>();
    // what is felt of a device that rests is no stiffness that it renders
    const char* found =
        failed_share > kMostly ? "NOT RENDERED, the figures are of a device that mostly rested: " : "rendered ";
    std::printf(
        "  %s: %s%.4g N/mm of %.4g, force off by %.3g %% rms (%.3g %% at worst), hysteresis %.3g N, "
        "saturated in %.3g %% of the ticks, as fast as the drives go in %.3g %%, relaxed, held or without equilibrium "
        "in %.3g %%\n",
        press["tissue"].get<std::string>().c_str(), found, press["rendered_N_per_mm"].get<double>(),
        press["wanted_N_per_mm"].get<double>(), press["force_rms_percent"].get<double>(),
        press["force_worst_percent"].get<double>(), press["hysteresis_N"].get<double>(),
        100.0 * press["saturated_share"].get<double>(), 100.0 * press["rate_limited_share"].get<double>(),
        100.0 * failed_share);
}

void print_characterised(const files::Json& json) {
    std::printf("%s, plant %s\n", json["device"].get<std::string>().c_str(), json["plant"].get<std::string>().c_str());
    for (const auto& press : json["presses"]) print_press(press);
    const auto& range = json["reach"]["stiffness_N_per_mm"];
    std::printf(
        "  at %.3g mm the device, at the pretension for these tissues, can be made between %.3g and %.3g N/mm "
        "stiff%s\n",
        json["reach"]["depth_mm"].get<double>(), range[0].get<double>(), range[1].get<double>(),
        json["reach"]["reachable"].get<bool>() ? "" : ": NOT all that was wanted is reachable");
    for (const auto& [name, percent] : json["contributions_percent"].items()) {
        if (percent.get<double>() > 0.0) std::printf("  %s alone: %.3g %% rms\n", name.c_str(), percent.get<double>());
    }
    for (const auto& note : json["notes"]) std::printf("  note: %s\n", note.get<std::string>().c_str());
}

void draw_presses(const TangibleCharacteriseArguments& arguments, const PressedTissues& tissues,
                  const std::vector<PressFigures>& presses) {
    std::vector<figures::ForceDepthPanel> panels;
    for (std::size_t i = 0; i < tissues.size(); ++i)
        panels.push_back(
            {tissues[i]->label + ", off by " + files::short_number(presses[i].force_rms_percent) + " % rms",
             tissues[i]->file + ".tsv"});
    const std::string trouble = figures::draw_force_depth(panels, arguments.folder);
    if (!trouble.empty()) std::fprintf(stderr, "palpa: %s\n", trouble.c_str());
}

void characterise(const TangibleCharacteriseArguments& arguments) {
    if (arguments.stiffness_N_per_mm.empty() && arguments.scene.empty())
        throw files::InputError(
            "found neither --stiffness-N-per-mm nor --scene, expected at "
            "least one of them");
    if (!arguments.folder.empty()) {
        files::check_output_folder(arguments.folder);
        files::check_new(fs::path(arguments.folder) /
                         "characterise.json");  // tables of two runs would stand side by side
    }
    const auto model = std::make_shared<const tangible::DeviceModel>(
        make_device_model(tangible::read_soft_device(device_file(arguments.device))));
    check_depth("--depth-mm", "", 1e-3 * arguments.depth_mm, *model);
    const PlantOptions plant = plant_of(arguments, model->device.fit);
    const PressedTissues tissues = tissues_of(arguments);
    if (!arguments.folder.empty()) fs::create_directories(arguments.folder);
    files::Json json{{"device", model->device.name},
                     {"plant", plant.name},
                     {"fidelity", arguments.fidelity},
                     {"command", arguments.command},
                     {"seed", arguments.seed}};
    json["presses"] = files::Json::array();
    std::vector<PressFigures> presses;
    files::Json notes = files::Json::array();
    ReachOfAll reach;
    for (const auto& tissue : tissues) {
        Characterised pressed = press_on(arguments, model, *tissue, plant);
        json["presses"].push_back(press_json(*tissue, pressed.figures));
        add_reach(pressed, 1e-3 * arguments.depth_mm, reach);
        for (const std::string& note : pressed.plan.notes) notes.push_back(tissue->label + ": " + note);
        if (!arguments.folder.empty())
            write_press_table(pressed.plan, pressed.figures, fs::path(arguments.folder) / (tissue->file + ".tsv"));
        presses.push_back(std::move(pressed.figures));
    }
    json["contributions_percent"] = contributions_json(arguments, model, *tissues[tissues.size() / 2], plant);
    json["reach"] = reach_json(reach);
    json["notes"] = notes;
    if (!arguments.folder.empty()) {
        files::write_text_atomically(fs::path(arguments.folder) / "characterise.json", files::json_text(json));
        draw_presses(arguments, tissues, presses);
    }
    if (arguments.json)
        std::fputs(files::json_text(json).c_str(), stdout);
    else
        print_characterised(json);
}

}  // namespace

void add_tangible_characterise(CLI::App& tangible) {
    auto arguments = std::make_shared<TangibleCharacteriseArguments>();
    CLI::App* command = tangible.add_subcommand(
        "characterise", "Press a device, or a model in its place, and compare what it renders with what was wanted");
    command->add_option("DEVICE", arguments->device, "device file, or the name of one among the assets")->required();
    command->add_option("--stiffness-N-per-mm", arguments->stiffness_N_per_mm, "wanted stiffnesses K,...")
        ->delimiter(',')
        ->check(CLI::Range(1e-4, 1e3));
    command->add_option("--scene", arguments->scene, "a scene whose tissue is wanted");
    command->add_option("--depth-mm", arguments->depth_mm, "of the presses (default 6), at most the device's size")
        ->check(CLI::Range(0.1, 100.0));
    command->add_option("--speed-mm-per-s", arguments->speed_mm_per_s, "mean speed there and back (default 5)")
        ->check(CLI::Range(0.1, 1000.0));
    command->add_option("--plant", arguments->plant, "exact (default), or a plant file");
    command
        ->add_option("--modulus-factor", arguments->modulus_factor, "the plant's moduli over those of the device file")
        ->check(CLI::Range(0.1, 10.0));
    command->add_option("--sensor-Hz", arguments->sensor_Hz, "rate of the displacement sensor (default: every tick)")
        ->check(CLI::Range(1.0, 1e5));
    command->add_option("--delay-ms", arguments->delay_ms, "of the sensor")->check(CLI::Range(0.0, 500.0));
    command->add_option("--lag-ms", arguments->lag_ms, "of the drives, first order")->check(CLI::Range(0.0, 1e4));
    command->add_option("--seed", arguments->seed, "of the sensor's noise (default 1)");
    add_loop_options(*command, false, arguments->fidelity, arguments->command, arguments->rate_Hz);
    command->add_option("-o,--output", arguments->folder,
                        "folder for tables (which palpa tangible fit reads) and a figure");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { characterise(*arguments); });
}

}  // namespace palpa::app
