#include "calibration/record/acquisition.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "devices/load_cell.h"
#include "devices/netft.h"
#include "files/input_error.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

std::unique_ptr<devices::ForceSensor> open_sensor(const RecordArguments& arguments) {
    const std::string& sensor = arguments.sensor;
    if (sensor.rfind("netft:", 0) == 0) {
        devices::NetFtOptions options;
        options.host = sensor.substr(6);
        if (const auto colon = options.host.find(':'); colon != std::string::npos) {
            double port = 0.0;
            if (!files::parse_number(options.host.substr(colon + 1), port) || !(port >= 1.0 && port <= 65535.0) ||
                port != std::floor(port)) {
                throw files::bad_input("--sensor", "", files::shown(sensor), "netft:HOST or netft:HOST:PORT");
            }
            options.port = static_cast<int>(port);
            options.host.resize(colon);
        }
        if (options.host.empty())
            throw files::bad_input("--sensor", "", files::shown(sensor), "netft:HOST or netft:HOST:PORT");
        options.counts_per_N = arguments.counts_per_N;
        options.sign = arguments.axis.front() == '-' ? -1.0 : 1.0;
        options.axis = arguments.axis.back() - 'x';
        return devices::open_netft(options);
    }
    if (sensor.rfind("serial:", 0) == 0) {
        if (arguments.N_per_count == 0.0)
            throw files::bad_input("--N-per-count", "", "0 or nothing",
                                   "newtons for one count of the load cell (may be negative)");
        return devices::open_load_cell({sensor.substr(7), arguments.baud, arguments.N_per_count});
    }
    if (sensor != "typed")
        throw files::bad_input("--sensor", "", files::shown(sensor), "netft:HOST[:PORT], serial:PATH or typed");
    return nullptr;
}

std::filesystem::path free_name(const std::filesystem::path& folder, const char* what) {
    for (int i = 1;; ++i) {
        const auto file = folder / (std::string(what) + (i < 10 ? "-0" : "-") + std::to_string(i) + ".tsv");
        if (!std::filesystem::exists(file)) return file;
    }
}
void save_points(const Recording& recording) {
    files::write_text_atomically(points_file(recording.arguments), points_csv(recording.session.points));
}

bool touches(const platform::Sample& sample, double level) {
    return (sample.phase == platform::Phase::down || sample.phase == platform::Phase::move) && level > 0.0;
}

namespace {

// An area is measured by widths, so that the greatest one may come out by a rounding error above its range.
double without_rounding(double level, const LevelRange& range) {
    const double inside = std::clamp(level, range.lowest, range.highest);
    return std::abs(level - inside) <= 1e-9 * (range.highest - range.lowest) ? inside : level;
}

}  // namespace

void take_levels(const std::vector<platform::Sample>& samples, Recording& recording) {
    const Profile& profile = recording.arguments.level;
    for (const platform::Sample& sample : samples) {
        if (sample.phase == platform::Phase::ui || sample.tool == platform::Tool::mouse)
            // a mouse has no sensor
            continue;
        const double level = without_rounding(level_of(profile, sample), recording.arguments.options.range);
        if (sample.phase != platform::Phase::up && sample.phase != platform::Phase::hover &&
            sample.phase != platform::Phase::cancel && std::isnan(level)) {
            ++recording.without_level;
            continue;
        }
        if (touches(sample, level)) recording.knows_level = true;
        ++recording.samples;
        recording.raw->write(sample, level);
        const bool touching = touches(sample, level);
        platform::move_to(sample, recording.timeline);
        const double t_s = recording.timeline.now_s;
        if (touching || recording.session.touching) recording.touched_s = t_s;
        const LevelRange& range = recording.arguments.options.range;
        if (touching && (level < range.lowest || level > range.highest)) {
            if (recording.outside == 0) recording.outside_level = level;
            ++recording.outside;
        }
        take_level(recording.arguments.options, t_s, touching ? level : 0.0, touching, recording.session);
    }
}

// Takes the new readings. The zero is measured while nothing touches, until the next point fixes it.
void take_forces(Recording& recording) {
    std::vector<devices::ForceReading> readings;
    recording.sensor->poll(readings);
    RecordSession& session = recording.session;
    const RecordOptions& options = recording.arguments.options;
    // a stream may begin during a press
    const bool knows_touch = recording.samples > 0 || recording.arguments.levels.empty();
    for (const devices::ForceReading& reading : readings) {
        ++recording.readings;
        recording.raw->write(reading);
        constexpr double kLift_s = 0.1;
        const bool resting = knows_touch && !session.touching && reading.t_host_s - recording.touched_s > kLift_s;
        if (!resting) session.rest.clear();
        if (resting && session.points.size() == recording.zero_at)
            take_rest(options, reading.t_host_s, reading.force_N, session);
        if (!std::isnan(session.zero_N))
            take_force(options, reading.t_host_s, reading.force_N - session.zero_N, session);
    }
}

// A sensor that was away may have been switched off, and has another zero then.
void zero_again(Recording& recording) {
    RecordSession& session = recording.session;
    session.zero_N = platform::kMissing;
    session.rest.clear();
    session.forces.clear();
    recording.zero_at = session.points.size();
}

