#include "app/commands/record_calibration.h"

#include <cmath>
#include <cstdio>
#include <poll.h>
#include <unistd.h>
#include <utility>

#include "app/commands/interrupt.h"
#include "calibration/record/acquisition.h"
#include "files/input_error.h"
#include "files/text.h"

namespace palpa::app {
namespace {

// Reads a number from standard input: what the scale shows while the pen is held still. Returns false at the end of input.
bool take_typed(std::string& typed, calibration::Recording& recording) {
    pollfd waiting{0, POLLIN, 0};
    if (::poll(&waiting, 1, 0) <= 0) return true;
    char c = 0;
    if (::read(0, &c, 1) <= 0) return false;
    if (c != '\n') {
        typed.push_back(c);
        return true;
    }
    double shows = 0.0;
    const bool good = files::parse_number(typed, shows) && shows >= 0.0 && shows < 1e5;
    const std::string line = std::exchange(typed, "");
    if (!good) {
        std::fprintf(stderr, "palpa: found %s, expected what the scale shows, a number >= 0\n",
                     files::shown(line).c_str());
        return true;
    }
    const double force_N = recording.arguments.newton ? shows : shows * calibration::kN_per_gf;
    if (!calibration::take_typed_N(force_N, recording))
        std::fprintf(stderr, "palpa: not taken: %s\n",
                     recording.session.touching ? "hold the pen still at another level while you type"
                                                : "press on the surface, and hold the pen still while you type");
    return true;
}

void tell(const calibration::Recording& recording) {
    if (::isatty(2) == 0) return;
    const calibration::RecordSession& session = recording.session;
    const calibration::RecordOptions& options = recording.arguments.options;
    const double level = session.levels.empty() ? platform::kMissing : session.levels.back().value;
    const double force_N = session.forces.empty() ? platform::kMissing : session.forces.back().value;
    std::string health;
    if (recording.sensor) {
        const devices::SensorHealth now = recording.sensor->health();
        health = (now.alive ? "" : "  SENSOR SILENT") + std::string("  lost ") + std::to_string(now.lost) + " twice " +
                 std::to_string(now.duplicate) + " late " + std::to_string(now.reordered) + " bad " +
                 std::to_string(now.malformed) + " stalls " + std::to_string(now.stalls) + " invalid " +
                 std::to_string(now.invalid);
    }
    std::fprintf(stderr, "\r%-22s level %5.1f %%  force %6.3f N  points %zu  press %d%s\033[K",
                 calibration::advice(recording).c_str(),
                 100.0 * (level - options.range.lowest) / (options.range.highest - options.range.lowest), force_N,
                 session.points.size(), session.repeat + 1, health.c_str());
}

void tell_news(bool was_silent, bool was_invalid, bool was_outside, const calibration::Recording& recording) {
    if (recording.outside > 0 && !was_outside) {
        const calibration::LevelRange& range = recording.arguments.options.range;
        std::fprintf(
            stderr,
            "\npalpa: warning: found level %s, expected %s to %s: no point follows from it; --level-range says "
            "what the device can report\n",
            files::short_number(recording.outside_level).c_str(), files::short_number(range.lowest).c_str(),
            files::short_number(range.highest).c_str());
    }
    if (recording.silent && !was_silent) {
        std::fprintf(stderr, "\npalpa: warning: %s has stopped; nothing is captured until it is back\n",
                     recording.sensor->name().c_str());
    }
    if (!recording.silent && was_silent) {
        std::fprintf(stderr, "\npalpa: %s is back: lift the pen, so that its zero is taken anew\n",
                     recording.sensor->name().c_str());
    }
    if (recording.invalid && !was_invalid) {
        std::fprintf(stderr,
                     "\npalpa: warning: %s says that its forces are invalid (overloaded?); nothing is captured until "
                     "they are valid\n",
                     recording.sensor->name().c_str());
    }
    if (!recording.judged) return;
    std::fprintf(stderr, "%spress %d: %s\n", ::isatty(2) != 0 ? "\r\033[K" : "", recording.session.repeat + 1,
                 known_words(recording.knowledge.done, recording.knowledge.missing).c_str());
}

}  // namespace

std::string known_words(bool done, const std::string& missing) {
    if (!done) return missing;
    return "the curve is known everywhere" + (missing.empty() ? "" : "; " + missing);
}

files::Json record_calibration(const calibration::RecordArguments& arguments) {
    if (arguments.sensor == "typed" && arguments.levels == "-") {
        throw files::bad_input("--levels", "", "-", "a file or pipe: standard input is for the typed numbers");
    }
    const std::unique_ptr<LevelSource> source =
        arguments.levels.empty() ? open_level_window() : open_level_stream(arguments.levels, arguments.level);
    const std::unique_ptr<calibration::Recording> recording = calibration::open_recording(arguments);
    const Interrupt interrupt;
    std::string typed;
    double told_s = 0.0;
    std::vector<platform::Sample> samples;
    for (bool going = true; going && !interrupt.came();) {
        samples.clear();
        const bool more = source->poll(0.005, samples);
        const bool was_silent = recording->silent;
        const bool was_invalid = recording->invalid;
        const bool was_outside = recording->outside > 0;
        going = calibration::step(samples, *recording) && more;
        if (!recording->sensor) going = take_typed(typed, *recording) && going;
        tell_news(was_silent, was_invalid, was_outside, *recording);
        source->show(*recording);
        if (devices::steady_s() - told_s > 0.1) {
            tell(*recording);
            told_s = devices::steady_s();
        }
    }
    return calibration::close_recording(*recording);
}

}  // namespace palpa::app
