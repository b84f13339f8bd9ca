// Device files of shape displays.

#include <algorithm>
#include <cmath>
#include <set>

#include "devices/device_json.h"
#include "files/json.h"
#include "files/text.h"

namespace palpa::devices {
namespace {

using files::Bounds;
using files::JsonReader;

constexpr double kPin_mm = 1e-3;
constexpr int kMostInLine = 12;  // rows or columns

void read_line(JsonReader line, PinDevice& device, MaestroAddress& all) {
    line.only({"port", "baud", "detect_baud", "protocol", "crc", "timeout_ms"});
    device.port = line.text("port");
    device.baud = line.integer("baud", 9600, 1000000, 115200);
    device.detect_baud = line.boolean("detect_baud", true);
    all.chained = !line.has("protocol") || line.choice("protocol", {"pololu", "compact"}) == 0;
    all.crc = line.boolean("crc", true);
    device.timeout_s = 1e-3 * line.number("timeout_ms", {10.0, 655350.0}, 100.0);
    line.finish();
}

void read_grid(JsonReader grid, PinDevice& device) {
    grid.only({"rows", "columns", "pitch_mm", "diameter_mm", "stroke_mm", "step_mm", "speed_mm_per_s", "rest_mm"});
    device.rows = grid.integer("rows", 1, kMostInLine);
    device.columns = grid.integer("columns", 1, kMostInLine);
    device.pitch_m = kPin_mm * grid.number("pitch_mm", {0.1, 100.0}, 2.0);
    device.diameter_m = kPin_mm * grid.number("diameter_mm", {0.1, 100.0}, 1.0);
    device.stroke_m = kPin_mm * grid.number("stroke_mm", {0.1, 100.0}, 2.0);
    device.step_m = kPin_mm * grid.number("step_mm", {0.001, 10.0}, 0.1);
    device.speed_m_per_s = kPin_mm * grid.number("speed_mm_per_s", {1.0, 1000.0}, 30.0);
    device.rest_m = kPin_mm * grid.number("rest_mm", {0.0, device.stroke_m / kPin_mm}, 0.0);
    grid.finish();
}

void read_boards(JsonReader& json, const MaestroAddress& all, PinDevice& device) {
    std::vector<JsonReader> boards = json.objects("boards");
    if (boards.empty() || boards.size() > kMostBoards)
        json.fail("boards", std::to_string(boards.size()), "from 1 to " + std::to_string(kMostBoards) + " boards");
    if (boards.size() > 1 && !all.chained)
        json.fail("boards", std::to_string(boards.size()),
                  "one board, or \"protocol\": \"pololu\": all boards of a chain obey compact commands");
    std::set<int> numbers;
    for (JsonReader& reader : boards) {
        reader.only({"device", "channels"});
        PinBoard board;
        board.address = all;
        board.address.device = reader.integer("device", 0, 127, 12);
        board.channels = reader.integer("channels", 6, kMaestroChannels);
        if (!numbers.insert(board.address.device).second)
            reader.fail("device", std::to_string(board.address.device), "a number that no other board has");
        reader.finish();
        device.boards.push_back(board);
    }
}

PinServo read_servo(JsonReader& reader, PinServo servo) {
    servo.zero_us = reader.number("zero_us", {64.0, 4080.0}, servo.zero_us);
    servo.us_per_mm = reader.number("us_per_mm", {1.0, 10000.0}, servo.us_per_mm);
    servo.direction = reader.integer("direction", -1, 1, static_cast<int>(servo.direction));
    if (servo.direction == 0.0) reader.fail("direction", "0", "1 (a longer pulse is higher) or -1");
    return servo;
}

int board_index(const PinDevice& device, int number) {
    for (std::size_t i = 0; i < device.boards.size(); ++i) {
        if (device.boards[i].address.device == number) return static_cast<int>(i);
    }
    return -1;
}

void check_pulses(const JsonReader& reader, const PinDevice& device, const PinServo& pin) {
    const double top_us = pin.zero_us + pin.direction * pin.us_per_mm * device.stroke_m / kPin_mm;
    for (const double pulse_us : {pin.zero_us, top_us}) {
        if (pulse_us >= device.lowest_us && pulse_us <= device.highest_us) continue;
        reader.fail("zero_us", "a pulse of " + files::short_number(pulse_us) + " us within the stroke",
                    "pulses from " + files::short_number(device.lowest_us) + " to " +
                        files::short_number(device.highest_us) + " us (pulse_us)");
    }
}

void read_pins(JsonReader& json, const PinServo& usual, PinDevice& device) {
    std::vector<JsonReader> pins = json.objects("pins");
    const std::size_t wanted = static_cast<std::size_t>(device.rows * device.columns);
    if (pins.size() != wanted)
        json.fail("pins", std::to_string(pins.size()) + " pins",
                  std::to_string(wanted) + ": rows x columns, row by row");
    std::set<std::pair<int, int>> taken;
    for (JsonReader& reader : pins) {
        reader.only({"board", "channel", "zero_us", "us_per_mm", "direction"});
        PinServo pin = read_servo(reader, usual);
        const int number = reader.integer("board", 0, 127, device.boards.front().address.device);
        pin.board = board_index(device, number);
        if (pin.board < 0) reader.fail("board", std::to_string(number), "the device number of one of the boards");
        const PinBoard& board = device.boards[static_cast<std::size_t>(pin.board)];
        pin.channel = reader.integer("channel", 0, board.channels - 1);
        if (!taken.emplace(pin.board, pin.channel).second)
            reader.fail("channel", std::to_string(pin.channel),
                        "a channel of board " + std::to_string(number) + " that no other pin has");
        check_pulses(reader, device, pin);
        reader.finish();
        device.pins.push_back(pin);
    }
}

// Set Multiple Targets takes a row of channels.
void find_channels(const JsonReader& json, PinDevice& device) {
    for (std::size_t b = 0; b < device.boards.size(); ++b) {
        PinBoard& board = device.boards[b];
        int first = kMaestroChannels, last = -1;
        for (const PinServo& pin : device.pins) {
            if (pin.board != static_cast<int>(b)) continue;
            first = std::min(first, pin.channel);
            last = std::max(last, pin.channel);
            ++board.count;
        }
        board.first = board.count > 0 ? first : 0;
        if (board.count > 0 && last - first + 1 != board.count)
            json.fail("pins", "gaps between the channels of board " + std::to_string(board.address.device),
                      "channels in a row: one command sets them all");
    }
}

// A frame has to be over before the next one begins, and the board's answer has to fit in too.
void check_line(const JsonReader& json, const PinDevice& device) {
    PinFrame frame;
    const std::vector<double> rest_m(device.pins.size(), device.rest_m);
    pin_frame(device, rest_m, frame);
    constexpr double kQuestion_bytes = 7.0, kBits = 10.0;
    const double line_s = (static_cast<double>(frame.size) + kQuestion_bytes) * kBits / device.baud;
    if (line_s <= device.frame_s) return;
    json.fail("frame_ms", files::short_number(1e3 * device.frame_s),
              "at least " + files::short_number(1e3 * line_s) + ", what " + std::to_string(frame.size) +
                  " bytes take at " + std::to_string(device.baud) + " baud");
}

}  // namespace

PinDevice read_pin_device(const std::filesystem::path& path) { return parse_pin_device(files::read_json(path), path); }

PinDevice parse_pin_device(const files::Json& json, const std::filesystem::path& path) {
    JsonReader reader(json, path.string());
    reader.only({"kind", "name", "line", "grid", "pulse_us", "frame_ms", "boards", "servo", "pins"});
    reader.choice("kind", {"pins"});
    PinDevice device;
    device.name = reader.text("name", path.stem().string());
    MaestroAddress all;
    read_line(reader.object("line"), device, all);
    read_grid(reader.object("grid"), device);
    if (reader.has("pulse_us")) {
        const std::vector<double> pulse_us = reader.numbers("pulse_us", 2, {64.0, 4080.0});
        if (pulse_us[0] >= pulse_us[1])
            reader.fail("pulse_us", files::short_number(pulse_us[0]), "less than " + files::short_number(pulse_us[1]));
        device.lowest_us = pulse_us[0];
        device.highest_us = pulse_us[1];
    }
    device.frame_s = 1e-3 * reader.number("frame_ms", {3.0, 100.0}, 20.0);
    read_boards(reader, all, device);
    PinServo usual;
    if (auto servo = reader.optional_object("servo")) {
        servo->only({"zero_us", "us_per_mm", "direction"});
        usual = read_servo(*servo, usual);
        servo->finish();
    }
    read_pins(reader, usual, device);
    reader.finish();
    find_channels(reader, device);
    check_line(reader, device);
    return device;
}

files::Json pin_device_json(const PinDevice& device) {
    const MaestroAddress& first = device.boards.front().address;
    files::Json json{{"kind", "pins"}, {"name", device.name}};
    json["line"] = {{"port", device.port},
                    {"baud", device.baud},
                    {"detect_baud", device.detect_baud},
                    {"protocol", first.chained ? "pololu" : "compact"},
                    {"crc", first.crc},
                    {"timeout_ms", 1e3 * device.timeout_s}};
    json["grid"] = {{"rows", device.rows},
                    {"columns", device.columns},
                    {"pitch_mm", device.pitch_m / kPin_mm},
                    {"diameter_mm", device.diameter_m / kPin_mm},
                    {"stroke_mm", device.stroke_m / kPin_mm},
                    {"step_mm", device.step_m / kPin_mm},
                    {"speed_mm_per_s", device.speed_m_per_s / kPin_mm},
                    {"rest_mm", device.rest_m / kPin_mm}};
    json["pulse_us"] = {device.lowest_us, device.highest_us};
    json["frame_ms"] = 1e3 * device.frame_s;
    json["boards"] = files::Json::array();
    for (const PinBoard& board : device.boards)
        json["boards"].push_back({{"device", board.address.device}, {"channels", board.channels}});
    json["pins"] = files::Json::array();
    for (const PinServo& pin : device.pins) {
        json["pins"].push_back({{"board", device.boards[static_cast<std::size_t>(pin.board)].address.device},
                                {"channel", pin.channel},
                                {"zero_us", pin.zero_us},
                                {"us_per_mm", pin.us_per_mm},
                                {"direction", pin.direction > 0.0 ? 1 : -1}});
    }
    return json;
}

void write_pin_device(const PinDevice& device, const std::filesystem::path& path) {
    files::write_text_atomically(path, files::json_text(pin_device_json(device)));
}

}  // namespace palpa::devices
