#include "app/record_calibration.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <stdexcept>

#include "devices/load_cell.h"
#include "devices/netft.h"
#include "devices/sensor_reader.h"
#include "files/append_file.h"
#include "files/input_error.h"
#include "files/text.h"

namespace palpa {
namespace {

volatile std::sig_atomic_t interrupted = 0;

std::unique_ptr<ForceSensor> open_sensor(const RecordArguments& arguments) {
    const std::string& sensor = arguments.sensor;
    if (sensor.rfind("netft:", 0) == 0) {
        NetFtOptions options;
        options.host = sensor.substr(6);
        if (const auto colon = options.host.find(':'); colon != std::string::npos) {
            double port = 0.0;
            if (!parse_number(options.host.substr(colon + 1), port) || !(port >= 1.0 && port <= 65535.0)) {
                throw bad_input("--sensor", "", shown(sensor), "netft:HOST or netft:HOST:PORT");
            }
            options.port = static_cast<int>(port);
            options.host.resize(colon);
        }
        options.counts_per_N = arguments.counts_per_N;
        options.sign = arguments.axis.front() == '-' ? -1.0 : 1.0;
        options.axis = arguments.axis.back() - 'x';
        return open_netft(options);
    }
    if (sensor.rfind("serial:", 0) == 0) {
        if (arguments.N_per_count == 0.0) throw bad_input("--N-per-count", "", "nothing", "newtons for one count of the load cell (may be negative)");
        return open_load_cell({sensor.substr(7), arguments.baud, arguments.N_per_count});
    }
    if (sensor != "typed") throw bad_input("--sensor", "", shown(sensor), "netft:HOST[:PORT], serial:PATH or typed");
    return nullptr;
}

// Both streams as they came, on disk once a second. A run never touches the files of another.
struct RawFiles {
    AppendFile levels;
    AppendFile forces;
    std::string row;