// Throws std::runtime_error for a sensor that never sends a reading, which is a mistake in the set-up; one that falls
// silent later is waited for.
void watch_sensor(double now_s, Recording& recording) {
    if (!recording.sensor) return;
    const devices::SensorHealth health = recording.sensor->health();
    constexpr double kPatience_s = 5.0;
    if (health.received == 0 && now_s - recording.began_s > kPatience_s) {
        throw std::runtime_error(recording.sensor->name() + ": no reading in " + files::short_number(kPatience_s) +
                                 (health.invalid > 0 ? " s that the sensor calls valid (overloaded?)"
                                                     : " s (connected, powered, right address?)"));
    }
    const bool was_silent = recording.silent;
    recording.silent = health.received > 0 && !health.alive;
    if (was_silent && !recording.silent) zero_again(recording);
    if (health.invalid > recording.invalids) recording.invalid_s = now_s;
    recording.invalids = health.invalid;
    constexpr double kInvalid_s = 0.5;
    recording.invalid = health.invalid > 0 && now_s - recording.invalid_s < kInvalid_s;
}

// Judges after each press whether the curve is known well enough.
bool enough(Recording& recording) {
    recording.judged = false;
    if (recording.session.touching || recording.session.repeat == recording.known_repeats ||
        !recording.session.captured_in_repeat)
        return false;
    recording.known_repeats = recording.session.repeat;
    recording.knowledge = knowledge_of(recording.arguments.options, recording.session.points);
    recording.judged = true;
    return recording.knowledge.done;
}

files::Json health_json(const devices::SensorHealth& health) {
    return {{"received", health.received},   {"lost", health.lost},
            {"duplicate", health.duplicate}, {"reordered", health.reordered},
            {"malformed", health.malformed}, {"overflowed", health.overflowed},
            {"stalls", health.stalls},       {"reconnects", health.reconnects},
            {"faults", health.faults},       {"invalid", health.invalid}};
}

// Whether presses gave nothing but forces below zero, so far in this recording.
bool pulls(const Recording& recording) {
    return recording.session.below_zero > 0 && recording.session.points.size() <= recording.resumed;
}

files::Json result_of(const Recording& recording) {
    const Knowledge knowledge = knowledge_of(recording.arguments.options, recording.session.points);
    files::Json json{{"points", recording.session.points.size()},
                     {"repeats", knowledge.repeats},
                     {"done", knowledge.done},
                     {"missing", knowledge.missing},
                     {"relative_half_interval", knowledge.band_error},
                     {"samples", recording.samples},
                     {"below_zero", recording.session.below_zero},
                     {"wrong_sign", pulls(recording)},
                     {"outside_range", recording.outside},
                     {"without_level", recording.without_level},
                     {"file", points_file(recording.arguments).string()}};
    if (recording.sensor) {
        json["sensor"] = {{"name", recording.sensor->name()},
                          {"readings", recording.readings},
                          {"health", health_json(recording.sensor->health())}};
        json["sensor"]["zero_N"] = recording.session.zero_N;
    }
    return json;
}

// What makes numbers into newtons and levels.
files::Json units_of(const RecordArguments& arguments) {
    files::Json json{{"sensor", arguments.sensor.substr(0, arguments.sensor.find(':'))},
                     {"level", name_of(arguments.level.level)}};
    if (json["sensor"] == "netft") json.update({{"counts_per_N", arguments.counts_per_N}, {"axis", arguments.axis}});
    if (json["sensor"] == "serial") json["N_per_count"] = arguments.N_per_count;
    if (json["sensor"] == "typed") json["newton"] = arguments.newton;
    if (arguments.level.level == LevelField::contact_area)
        json["full_contact_area_px2"] = arguments.level.full_contact_area_px2;
    return json;
}

// One file holds points of one kind. Sessions of earlier versions did not say theirs.
void keep_units(const RecordArguments& arguments) {
    const auto file = std::filesystem::path(arguments.folder) / "session.json";
    const files::Json wanted = units_of(arguments);
    if (!arguments.resume || !std::filesystem::exists(file))
        return files::write_text_atomically(file, files::json_text(wanted));
    const files::Json found = files::read_json(file);
    for (const auto& [key, value] : wanted.items()) {
        const files::Json there = found.is_object() ? found.value(key, files::Json()) : files::Json();
        if (there != value)
            throw files::bad_input(file.string(), key, there.dump() + " in the session that is to be resumed",
                                   "the same, not " + value.dump());
    }
}

// Opens the session of the folder. An earlier one that has points stays as it is unless it is resumed.
void open_session(const RecordArguments& arguments, RecordSession& session) {
    const auto file = points_file(arguments);
    if (std::filesystem::exists(file)) {
        session.points = read_session(file);
        if (!arguments.resume && !session.points.empty())
            throw files::bad_input(file.string(), "", "a session", "a new folder, or --resume to continue it");
        for (const CapturedPoint& point : session.points) session.repeat = std::max(session.repeat, point.repeat + 1);
        if (!session.points.empty())
            session.clock_shift_s = std::max(0.0, session.points.back().time_s + 1.0 - devices::steady_s());
        return;
    }
    if (arguments.resume) throw files::bad_input(file.string(), "", "nothing", "the session to resume");
}

}  // namespace

