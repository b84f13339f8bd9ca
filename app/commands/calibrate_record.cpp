// palpa calibrate record

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "app/commands/record_calibration.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"

namespace palpa::app {
namespace {

struct RecordArguments {
    calibration::RecordArguments record;
    std::string level = "pressure";
    std::vector<double> range;
    bool json = false;
};

// Returns a path as one word of a command line.
std::string word(const std::string& path) {
    const bool plain = std::all_of(path.begin(), path.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c >= 0x80 ||
               std::string_view("_./-+,:@").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (plain) return path;
    std::string out = "'";
    for (const char c : path) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

// What the fit has to be told of the levels: it cannot read it off the points.
std::string level_options(const RecordArguments& arguments) {
    std::string out;
    if (arguments.level != "pressure") out += " --level " + arguments.level;
    if (!arguments.range.empty()) {
        out +=
            " --level-range " + files::number_text(arguments.range[0]) + " " + files::number_text(arguments.range[1]);
    }
    if (arguments.level == "contact_area")
        out += " --full-contact-area-px2 " + files::number_text(arguments.record.level.full_contact_area_px2);
    return out;
}

void print_recorded(const RecordArguments& arguments, const files::Json& result) {
    std::printf("%s: %s points of %s presses; %s\n", result["file"].get_ref<const std::string&>().c_str(),
                result["points"].dump().c_str(), result["repeats"].dump().c_str(),
                known_words(result["done"].get<bool>(), result["missing"].get_ref<const std::string&>()).c_str());
    if (result.contains("sensor")) {
        std::string health;
        for (const auto& [what, count] : result["sensor"]["health"].items()) {
            if (what == "received" || count != 0) health += (health.empty() ? "" : ", ") + count.dump() + " " + what;
        }
        std::printf("  sensor      %s\n", health.c_str());
    }
    if (result["points"] == 0) return;  // nothing to fit yet
    std::printf("  next        palpa calibrate fit %s -o PROFILE.json%s\n",
                word(result["file"].get_ref<const std::string&>()).c_str(), level_options(arguments).c_str());
}

// Options of another kind of sensor would have no effect.
void check_of_sensor(const CLI::App& command, const std::string& sensor) {
    struct Option {
        const char* name;
        const char* kind;
    };
    for (const Option& one :
         {Option{"--counts-per-N", "netft:"}, Option{"--axis", "netft:"}, Option{"--N-per-count", "serial:"},
          Option{"--baud", "serial:"}, Option{"--newton", "typed"}}) {
        if (command.count(one.name) > 0 && sensor.rfind(one.kind, 0) != 0)
            throw files::bad_input(one.name, "", "--sensor " + sensor, std::string("--sensor ") + one.kind);
    }
}

void record(RecordArguments& arguments) {
    calibration::RecordArguments& record = arguments.record;
    files::check_output_folder(record.folder);
    record.level.level = arguments.level == "pressure"       ? calibration::LevelField::pressure
                         : arguments.level == "pressure_raw" ? calibration::LevelField::pressure_raw
                                                             : calibration::LevelField::contact_area;
    if (record.level.level == calibration::LevelField::pressure_raw && arguments.range.empty()) {
        throw files::bad_input("--level-range", "", "nothing", "the counts that the device can report, as 0 8191");
    }
    if (!arguments.range.empty()) {
        if (!(arguments.range[0] < arguments.range[1])) {
            throw files::bad_input(
                "--level-range", "",
                files::short_number(arguments.range[0]) + " " + files::short_number(arguments.range[1]),
                "the lower level first");
        }
        record.options.range = {arguments.range[0], arguments.range[1]};
    }
    const files::Json result = record_calibration(record);
    if (result["wrong_sign"].get<bool>())
        std::fprintf(stderr, "palpa: warning: the force was below zero in a press: reverse the sign of %s\n",
                     record.sensor.rfind("serial:", 0) == 0 ? "--N-per-count" : "--axis");
    const bool silent = result.contains("sensor") && result["sensor"]["health"].value("received", 0) == 0;
    if (arguments.json) {
        std::fputs(files::json_text(result).c_str(), stdout);
    } else {
        print_recorded(arguments, result);
    }
    if (silent) throw std::runtime_error(record.sensor + ": it sent nothing");
    if (result["points"] == 0) {
        const auto without = result["without_level"].get<std::int64_t>();
        throw std::runtime_error(
            record.folder + ": no point was recorded, which takes a level held still and its force" +
            (without == 0 ? ""
                          : " (" + std::to_string(without) + " samples of the device had no " + arguments.level + ")"));
    }
}

}  // namespace

void add_calibrate_record(CLI::App& calibrate) {
    auto arguments = std::make_shared<RecordArguments>();
    calibration::RecordArguments& options = arguments->record;
    options.level.full_contact_area_px2 = 8000.0;
    CLI::App* command = calibrate.add_subcommand(
        "record",
        "Record points with a force sensor under the tablet: hold the pen still at many levels, several times");
    command->add_option("-o,--output", options.folder, "folder of the session, for points.csv and both raw streams")
        ->required();
    command
        ->add_option("--sensor", options.sensor,
                     "netft:HOST[:PORT] (ATI Net F/T), serial:PATH (lines t_us,raw), or typed (numbers from a scale)")
        ->required();
    command->add_option("--levels", options.levels,
                        "file or pipe with one level per line, - for standard input (default: a window to press on)");
    command
        ->add_option("--counts-per-N", options.counts_per_N,
                     "netft: counts per newton (the sensor's counts per force, in newtons)")
        ->check(CLI::Range(1e-9, 1e12))
        ->capture_default_str();
    command->add_option("--axis", options.axis, "netft: direction of pressing")
        ->check(one_of({"x", "y", "z", "-x", "-y", "-z"}))
        ->capture_default_str();
    command->add_option("--N-per-count", options.N_per_count,
                        "serial: newtons per count (put a known weight on: newtons / difference of counts)");
    command->add_option("--baud", options.baud, "serial: baud rate")->capture_default_str();
    command->add_flag("--newton", options.newton, "typed: the numbers are newtons (default: gram-force)");
    command->add_option("--level", arguments->level, "field of a sample that is the level")
        ->check(one_of({"pressure", "pressure_raw", "contact_area"}))
        ->capture_default_str();
    command
        ->add_option("--level-range", arguments->range,
                     "LOWEST HIGHEST level that the device can report (default: 0 1; required for pressure_raw)")
        ->expected(2)
        ->check(CLI::Range(0.0, 1e9));
    command
        ->add_option("--full-contact-area-px2", options.level.full_contact_area_px2,
                     "contact_area only: area of the ellipse whose level is 1")
        ->check(CLI::Range(1.0, 1e9))
        ->capture_default_str();
    command->add_option("--steady-s", options.options.steady_s, "how long both signals must hold still for a point")
        ->check(CLI::Range(0.05, 5.0))
        ->capture_default_str();
    command
        ->add_option("--goal", options.options.goal,
                     "stop when half of the 95 % interval is within this share of the force everywhere")
        ->check(CLI::Range(0.001, 1.0))
        ->capture_default_str();
    command
        ->add_option("--seconds", options.seconds,
                     "stop after this many seconds (default: when the goal is reached, or on Ctrl-C)")
        ->check(CLI::Range(0.0, 1e6));
    command->add_flag("--resume", options.resume, "continue the session in the folder");
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([command, arguments] {
        check_of_sensor(*command, arguments->record.sensor);
        refuse_unused(*command, "--full-contact-area-px2", arguments->level == "contact_area", "--level contact_area");
        record(*arguments);
    });
}

}  // namespace palpa::app
