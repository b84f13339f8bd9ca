// palpa tactile identify: friction, weight and ripple of a force arm.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/command_line.h"
#include "app/commands/tactile_identified.h"
#include "app/commands/tactile_rig.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::app {
namespace {

struct IdentifyOptions {
    RigOptions rig;
    std::string output;
    bool json = false;
};

void print_fit(const tactile::CompensationFit& fit) {
    const tactile::ArmCompensation& c = fit.compensation;
    std::printf("friction   %.3f N Coulomb, %.3f N static below %.2f mm/s, %.3f N s/m viscous\n", c.coulomb_N,
                c.static_N, 1e3 * c.stribeck_m_per_s, c.viscous_N_s_per_m);
    std::printf("weight     %.3f N along the press\n", c.weight_N);
    std::printf("ripple     %.3f N every %.3f mm\n", c.ripple.amplitude_N, 1e3 * c.ripple.wavelength_m);
    std::printf("left over  %.3f N rms of %zu readings, %.1f to %.1f mm, %.1f to %.1f mm/s\n", fit.residual_N, fit.rows,
                1e3 * fit.lowest_m, 1e3 * fit.deepest_m, 1e3 * fit.slowest_m_per_s, 1e3 * fit.fastest_m_per_s);
}

void identify_arm(const IdentifyOptions& options) {
    files::check_output(options.output, {options.rig.device});
    const devices::ArmDevice device = rig_device(options.rig, {});
    RigResult result;
    const tactile::CompensationFit fit = identify(options.rig, device, result);
    tactile::write_compensation(fit, arm_name(device, options.rig), options.output);
    if (!options.json) {
        std::printf("%s\n", files::printable(arm_name(device, options.rig)).c_str());
        return print_fit(fit);
    }
    files::Json json = identified_json(fit);
    json["simulated"] = options.rig.simulate;
    json["link"] = link_json(result);
    std::fputs(files::json_text(json).c_str(), stdout);
}

}  // namespace

tactile::CompensationFit identify(const RigOptions& options, const devices::ArmDevice& device, RigResult& result) {
    constexpr double kOff_m = 5e-3;  // of the ends of the arm's range
    const auto path = tactile::slow_strokes(device.lowest_m + kOff_m, device.deepest_m - kOff_m);
    tactile::StrokeOptions stroke;
    stroke.limits = devices::limits_of(&device, nullptr, device.force_N);
    result = stroke_along(options, device, path, stroke, "identify");
    return tactile::fit_compensation(result.strokes.rows);
}

std::string arm_name(const devices::ArmDevice& device, const RigOptions& options) {
    return device.name + (options.simulate ? " (SIMULATED)" : "");
}

files::Json identified_json(const tactile::CompensationFit& fit) {
    files::Json json = tactile::parameters_json(fit.compensation);
    json["residual_N"] = fit.residual_N;
    json["readings"] = fit.rows;
    return json;
}

void add_tactile_identify(CLI::App& tactile) {
    auto options = std::make_shared<IdentifyOptions>();
    CLI::App* command = tactile.add_subcommand(
        "identify", "Find a force arm's friction, weight and ripple from slow strokes of a hand (docs/tactile.md)");
    add_rig_options(*command, options->rig);
    command->add_option("-o,--output", options->output, "compensation file to write; replaces a file of that name")
        ->required();
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { identify_arm(*options); });
}

}  // namespace palpa::app
