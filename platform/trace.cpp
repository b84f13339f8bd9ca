#include "platform/trace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "files/input_error.h"
#include "files/json.h"
#include "files/regular_file.h"
#include "files/table.h"
#include "files/text.h"
#include "platform/keyboard.h"

namespace palpa::platform {
namespace {

// The keyboard's pointer number in older traces.
constexpr std::int64_t kOldKeyboardId = std::numeric_limits<std::int64_t>::min();

// One list of the columns serves to write the header and every row, and to read them back.
template <class Visit>
void visit_fields(Sample& s, Visit&& visit) {
    visit("t_host_s", s.t_host_s);
    visit("t_device_s", s.t_device_s);
    visit("pointer_id", s.pointer_id);
    visit("tool", s.tool);
    visit("phase", s.phase);
    visit("x_px", s.x_px);
    visit("y_px", s.y_px);
    visit("pressure", s.pressure);
    visit("pressure_raw", s.pressure_raw);
    visit("tilt_x_deg", s.tilt_x_deg);
    visit("tilt_y_deg", s.tilt_y_deg);
    visit("width_px", s.width_px);
    visit("height_px", s.height_px);
    visit("action", s.action);
}

void append_field(double value, std::string& row) { files::append_number(value, row); }
void append_field(std::int64_t value, std::string& row) { row.append(std::to_string(value)); }
template <class Name>
void append_field(Name value, std::string& row) {
    row.append(name_of(value));
}

void read_field(const files::Table& table, std::size_t column, double& out) { out = table.number(column); }
void read_field(const files::Table& table, std::size_t column, std::int64_t& out) {
    const double value = table.finite_number(column);
    // a power of two, so double holds it exactly
    const bool old_keyboard = value == static_cast<double>(kOldKeyboardId);
    if (!old_keyboard && (value != std::floor(value) || std::abs(value) > 9e15)) table.fail(column, "a whole number");
    out = static_cast<std::int64_t>(value);
}
template <class Name>
void read_field(const files::Table& table, std::size_t column, Name& out) {
    if (!parse_name(table.field(column), out)) table.fail(column, "one of the names in docs/formats.md");
}

std::filesystem::path sidecar_of(const std::filesystem::path& tsv) {
    std::filesystem::path json = tsv;
    return json.replace_extension(".json");
}

const std::filesystem::path& checked_name(const std::filesystem::path& tsv) {
    if (tsv.extension() != ".tsv") throw files::bad_input(tsv.string(), "", "another ending", "a new trace NAME.tsv");
    files::check_new(tsv);
    files::check_new(sidecar_of(tsv));
    return tsv;
}

// True for a name that can be part of a file's name.
bool is_loop_name(std::string_view name) {
    const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
    return !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), plain);
}

std::vector<std::string> read_loops(files::JsonReader& json) {
    std::vector<std::string> loops;
    if (!json.has("device_loops")) return loops;
    const files::Json& list = json.any("device_loops");
    constexpr std::string_view kWanted = "a list of different names of a-z, 0-9 and -";
    if (!list.is_array()) json.fail("device_loops", files::described(list), kWanted);
    for (const files::Json& entry : list) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : "";
        if (!is_loop_name(name) || std::find(loops.begin(), loops.end(), name) != loops.end())
            json.fail("device_loops", files::described(entry), kWanted);
        loops.push_back(name);
    }
    return loops;
}

// Reads what the sidecar says of the recorded trial, if anything.
void read_trial(files::JsonReader& json, TraceInfo& info) {
    constexpr files::Bounds kOffset_mm{0.0, 1000.0};
    if (json.has("mode")) info.mode = json.choice("mode", {"practice", "test"}) == 0 ? "practice" : "test";
    info.finger_offset_mm = json.number("finger_offset_mm", kOffset_mm, 0.0);
    for (files::JsonReader& part : json.objects("parts")) {
        info.parts.push_back({part.text("file"), part.text("sha256")});
        part.finish();
    }
    auto mapping = json.optional_object("mapping");
    if (!mapping) return;
    TissueTurn turn;
    turn.rotate_deg = mapping->integer("rotate_deg", 0, 270);
    if (turn.rotate_deg % 90 != 0) mapping->fail("rotate_deg", std::to_string(turn.rotate_deg), "0, 90, 180 or 270");
    turn.flip = mapping->boolean("flip", false);
    mapping->finish();
    info.turn = turn;
}

