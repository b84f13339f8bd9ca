// palpa tangible fit: what recorded presses say about a device.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/command_line.h"
#include "app/commands/tangible_loop.h"
#include "files/input_error.h"
#include "files/progress_line.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "tangible/fit.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

struct TangibleFitArguments {
    std::string device;
    std::string presses;
    std::string output;
    bool lag = false;
    bool json = false;
};

// The mesh file that the device file names; empty if it names none.
fs::path mesh_file(const TangibleFitArguments& arguments) {
    const fs::path device = fs::absolute(device_file(arguments.device));
    const files::Json json = files::read_json(device);
    const bool names = json.is_object() && json.contains("mesh") && json["mesh"].is_object() &&
                       json["mesh"].contains("file") && json["mesh"]["file"].is_string();
    return names ? device.parent_path() / json["mesh"]["file"].get<std::string>() : fs::path();
}

// The device file with what was fitted; a mesh file is named as seen from the new place.
files::Json fitted_device(const TangibleFitArguments& arguments, const tangible::DeviceFit& fit) {
    files::Json json = files::read_json(device_file(arguments.device));
    if (const fs::path mesh = mesh_file(arguments); !mesh.empty())
        json["mesh"]["file"] = fs::proximate(mesh, fs::absolute(fs::path(arguments.output)).parent_path()).string();
    json["fit"] = fit_json(fit);
    return json;
}

tangible::FitResult fitted(const TangibleFitArguments& arguments, const tangible::SoftDevice& device,
                           const std::vector<tangible::RecordedTick>& ticks) {
    files::ProgressLine line;
    tangible::FitOptions options;
    options.lag = arguments.lag;
    options.progress = [&](double share) { line.show("fitting " + device.name, share); };
    try {
        return tangible::fit_presses(device, ticks, options);
    } catch (const std::runtime_error& error) {
        throw files::InputError(arguments.presses + ": " + error.what());
    }
}

void fit_tangible(const TangibleFitArguments& arguments) {
    files::check_output(arguments.output, {device_file(arguments.device), arguments.presses, mesh_file(arguments)});
    const tangible::SoftDevice device = tangible::read_soft_device(device_file(arguments.device));
    const auto ticks = tangible::read_presses(arguments.presses, tangible::make_device_model(device));
    const tangible::FitResult result = fitted(arguments, device, ticks);
    if (!result.settled) {
        throw std::runtime_error(arguments.presses + ": the fit did not settle, and nothing was written" +
                                 (arguments.lag ? "" : " (do the drives lag? --lag)"));
    }
    files::write_text_atomically(arguments.output, files::json_text(fitted_device(arguments, result.fit)));
    files::Json json = fit_json(result.fit);
    json["lag_error_ms"] = result.lag_error_s ? files::Json(1e3 * *result.lag_error_s) : files::Json(nullptr);
    json.update({{"rms_before_N", result.rms_before_N},
                 {"rms_after_N", result.rms_after_N},
                 {"ticks", result.ticks},
                 {"rounds", result.rounds},
                 {"settled", result.settled}});
    if (arguments.json) {
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    std::printf("%s: modulus %.4g of the file's, friction %.3g %% of a cable's tension, zero at %.3g mm\n",
                arguments.output.c_str(), result.fit.modulus_factor, 100.0 * result.fit.friction_share,
                1e3 * result.fit.zero_m);
    if (arguments.lag && result.lag_error_s)
        std::printf("  drives lag by %.3g ms (standard error %.2g)\n", 1e3 * result.fit.lag_s,
                    1e3 * *result.lag_error_s);
    if (arguments.lag && !result.lag_error_s)
        std::printf("  no lag of the drives is seen in this press, which does not say that there is none\n");
    std::printf("  recorded minus modelled force: %.3g N before, %.3g N after (rms of %d rows)\n", result.rms_before_N,
                result.rms_after_N, result.ticks);
}

}  // namespace

void add_tangible_fit(CLI::App& tangible) {
    auto arguments = std::make_shared<TangibleFitArguments>();
    CLI::App* command = tangible.add_subcommand(
        "fit", "Find a device's modulus, friction and zero from recorded presses, and write a device file with them");
    command->add_option("DEVICE", arguments->device, "device file, or the name of one among the assets")->required();
    command
        ->add_option(
            "PRESSES", arguments->presses,
            "table with time_s, depth_mm, force_N and each actuator's NAME_N or NAME_Pa, as characterise -o writes")
        ->required();
    command->add_option("-o,--output", arguments->output, "device file NEW.json to write; replaces a file of that name")
        ->required();
    command->add_flag(
        "--lag", arguments->lag,
        "also how far the drives lag: from a press of a tissue that stiffens, with a sensor that is not late");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { fit_tangible(*arguments); });
}

}  // namespace palpa::app