    static std::filesystem::path free_name(const std::filesystem::path& folder, const char* what) {
        for (int i = 1;; ++i) {
            const auto file = folder / (std::string(what) + (i < 10 ? "-0" : "-") + std::to_string(i) + ".tsv");
            if (!std::filesystem::exists(file)) return file;
        }
    }
    explicit RawFiles(const std::filesystem::path& folder) : levels(free_name(folder, "levels")), forces(free_name(folder, "forces")) {
        levels.append("t_host_s\tt_device_s\tphase\tlevel\n");
        forces.append("t_host_s\tt_device_s\tforce_N\traw\n");
    }
    void write(const Sample& sample, double level) {
        row.clear();
        append_number(sample.t_host_s, row);
        row += '\t';
        append_number(sample.t_device_s, row);
        row += '\t';
        row += name_of(sample.phase);
        row += '\t';
        append_number(level, row);
        row += '\n';
        levels.append(row);
    }
    void write(const ForceReading& reading) {
        row.clear();
        append_number(reading.t_host_s, row);
        for (const double value : {reading.t_device_s, reading.force_N, reading.raw}) {
            row += '\t';
            append_number(value, row);
        }
        row += '\n';
        forces.append(row);
    }
    void sync() {
        if (!levels.sync() || !forces.sync()) throw std::runtime_error(levels.path().string() + ": can no longer be written; stopped (is the disk full?)");
    }
};

struct Recording {
    const RecordArguments& arguments;
    std::unique_ptr<LevelSource> source;
    std::unique_ptr<SensorReader> sensor;  // none: typed
    std::optional<RawFiles> raw;
    RecordSession session;
    Knowledge knowledge;
    double touched_s = -1.0;    // ended last
    std::string typed;          // the line that is being typed
    std::int64_t samples = 0;
    std::int64_t readings = 0;
    std::size_t resumed = 0;    // points of earlier runs
    int known_repeats = -1;
    bool told_silent = false;
};

std::filesystem::path points_file(const RecordArguments& arguments) { return std::filesystem::path(arguments.folder) / "points.csv"; }

void save_points(const Recording& recording) {
    write_text_atomically(points_file(recording.arguments), points_csv(recording.session.points));
}

bool touches(const Sample& sample, double level) { return (sample.phase == Phase::down || sample.phase == Phase::move) && level > 0.0; }

void take_levels(Recording& recording, const std::vector<Sample>& samples) {
    const Profile& profile = recording.arguments.level;
    for (const Sample& sample : samples) {
        if (sample.phase == Phase::ui || sample.tool == Tool::mouse) continue;  // a mouse has no sensor
        const double level = level_of(profile, sample);
        if (sample.phase != Phase::up && sample.phase != Phase::hover && sample.phase != Phase::cancel && std::isnan(level)) continue;
        ++recording.samples;
        recording.raw->write(sample, level);
        const bool touching = touches(sample, level);
        if (touching || recording.session.touching) recording.touched_s = sample.t_host_s;
        take_level(recording.arguments.options, sample.t_host_s, touching ? level : 0.0, touching, recording.session);
    }
}

// The zero is taken while nothing touches, and fixed by the first point of the run.
void take_forces(Recording& recording) {
    std::vector<ForceReading> readings;
    recording.sensor->poll(readings);
    RecordSession& session = recording.session;
    const RecordOptions& options = recording.arguments.options;
    const bool knows_touch = recording.samples > 0 || recording.arguments.levels.empty();  // a stream may begin amid a press
    for (const ForceReading& reading : readings) {
        ++recording.readings;
        recording.raw->write(reading);
        constexpr double kLift_s = 0.1;
        const bool resting = knows_touch && !session.touching && reading.t_host_s - recording.touched_s > kLift_s;
        if (!resting) session.rest.clear();
        if (resting && session.points.size() == recording.resumed) take_rest(options, reading.t_host_s, reading.force_N, session);
        if (!std::isnan(session.zero_N)) take_force(options, reading.t_host_s, reading.force_N - session.zero_N, session);
    }
}

// A number on standard input and Enter: what the scale shows now, while the pen is held still.
bool take_typed(Recording& recording) {
    pollfd waiting{0, POLLIN, 0};
    if (::poll(&waiting, 1, 0) <= 0) return true;
    char c = 0;
    if (::read(0, &c, 1) <= 0) return false;
    if (c != '\n') {
        recording.typed.push_back(c);
        return true;
    }
    double shows = 0.0;
    const bool good = parse_number(recording.typed, shows) && shows >= 0.0 && shows < 1e5;
    const std::string line = std::exchange(recording.typed, "");
    if (!good) {
        std::fprintf(stderr, "palpa: found %s, expected what the scale shows, a number >= 0\n", shown(line).c_str());
        return true;
    }
    constexpr double kN_per_gf = 9.80665e-3;
    const double force_N = recording.arguments.newton ? shows : shows * kN_per_gf;
    const RecordOptions& options = recording.arguments.options;
    const double now_s = steady_s();
    for (const double ago : {0.95, 0.7, 0.45, 0.2}) take_force(options, now_s - ago * options.steady_s, force_N, recording.session);
    if (!capture(options, now_s, recording.session)) std::fprintf(stderr, "palpa: not taken: hold the pen still at another level while you type\n");
    return true;
}

void tell(const Recording& recording, double level) {
    if (::isatty(2) == 0) return;
    const RecordOptions& options = recording.arguments.options;
    const int band = target_band(options, recording.session, recording.knowledge.band_error);
    const double force_N = recording.session.forces.empty() ? kMissing : recording.session.forces.back().value;
    const bool zero_missing = recording.sensor && std::isnan(recording.session.zero_N);
    const std::string target = zero_missing ? "do not touch (zero)" : band < 0 ? "lift the pen" : "press to " + short_number(100.0 * band / options.bands) + " - " + short_number(100.0 * (band + 1) / options.bands) + " %";
    std::string health;
    if (recording.sensor) {
        const SensorHealth now = recording.sensor->health();
        health = (now.alive ? "" : "  SENSOR SILENT") + std::string("  lost ") + std::to_string(now.lost) + " twice " + std::to_string(now.duplicate) + " late " +
                 std::to_string(now.reordered) + " bad " + std::to_string(now.malformed) + " stalls " + std::to_string(now.stalls);
    }
    std::fprintf(stderr, "\r%-22s level %5.1f %%  force %6.3f N  points %zu  press %d%s\033[K", target.c_str(),
                 100.0 * (level - options.range.lowest) / (options.range.highest - options.range.lowest), force_N, recording.session.points.size(),
                 recording.session.repeat + 1, health.c_str());
}

// A sensor that never says anything is a mistake in the set-up; one that falls silent later is waited for.
void watch_sensor(Recording& recording, double since_start_s) {
    if (!recording.sensor) return;
    const SensorHealth health = recording.sensor->health();
    constexpr double kPatience_s = 5.0;
    if (health.received == 0 && since_start_s > kPatience_s) {
        throw std::runtime_error(recording.sensor->name() + ": no reading in " + short_number(kPatience_s) + " s (connected, powered, right address?)");
    }
    const bool silent = health.received > 0 && !health.alive;
    if (silent && !recording.told_silent) std::fprintf(stderr, "\npalpa: warning: %s has stopped; nothing is captured until it is back\n", recording.sensor->name().c_str());
    if (!silent && recording.told_silent) std::fprintf(stderr, "\npalpa: %s is back\n", recording.sensor->name().c_str());
    recording.told_silent = silent;
}

// After each press: is it enough?
bool enough(Recording& recording) {
    if (recording.session.touching || recording.session.repeat == recording.known_repeats || !recording.session.captured_in_repeat) return false;
    recording.known_repeats = recording.session.repeat;
    recording.knowledge = knowledge_of(recording.arguments.options, recording.session.points);
    std::fprintf(stderr, "%spress %d: %s\n", ::isatty(2) != 0 ? "\r\033[K" : "", recording.session.repeat + 1,
                 recording.knowledge.done ? "the curve is known everywhere" : recording.knowledge.missing.c_str());
    return recording.knowledge.done;
}

Json health_json(const SensorHealth& health) {
    return {{"received", health.received}, {"lost", health.lost}, {"duplicate", health.duplicate}, {"reordered", health.reordered},
            {"malformed", health.malformed}, {"overflowed", health.overflowed}, {"stalls", health.stalls}, {"reconnects", health.reconnects},
            {"faults", health.faults}};
}

Json result_of(const Recording& recording) {
    const Knowledge knowledge = knowledge_of(recording.arguments.options, recording.session.points);
    Json json{{"points", recording.session.points.size()}, {"repeats", knowledge.repeats}, {"done", knowledge.done}, {"missing", knowledge.missing},
              {"relative_half_interval", knowledge.band_error}, {"samples", recording.samples}, {"file", points_file(recording.arguments).string()}};
    if (recording.sensor) {
        json["sensor"] = {{"name", recording.sensor->name()}, {"readings", recording.readings}, {"health", health_json(recording.sensor->health())}};
        json["sensor"]["zero_N"] = recording.session.zero_N;
    }
    return json;
}

// Nothing of an earlier session is touched unless it is gone on with.
void open_session(const RecordArguments& arguments, RecordSession& session) {
    const auto file = points_file(arguments);
    if (std::filesystem::exists(file)) {
        if (!arguments.resume) throw bad_input(file.string(), "", "a session", "a new folder, or --resume to go on with it");
        session.points = read_session(file);
        for (const CapturedPoint& point : session.points) session.repeat = std::max(session.repeat, point.repeat + 1);
        return;
    }
    if (arguments.resume) throw bad_input(file.string(), "", "nothing", "the session to resume");
}

}  // namespace

Json record_calibration(const RecordArguments& arguments) {
    std::unique_ptr<ForceSensor> device = open_sensor(arguments);
    if (!device && arguments.levels == "-") throw bad_input("--levels", "", "-", "a file or pipe: standard input is for the typed numbers");
    Recording recording{arguments, nullptr, nullptr, std::nullopt, {}, {}, -1.0, "", 0, 0, 0, -1, false};
    open_session(arguments, recording.session);
    recording.resumed = recording.session.points.size();
    recording.source = arguments.levels.empty() ? open_level_window() : open_level_stream(arguments.levels);
    std::filesystem::create_directories(arguments.folder);
    recording.raw.emplace(arguments.folder);
    if (device) recording.sensor = std::make_unique<SensorReader>(std::move(device));
    interrupted = 0;
    const auto before = std::signal(SIGINT, [](int) { interrupted = 1; });
    const auto before_term = std::signal(SIGTERM, [](int) { interrupted = 1; });

    const double began_s = steady_s();
    double synced_s = began_s;
    double told_s = began_s;
    std::vector<Sample> samples;
    bool going = true;
    while (going && interrupted == 0) {
        samples.clear();
        going = recording.source->poll(0.005, samples);
        take_levels(recording, samples);
        const std::size_t had = recording.session.points.size();
        const double now_s = steady_s();
        if (recording.sensor) {
            take_forces(recording);
            capture(arguments.options, now_s, recording.session);
        } else {
            going = take_typed(recording) && going;
        }
        if (recording.session.points.size() > had) save_points(recording);
        if (now_s - synced_s > 1.0) {
            recording.raw->sync();
            synced_s = now_s;
        }
        if (now_s - told_s > 0.1) {
            tell(recording, recording.session.levels.empty() ? kMissing : recording.session.levels.back().value);
            told_s = now_s;
        }
        watch_sensor(recording, now_s - began_s);
        if (enough(recording) || (arguments.seconds > 0.0 && now_s - began_s > arguments.seconds)) break;
    }
    if (recording.sensor) take_forces(recording);
    recording.raw->sync();
    save_points(recording);
    std::signal(SIGINT, before);
    std::signal(SIGTERM, before_term);
    return result_of(recording);
}

}  // namespace palpa
