// palpa tangible info: what a device file describes, and what is wrong with it.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/command_line.h"
#include "app/commands/tangible_loop.h"
#include "files/printable.h"
#include "files/text.h"
#include "tangible/device_checks.h"

namespace palpa::app {
namespace {

struct TangibleInfoOptions {
    std::string device;
    bool json = false;
};

files::Json actuators_json(const tangible::SoftDevice& device) {
    files::Json out = files::Json::array();
    for (std::size_t j = 0; j < device.actuators.size(); ++j) {
        const tangible::SoftActuator& actuator = device.actuators[j];
        files::Json tie = nullptr;
        for (const tangible::SoftTie& ties : device.ties) {
            if (std::find(ties.actuators.begin(), ties.actuators.end(), static_cast<int>(j)) == ties.actuators.end())
                continue;
            tie = tangible::describe(device, ties);
        }
        out.push_back({{"name", actuator.name},
                       {"kind", name_of(actuator.kind)},
                       {"unit", unit_of(actuator.kind)},
                       {"lower", actuator.lower},
                       {"upper", actuator.upper},
                       {"tie", tie}});
    }
    return out;
}

void print_info(const files::Json& json, const tangible::SoftDevice& device) {
    std::printf("%s: %ld nodes, %ld %s cells, %d equations of half-bandwidth %d\n",
                files::printable(device.name).c_str(), json["nodes"].get<long>(), json["elements"].get<long>(),
                json["element"].get<std::string>().c_str(), json["dofs"].get<int>(), json["band"].get<int>());
    for (const auto& actuator : json["actuators"]) {
        const auto text = [&](const char* key) { return files::printable(actuator[key].get<std::string>()); };
        std::printf("  %-8s %-10s %s to %s %s%s\n", text("kind").c_str(), text("name").c_str(),
                    files::short_number(actuator["lower"].get<double>()).c_str(),
                    files::short_number(actuator["upper"].get<double>()).c_str(), text("unit").c_str(),
                    actuator["tie"].is_null() ? "" : (", " + text("tie")).c_str());
    }
    std::printf("weight %s N%s; laws: %s\n", files::short_number(json["weight_N"].get<double>()).c_str(),
                device.gravity_m_per_s2 ? "" : " (not simulated: no gravity_m_per_s2)",
                json["laws"].get<std::string>().c_str());
    const tangible::DeviceFit& fit = device.fit;
    if (json["fit"] != fit_json({}))
        std::printf("fit: modulus %s of the file's, friction %s %% of a cable's tension, zero at %s mm, lag %s ms\n",
                    files::short_number(fit.modulus_factor).c_str(),
                    files::short_number(100.0 * fit.friction_share).c_str(),
                    files::short_number(1e3 * fit.zero_m).c_str(), files::short_number(1e3 * fit.lag_s).c_str());
    for (const auto& warning : json["warnings"])
        std::printf("warning: %s\n", files::printable(warning.get<std::string>()).c_str());
}

void run_info(const TangibleInfoOptions& options) {
    const tangible::SoftDevice device = tangible::read_soft_device(device_file(options.device));
    const tangible::DeviceModel model = tangible::make_device_model(device);
    std::string laws;
    for (const mechanics::Law law : device.body.laws)
        laws += (laws.empty() ? "" : ", ") + std::string(mechanics::name_of(law));
    files::Json json{{"name", device.name},
                     {"nodes", device.body.body.mesh.nodes_m.cols()},
                     {"elements", device.body.body.mesh.cells.cols()},
                     {"dofs", model.equations()},
                     {"band", model.band},
                     {"element", std::string(mechanics::name_of(device.body.element))},
                     {"laws", laws},
                     {"actuators", actuators_json(device)},
                     {"weight_N", tangible::weight_N(model)},
                     {"fit", fit_json(device.fit)},
                     {"warnings", tangible::device_warnings(model)}};
    if (options.json)
        std::fputs(files::json_text(json).c_str(), stdout);
    else
        print_info(json, device);
}

}  // namespace

void add_tangible_info(CLI::App& tangible) {
    auto options = std::make_shared<TangibleInfoOptions>();
    CLI::App* info = tangible.add_subcommand("info", "What a device file describes, and what to beware of");
    info->add_option("DEVICE", options->device, "device file, or the name of one among the assets")->required();
    info->add_flag("--json", options->json, "one JSON object on standard output");
    info->callback([options] { run_info(*options); });
}

}  // namespace palpa::app