RawFiles::RawFiles(const std::filesystem::path& folder)
    : levels(free_name(folder, "levels")), forces(free_name(folder, "forces")) {
    levels.append("t_host_s\tt_device_s\tphase\tlevel\n");
    forces.append("t_host_s\tt_device_s\tforce_N\traw\n");
}
void RawFiles::write(const platform::Sample& sample, double level) {
    row.clear();
    files::append_number(sample.t_host_s, row);
    row += '\t';
    files::append_number(sample.t_device_s, row);
    row += '\t';
    row += name_of(sample.phase);
    row += '\t';
    files::append_number(level, row);
    row += '\n';
    levels.append(row);
}
void RawFiles::write(const devices::ForceReading& reading) {
    row.clear();
    files::append_number(reading.t_host_s, row);
    for (const double value : {reading.t_device_s, reading.force_N, reading.raw}) {
        row += '\t';
        files::append_number(value, row);
    }
    row += '\n';
    forces.append(row);
}
void RawFiles::sync() {
    if (!levels.sync() || !forces.sync())
        throw std::runtime_error(levels.path().string() + ": can no longer be written; stopped (is the disk full?)");
}

std::filesystem::path points_file(const RecordArguments& arguments) {
    return std::filesystem::path(arguments.folder) / "points.csv";
}

std::unique_ptr<Recording> open_recording(const RecordArguments& arguments) {
    auto recording = std::make_unique<Recording>();
    recording->arguments = arguments;
    const auto lock = [&] {
        if (!recording->lock && std::filesystem::is_directory(arguments.folder))
            recording->lock.emplace(arguments.folder, "another recording into it");
    };
    lock();  // before a sensor that another recording reads is disturbed
    std::unique_ptr<devices::ForceSensor> device = open_sensor(arguments);
    if (!arguments.resume) std::filesystem::create_directories(arguments.folder);
    lock();
    open_session(arguments, recording->session);
    keep_units(arguments);
    recording->resumed = recording->zero_at = recording->session.points.size();
    recording->knowledge = knowledge_of(arguments.options, recording->session.points);
    recording->raw.emplace(arguments.folder);
    if (device) recording->sensor = std::make_unique<devices::SensorReader>(std::move(device));
    recording->began_s = recording->synced_s = devices::steady_s();
    return recording;
}

bool step(const std::vector<platform::Sample>& samples, Recording& recording) {
    take_levels(samples, recording);
    const std::size_t had = recording.session.points.size();
    const double now_s = devices::steady_s();
    if (recording.sensor) {
        take_forces(recording);
        capture(recording.arguments.options, now_s, recording.session);
    }
    if (recording.session.points.size() > had) save_points(recording);
    if (now_s - recording.synced_s > 1.0) {
        recording.raw->sync();
        recording.synced_s = now_s;
    }
    watch_sensor(now_s, recording);
    const double limit_s = recording.arguments.seconds;
    return !enough(recording) && !(limit_s > 0.0 && now_s - recording.began_s > limit_s);
}

bool take_typed_N(double force_N, Recording& recording) {
    const RecordOptions& options = recording.arguments.options;
    const double now_s = devices::steady_s();
    const double shown = recording.arguments.newton ? force_N : force_N / kN_per_gf;
    recording.raw->write(devices::ForceReading{now_s, platform::kMissing, force_N, shown});
    for (const double ago : {0.95, 0.7, 0.45, 0.2})
        take_force(options, now_s - ago * options.steady_s, force_N, recording.session);
    if (!capture(options, now_s, recording.session)) return false;
    save_points(recording);
    return true;
}

void drop_last_point(Recording& recording) {
    RecordSession& session = recording.session;
    if (session.points.empty()) return;
    session.points.pop_back();
    session.last_level = platform::kMissing;  // the same place may be captured again
    if (recording.known_repeats >= 0) recording.knowledge = knowledge_of(recording.arguments.options, session.points);
    save_points(recording);
}

std::string advice(const Recording& recording) {
    const RecordOptions& options = recording.arguments.options;
    if (recording.silent) return "the sensor is silent";
    if (recording.invalid) return "the sensor is overloaded";
    if (recording.sensor && std::isnan(recording.session.zero_N)) return "do not touch (zero)";
    if (pulls(recording)) return "the force falls: wrong sign";
    if (recording.without_level > 0 && !recording.knows_level)
        return std::string("this device reports no ") + name_of(recording.arguments.level.level);
    const int band = target_band(options, recording.session, recording.knowledge.band_error);
    if (band < 0) return "lift the pen";
    return "press to " + files::short_number(100.0 * band / options.bands) + " - " +
           files::short_number(100.0 * (band + 1) / options.bands) + " %";
}

files::Json close_recording(Recording& recording) {
    if (recording.sensor) take_forces(recording);
    recording.raw->sync();
    save_points(recording);
    return result_of(recording);
}

}  // namespace palpa::calibration
