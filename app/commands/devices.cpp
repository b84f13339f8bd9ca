// palpa devices: the connected pens, touch screens and mice, and what they really send.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <unistd.h>

#include "app/commands/command_line.h"
#include "app/screens/device_check.h"
#include "files/json.h"
#include "platform/window.h"
#include "render/gl.h"

namespace palpa::app {
namespace {

struct DevicesOptions {
    double seconds = 0.0;
    bool json = false;
};

constexpr double kDrawEvery_s = 1.0 / 60.0;

void show(platform::Window& window) {
    render::clear_screen(window.width_px(), window.height_px());
    window.present();
}

void tell_time_left(double left_s, platform::Window& window) {
    const std::string left = std::to_string(static_cast<int>(std::ceil(left_s)));
    window.set_title("Palpa: press here with pen and fingers, " + left + " s left");
    if (isatty(STDERR_FILENO) != 0)
        std::fprintf(stderr, "\rpress in the window with pen and fingers: %s s left ", left.c_str());
}

// The caller owns `check`, which is large.
// Returns for how long.
double watch_devices(double seconds, platform::Window& window, DeviceCheck& check) {
    std::vector<platform::Sample> samples;
    window.set_keyboard(0.0, 0.0, window.width_px(), window.height_px(), 200.0);
    const double began_s = window.now_s();
    double told_s = seconds + 2.0;
    for (double frame_s = began_s; !window.close_requested();) {
        const double now_s = window.now_s();
        const double left_s = began_s + seconds - now_s;
        if (left_s <= 0.0) break;
        if (told_s - left_s >= 1.0) tell_time_left(told_s = std::ceil(left_s), window);
        samples.clear();
        window.poll(std::min(left_s, std::max(0.0, frame_s + kDrawEvery_s - now_s)), samples);
        for (const platform::Sample& sample : samples) observe(sample, check);
        if (window.now_s() - frame_s < kDrawEvery_s) continue;
        frame_s = window.now_s();
        show(window);
    }
    if (isatty(STDERR_FILENO) != 0) std::fputc('\n', stderr);
    return std::min(seconds, window.now_s() - began_s);
}

files::Json device_json(const platform::PointerDevice& device) {
    files::Json json{{"name", device.name}, {"tool", name_of(device.tool)}, {"has_pressure", device.has_pressure}};
    json["pressure_range"] =
        device.has_pressure ? files::Json{device.pressure_min, device.pressure_max} : files::Json(nullptr);
    json["levels"] = device.levels;
    json["has_tilt"] = device.has_tilt;
    json["has_contact_size"] = device.has_contact_size;
    json["axes"] = device.axes;
    return json;
}

void print_device(const platform::PointerDevice& device) {
    std::printf("%s: %s", std::string(name_of(device.tool)).c_str(), device.name.c_str());
    if (device.has_pressure) {
        std::printf(", pressure %g to %g (%lld levels)", device.pressure_min, device.pressure_max,
                    static_cast<long long>(device.levels));
    } else {
        std::printf(", no pressure");
    }
    std::printf("%s%s\n", device.has_tilt ? ", tilt" : "", device.has_contact_size ? ", contact size" : "");
}

void print_seen(platform::Tool which, const DeviceCheck& check) {
    const ToolCheck& tool = of_tool(which, check);
    std::printf("%s: %lld samples, %lld of them touching\n", std::string(name_of(which)).c_str(),
                static_cast<long long>(tool.samples), static_cast<long long>(tool.touching));
    if (!knows_gaps(tool))
        std::printf("  too few samples one after the other to tell how many come in a second\n");
    else
        std::printf(
            "  %.4g a second while it moves; from one to the next %.3g ms (median), %.3g ms (worst; rests over %g s "
            "left out)\n",
            rate_Hz(tool), 1e3 * median_gap_s(tool), 1e3 * worst_gap_s(tool), kRest_s);
    switch (platform::pressure_kind(check.pressure, which)) {
        case platform::PressureKind::constant:
            std::printf("  pressure is always %g: this is no sensor\n",
                        platform::constant_pressure(check.pressure, which));
            break;
        case platform::PressureKind::missing:
            std::printf("  no pressure\n");
            break;
        case platform::PressureKind::unknown:
            std::printf("  too few touches to judge the pressure\n");
            break;
        case platform::PressureKind::varies:
            std::printf("  pressure %.3g to %.3g, %lld different values\n", tool.pressure.lowest, tool.pressure.highest,
                        static_cast<long long>(distinct_pressures(tool)));
    }
    if (const ClockDrift drift = clock_drift(tool); std::isfinite(drift.ppm)) {
        std::printf("  its clock runs %+.0f ppm (standard error %.0f) against the computer's\n", drift.ppm,
                    drift.standard_error_ppm);
    }
    std::printf("  x %.1f to %.1f px, y %.1f to %.1f px\n", tool.x_px.lowest, tool.x_px.highest, tool.y_px.lowest,
                tool.y_px.highest);
}

void list_devices(const DevicesOptions& options) {
    platform::WindowOptions window_options;
    window_options.title = "Palpa: devices";
    window_options.width_px = 640;
    window_options.height_px = 400;
    platform::Window window(window_options);
    show(window);
    auto check = std::make_unique<DeviceCheck>();
    const double seconds = options.seconds > 0.0 ? watch_devices(options.seconds, window, *check) : 0.0;

    files::Json json{{"devices", files::Json::array()}, {"note", window.input_note()}};
    for (const platform::PointerDevice& device : window.devices()) {
        json["devices"].push_back(device_json(device));
        if (!options.json) print_device(device);
    }
    if (!options.json && !window.input_note().empty()) std::printf("note: %s\n", window.input_note().c_str());
    if (options.seconds > 0.0) {
        json["seconds"] = seconds;
        json["seen"] = check_json(*check);
        if (!options.json) std::printf("\nin %.3g s came:\n", seconds);
        for (const platform::Tool tool :
             {platform::Tool::pen, platform::Tool::finger, platform::Tool::mouse, platform::Tool::keyboard}) {
            if (of_tool(tool, *check).samples == 0) continue;
            if (!options.json) print_seen(tool, *check);
        }
        if (!options.json && json["seen"].empty()) std::printf("nothing\n");
    }
    if (options.json) std::fputs(files::json_text(json).c_str(), stdout);
}

}  // namespace

void add_devices(CLI::App& app) {
    auto options = std::make_shared<DevicesOptions>();
    CLI::App* command =
        app.add_subcommand("devices", "List pens, touch screens and mice: what they declare and what they really send");
    command->add_option("--seconds", options->seconds, "measure the samples of presses in a small window for this long")
        ->check(CLI::Range(0.0, 3600.0));
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { list_devices(*options); });
}

}  // namespace palpa::app
