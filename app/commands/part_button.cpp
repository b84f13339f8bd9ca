// palpa part button

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/part.h"
#include "files/json.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "parts/button_file.h"
#include "parts/edit.h"

namespace palpa::app {
namespace {

struct ButtonOptions {
    std::string file;
    std::string out;
    bool json = false;
};

// The pressing and the releasing force at 101 travels; a button goes on and off where it does by travel.
files::Json curve_json(const mechanics::ButtonCurve& curve) {
    constexpr std::size_t kEvery = 10;
    files::Json travel_mm = files::Json::array(), press_N = travel_mm, release_N = travel_mm;
    const std::size_t n = curve.press_N[0].size();
    for (std::size_t i = 0; i < n; i += kEvery) {
        const double w = curve.travel_m * static_cast<double>(i) / static_cast<double>(n - 1);
        travel_mm.push_back(1e3 * w);
        press_N.push_back(curve.press_N[curve.on_m && w > *curve.on_m][i]);
        release_N.push_back(curve.release_N[curve.off_m && w > *curve.off_m][i]);
    }
    return {{"travel_mm", travel_mm}, {"press_N", press_N}, {"release_N", release_N}};
}

files::Json json_of(const parts::Part& part, const mechanics::ButtonCurve& curve) {
    const auto or_null = [](bool known, double value) { return known ? files::number_or_null(value) : nullptr; };
    files::Json json{{"part", part.file}, {"name", part.name}, {"travel_mm", 1e3 * curve.travel_m}};
    json["snaps"] = curve.snaps;
    json["peak_N"] = or_null(curve.snaps, curve.peak_N);
    json["peak_mm"] = or_null(curve.snaps, 1e3 * curve.peak_m);
    json["trough_N"] = or_null(curve.snaps, curve.trough_N);
    json["trough_mm"] = or_null(curve.snaps, 1e3 * curve.trough_m);
    json["snap_ratio"] = or_null(curve.snaps, (curve.peak_N - curve.trough_N) / curve.peak_N);
    json["on_mm"] = or_null(curve.on_m.has_value(), 1e3 * curve.on_m.value_or(0.0));
    json["off_mm"] = or_null(curve.off_m.has_value(), 1e3 * curve.off_m.value_or(0.0));
    json["loss_J"] = curve.loss_J;
    json["newton_iterations"] = curve.newton_iterations;
    json["curve"] = curve_json(curve);
    return json;
}

void print_table(const parts::Part& part, const mechanics::ButtonCurve& curve) {
    const auto mm = [](double metres) { return files::short_number(1e3 * metres) + " mm"; };
    std::printf("%s, travel %s\n", files::printable(part.name).c_str(), mm(curve.travel_m).c_str());
    if (curve.snaps) {
        std::printf("  peak   %10s N at %s\n", files::short_number(curve.peak_N).c_str(), mm(curve.peak_m).c_str());
        if (std::isfinite(curve.trough_m))
            std::printf("  trough %10s N at %s, snap ratio %s\n", files::short_number(curve.trough_N).c_str(),
                        mm(curve.trough_m).c_str(),
                        files::short_number((curve.peak_N - curve.trough_N) / curve.peak_N).c_str());
        else
            std::printf("  trough not reached within the travel\n");
    } else {
        std::printf("  does not snap\n");
    }
    if (curve.on_m) std::printf("  on at %s, off at %s\n", mm(*curve.on_m).c_str(), mm(*curve.off_m).c_str());
    std::printf("  lost in one press %s mJ\n", files::short_number(1e3 * curve.loss_J).c_str());
}

void run_button(const ButtonOptions& options) {
    if (!options.out.empty()) files::check_output(options.out, parts::files_of_part(options.file));
    const parts::Part part = read_part_aloud(options.file);
    const mechanics::ButtonCurve curve = parts::button_curve(part);
    const std::string text = files::json_text(json_of(part, curve));
    if (!options.out.empty()) files::write_text_atomically(options.out, text);
    if (options.json) {
        std::printf("%s", text.c_str());
    } else {
        print_table(part, curve);
    }
}

}  // namespace

void add_part_button(CLI::App& part) {
    auto options = std::make_shared<ButtonOptions>();
    CLI::App* command = part.add_subcommand("button", "Force over travel of a part's push button, through its snap");
    command->add_option("PART", options->file, "part JSON with the key button")->required();
    command->add_option("-o,--out", options->out, "also write the JSON object to FILE");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { run_button(*options); });
}

}  // namespace palpa::app