TraceInfo read_info(const std::filesystem::path& path) {
    const files::Json root = files::read_json(path);
    files::JsonReader json(root, path.string());
    json.only({"screen_px", "screen_mm", "device", "device_loops", "mode", "finger_offset_mm", "mapping", "parts"});
    constexpr files::Bounds kScreen{1.0, 16384.0};
    TraceInfo info;
    const auto size_px = json.numbers("screen_px", 2, kScreen);
    info.screen_width_px = size_px[0];
    info.screen_height_px = size_px[1];
    if (json.has("screen_mm")) {
        const auto size_mm = json.numbers("screen_mm", 2, kScreen);
        info.screen_width_mm = size_mm[0];
        info.screen_height_mm = size_mm[1];
    }
    info.device = json.text("device", "n/a");
    info.device_loops = read_loops(json);
    read_trial(json, info);
    json.finish();
    return info;
}

files::Json info_json(const TraceInfo& info) {
    files::Json json;
    json["screen_px"] = {info.screen_width_px, info.screen_height_px};
    if (!std::isnan(info.screen_width_mm)) json["screen_mm"] = {info.screen_width_mm, info.screen_height_mm};
    json["device"] = info.device;
    if (!info.device_loops.empty()) json["device_loops"] = info.device_loops;
    if (!info.mode.empty()) json["mode"] = info.mode;
    if (info.finger_offset_mm != 0.0) json["finger_offset_mm"] = info.finger_offset_mm;
    if (info.turn) json["mapping"] = {{"rotate_deg", info.turn->rotate_deg}, {"flip", info.turn->flip}};
    for (const TracedPart& part : info.parts) json["parts"].push_back({{"file", part.file}, {"sha256", part.sha256}});
    return json;
}

}  // namespace

Trace read_trace(const std::filesystem::path& tsv) {
    Trace trace;
    files::Table table = files::read_tsv(tsv);
    Sample order;
    std::vector<std::size_t> columns;  // before the sidecar, which a table of another kind does not have
    visit_fields(order, [&](std::string_view name, auto&) { columns.push_back(table.column(name)); });
    trace.info = read_info(sidecar_of(tsv));
    while (table.next()) {
        // the first rows tell how many there will be; growing by doubling would take more memory
        constexpr std::size_t kFirst = 1000;
        if (trace.samples.size() == kFirst)
            trace.samples.reserve(static_cast<std::size_t>(1.1 * static_cast<double>(kFirst) / table.done()));
        Sample sample;
        std::size_t i = 0;
        visit_fields(sample, [&](std::string_view, auto& field) { read_field(table, columns[i++], field); });
        if (sample.pointer_id == kOldKeyboardId) sample.pointer_id = kKeyboardPointerId;
        constexpr double kLongest_s = 1e9;
        if (!(std::abs(sample.t_host_s) < kLongest_s)) table.fail(columns[0], "a time on every row, below 1e9 s");
        if (std::abs(sample.t_device_s) > kLongest_s) table.fail(columns[1], "a time below 1e9 s, or n/a");
        trace.samples.push_back(sample);
    }
    if (trace.samples.empty()) throw files::bad_input(tsv.string(), "", "no rows", "at least one sample");
    return trace;
}

TraceWriter::TraceWriter(const std::filesystem::path& tsv, const TraceInfo& info) : file_(checked_name(tsv)) {
    files::AppendFile sidecar(sidecar_of(tsv));  // refuses to overwrite a file
    sidecar.append(files::json_text(info_json(info)));
    if (!sidecar.sync()) throw std::runtime_error(sidecar.path().string() + ": cannot be written to its end");
    Sample any;
    visit_fields(any, [&](std::string_view name, auto&) { row_.append(row_.empty() ? "" : "\t").append(name); });
    file_.append(row_.append("\n"));
}

void TraceWriter::write(const Sample& sample) {
    row_.clear();
    Sample copy = sample;
    visit_fields(copy, [&](std::string_view name, auto& field) {
        if (name != "t_host_s") row_.push_back('\t');
        append_field(field, row_);
    });
    file_.append(row_.append("\n"));
}

}  // namespace palpa::platform
