// tangible_plant: a soft device in the place of the real one, on pseudo-terminals and UDP that speak the protocols of its
// wires. Its finite elements may differ from those of the loop's model (a plant file). Converged answers are tabulated first,
// so that it answers in time; it says on standard error how far that is. Then it prints "port NAME=PATH ...", and at its end
// how it was driven. To unplug it closes the terminals; plugged in again, new ones stand behind the same --links.

#include <CLI/CLI.hpp>
#include <cinttypes>

#include "devices/simulators/rig_wires.h"
#include "devices/simulators/stream.h"
#include "devices/simulators/truth_file.h"
#include "files/input_error.h"
#include "files/text.h"
#include "platform/real_time.h"
#include "tangible/plant/plant_body.h"

using namespace palpa;
using namespace palpa::tangible;
using devices::simulators::RigWires;
using devices::simulators::TruthFile;

namespace {

struct PlantArguments {
    std::string device;
    std::string plant = "exact";
    std::string truth;
    double depth_mm = 6.0;
    double speed_mm_per_s = 5.0;
    FingerMotion motion;
    TableSize size;
    devices::simulators::WiresOptions wires;
};

void add_options(CLI::App& app, PlantArguments& out) {
    app.add_option("DEVICE", out.device, "device file")->required();
    app.add_option("--plant", out.plant, "exact: the device as its file has it; or a plant file")
        ->capture_default_str();
    app.add_option("--truth", out.truth, "table of the finger's depth and force and of the drives, every 2 ms");
    app.add_option("--depth-mm", out.depth_mm, "of each press")->check(CLI::Range(0.1, 100.0))->capture_default_str();
    app.add_option("--speed-mm-per-s", out.speed_mm_per_s, "greatest one")
        ->check(CLI::Range(0.1, 1e3))
        ->capture_default_str();
    app.add_option("--pause-s", out.motion.pause_s, "between presses")
        ->check(CLI::Range(0.0, 1e3))
        ->capture_default_str();
    app.add_option("--hand-N", out.motion.hand_N, "greatest force of the plant's hand, if it has one");
    app.add_option("--nodes", out.size.actuation, "of the table, on the axis of a single drive")
        ->check(CLI::Range(4, 100))
        ->capture_default_str();
    devices::simulators::add_wires_options(app, out.wires);
}

PlantTable tabulated(const DeviceModel& model, const TableSize& size) {
    std::fprintf(stderr, "tabulating the device's answers ...\n");
    double shown = 0.0;
    PlantTable table = make_plant_table(model, size, [&](double share) {
        if (share < shown + 0.1) return;
        shown = share;
        std::fprintf(stderr, "%3.0f %%\n", 100.0 * share);
    });
    if (table.missing > 0)
        std::fprintf(stderr, "%d of %zu places have no equilibrium; there the force stays what it was before\n",
                     table.missing, table.force_N.size());
    return table;
}

PlantBody body_of(const PlantArguments& arguments, const devices::ActuatorRig& rig, Plant plant,
                  const PlantTable& table) {
    PlantBody body;
    body.table = &table;
    body.plant = std::move(plant);
    body.motion = arguments.motion;
    body.drive.by_length =
        std::any_of(rig.channels.begin(), rig.channels.end(),
                    [](const devices::RigChannel& channel) { return channel.drive == devices::Drive::length; });
    body.sensor.random = arguments.wires.seed;
    return body;
}

std::string head_of(const devices::ActuatorRig& rig) {
    std::string head = "t_host_s\tdepth_mm\tforce_N";
    for (const devices::RigChannel& channel : rig.channels) head += '\t' + channel.name;
    return head + "\trelaxed\n";
}

std::string row_of(const devices::ActuatorRig& rig, const RigWires& wires, const PlantBody& body, bool relaxed) {
    std::string row = files::number_text(devices::steady_s()) + '\t' + files::number_text(1e3 * body.finger_m) + '\t' +
                      files::number_text(body.force_N);
    for (std::size_t i = 0; i < rig.channels.size(); ++i) row += '\t' + files::number_text(wires.value(i));
    return row + (relaxed ? "\t1\n" : "\t0\n");
}

void run(const devices::ActuatorRig& rig, RigWires& wires, PlantBody& body, TruthFile& truth) {
    constexpr double kTick_s = 1e-3, kTruth_s = 2e-3;
    for (double truth_s = 0.0; devices::simulators::ended == 0;) {
        wires.run();
        Actuation drives{};
        bool relaxed = true;
        for (std::size_t i = 0; i < rig.channels.size(); ++i) {
            drives[i] = wires.value(i);
            relaxed = relaxed && wires.relaxed(i);
        }
        // A device whose first wanted force is none is driven at rest: then the line has been busy for longer than the
        // guard's proofs take.
        constexpr double kProved_s = 6.0;
        const bool driven = !relaxed || wires.talking_s() > kProved_s;
        while (wires.elapsed_s() - body.time_s >= 0.5 * kTick_s) step_body(kTick_s, drives, driven, body);
        wires.show_displacement(displacement_m(body));
        if (!truth.wanted() || wires.elapsed_s() < truth_s) continue;
        truth.add(row_of(rig, wires, body, relaxed));
        truth_s = wires.elapsed_s() + kTruth_s;
    }
}

int simulate(PlantArguments arguments) {
    arguments.motion.depth_m = 1e-3 * arguments.depth_mm;
    arguments.motion.speed_m_per_s = 1e-3 * arguments.speed_mm_per_s;
    constexpr double kBeyond = 1.5;
    arguments.size.deepest_m = kBeyond * arguments.motion.depth_m;
    const SoftDevice device = read_soft_device(arguments.device);
    if (!device.wires)
        throw files::bad_input(arguments.device, "wires", "none", "the ports and drives that are to be simulated");
    const PlantOptions options = read_plant(arguments.plant);
    Plant plant = make_plant(std::make_shared<const DeviceModel>(make_device_model(device)), options, LoopOptions{});
    const PlantTable table = tabulated(*plant.model, arguments.size);
    if (options.sensor.rate_Hz > 0.0) arguments.wires.sensor_rate_Hz = options.sensor.rate_Hz;
    PlantBody body = body_of(arguments, *device.wires, std::move(plant), table);
    TruthFile truth(arguments.truth);
    truth.add(head_of(*device.wires));
    RigWires wires(*device.wires, arguments.wires);
    devices::simulators::listen_to_signals();  // before the line of its port: who has read that may end it
    std::printf("port %s\n", wires.ports().c_str());
    std::fflush(stdout);
    platform::set_real_time(true);
    run(*device.wires, wires, body, truth);
    std::printf("out_of_range %" PRId64 "\n", wires.out_of_range());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    PlantArguments arguments;
    CLI::App app("A simulated soft device on pseudo-terminals");
    add_options(app, arguments);
    CLI11_PARSE(app, argc, argv);
    try {
        return simulate(arguments);
    } catch (const files::InputError& error) {
        std::fprintf(stderr, "tangible_plant: %s\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tangible_plant: %s\n", error.what());
        return 1;
    }
}
