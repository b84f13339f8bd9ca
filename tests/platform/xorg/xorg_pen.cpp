// Plays a script of pen, finger, mouse and keyboard on the X server of with-xorg (1280 x 800 px), in real time:
//
//   xorg_pen [SCRIPT.tsv [START_S]]   stdin without a file; t_s = 0 is START_S of the steady clock (now if absent); devices from XORG_PEN, XORG_TOUCH, XORG_MOUSE, XORG_KEYBOARD
//   xorg_pen --disable NAME    as if the device (pen, touch, mouse) were unplugged; --enable: plugged in
//   again
//
// The script has one header line and columns separated by tabs, sorted by time:
//
//   t_s  kind  id  phase  x_px  y_px  pressure
//
// A row `t_s wait FILE [TEXT]` holds up all rows after it until FILE is there, with TEXT in it, for 100 s at most: a
// person waits for the screen.
// kind: pen | touch | mouse | key. id: of the touch, of the key its keycode on this server (65 space, 100 left,
// 102 right, 98 up, 104 down, 99 and 105 page up and down, 50 shift, 36 enter, 9 escape, 23 tab, 97 home, 103 end;
// others: 10..19 digits 1..0, 24..33 Q..P, 38..46 A..L, 52..58 Z..M; down and up only), else 0. phase: hover | down | move | up, for the mouse also
// wheel (pressure = notches). pressure: 0..1 of the device's range. A mouse moves by counts: its first row
// starts by pushing it into the screen's top left corner. At the end it prints how many events it sent, in
// which time, and by how much it was late at most.

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/extensions/XInput2.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/platform/xorg/inputtest.h"

namespace palpa::xorg {
namespace {

constexpr double kScreenWidth_px = 1280.0;
constexpr double kScreenHeight_px = 800.0;
constexpr double kAxisCounts = 65536.0;  // 0..65535 across the screen
constexpr double kPenCounts = 1000.0;    // full pressure
constexpr double kTouchCounts = 2047.0;  // full pressure
constexpr int kPressureAxis = 4;

struct Row {
    double t_s = 0.0;
    std::string kind;
    int id = 0;
    std::string phase;
    double x_px = 0.0;
    double y_px = 0.0;
    double pressure = 0.0;
    std::string file;  // of wait
    std::string text;  // of wait; empty: the file need only be there
};

constexpr double kLongestWait_s = 100.0;

struct Devices {
    std::unique_ptr<InputDevice> pen, touch, mouse, keyboard;
    bool pen_near = false;
    int mouse_x_px = 0;
    int mouse_y_px = 0;
};

std::vector<Row> read_script(std::istream& in) {
    std::vector<Row> rows;
    std::string line;
    std::getline(in, line);
    for (int number = 2; std::getline(in, line); ++number) {
        if (line.empty()) continue;
        std::istringstream fields(line);
        Row row;
        fields >> row.t_s >> row.kind;
        if (row.kind == "wait")
            fields >> row.file;
        else
            fields >> row.id >> row.phase >> row.x_px >> row.y_px >> row.pressure;
        if (!fields)
            throw std::runtime_error("script, line " + std::to_string(number) + ": want 7 columns, 3 or 4 of wait");
        if (row.kind == "wait" && fields.get() == '\t') std::getline(fields, row.text);
        rows.push_back(row);
    }
    return rows;
}

InputDevice& device(std::unique_ptr<InputDevice>& slot, const char* variable) {
    if (!slot) {
        const char* path = std::getenv(variable);
        if (path == nullptr) throw std::runtime_error(std::string(variable) + " is not set (use with-xorg)");
        slot = std::make_unique<InputDevice>(path);
    }
    return *slot;
}

double x_counts(const Row& row) { return row.x_px / kScreenWidth_px * kAxisCounts; }
double y_counts(const Row& row) { return row.y_px / kScreenHeight_px * kAxisCounts; }

void play_pen(const Row& row, Devices& devices) {
    InputDevice& pen = device(devices.pen, "XORG_PEN");
    const double x = x_counts(row), y = y_counts(row), p = row.pressure * kPenCounts;
    const Axes axes{{0, x}, {1, y}, {kPressureAxis, p}};
    if (!devices.pen_near) {
        pen.proximity(true, axes);
        devices.pen_near = true;
    }
    if (row.phase == "hover" || row.phase == "move") {
        pen.move_to(axes);
    } else {
        pen.button(1, row.phase == "down", axes);
    }
    pen.sync();
}

void play_touch(const Row& row, Devices& devices) {
    InputDevice& touch = device(devices.touch, "XORG_TOUCH");
    const auto what = row.phase == "down"   ? InputDevice::Touch::begin
                      : row.phase == "move" ? InputDevice::Touch::update
                                            : InputDevice::Touch::end;
    touch.touch(static_cast<std::uint32_t>(row.id), what,
                {{0, x_counts(row)}, {1, y_counts(row)}, {kPressureAxis, row.pressure * kTouchCounts}});
    touch.sync();
}

void move_mouse(InputDevice& mouse, const Row& row, Devices& devices) {
    const int x_px = static_cast<int>(row.x_px), y_px = static_cast<int>(row.y_px);
    const int dx = x_px - devices.mouse_x_px, dy = y_px - devices.mouse_y_px;
    if (dx != 0 || dy != 0) mouse.move_by({{0, dx}, {1, dy}});
    devices.mouse_x_px = x_px;
    devices.mouse_y_px = y_px;
}

void play_mouse(const Row& row, Devices& devices) {
    const bool first = !devices.mouse;
    InputDevice& mouse = device(devices.mouse, "XORG_MOUSE");
    if (first) {
        mouse.move_by({{0, -2.0 * kScreenWidth_px}, {1, -2.0 * kScreenHeight_px}});
        mouse.sync();
    }
    move_mouse(mouse, row, devices);
    if (row.phase == "down" || row.phase == "up") mouse.button(1, row.phase == "down", {});
    if (row.phase == "wheel") {
        const int number = row.pressure > 0.0 ? 4 : 5;
        for (int i = 0; i < static_cast<int>(std::abs(row.pressure)); ++i) {
            mouse.button(number, true, {});
            mouse.button(number, false, {});
        }
    }
    mouse.sync();
}

void play_key(const Row& row, Devices& devices) {
    InputDevice& keyboard = device(devices.keyboard, "XORG_KEYBOARD");
    keyboard.key(row.id, row.phase == "down");
    keyboard.sync();
}

void play(const Row& row, Devices& devices) {
    if (row.kind == "pen") return play_pen(row, devices);
    if (row.kind == "touch") return play_touch(row, devices);
    if (row.kind == "mouse") return play_mouse(row, devices);
    if (row.kind == "key") return play_key(row, devices);
    throw std::runtime_error("script: kind is " + row.kind + ", want pen, touch, mouse or key");
}

bool holds(const std::string& file, const std::string& text) {
    std::ifstream in(file);
    std::ostringstream all;
    all << in.rdbuf();
    return in.is_open() && all.str().find(text) != std::string::npos;
}

void wait_for(const Row& row) {
    for (double waited_s = 0.0; !holds(row.file, row.text); waited_s += 0.02) {
        if (waited_s > kLongestWait_s) throw std::runtime_error(row.file + ": no " + row.text + " within 100 s");
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

// start_s: when t_s = 0 is, on the steady clock; 0: now.
void run(std::istream& in, double start_s) {
    using Clock = std::chrono::steady_clock;
    const auto seconds = [](double s) {
        return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
    };
    const std::vector<Row> rows = read_script(in);
    Devices devices;
    double late_s = 0.0;
    auto start = start_s > 0.0 ? Clock::time_point(seconds(start_s)) : Clock::now();
    for (const Row& row : rows) {
        const auto due = start + seconds(row.t_s);
        std::this_thread::sleep_until(due);
        if (row.kind == "wait") {
            const auto waits = Clock::now();
            wait_for(row);
            start += Clock::now() - waits;
            continue;
        }
        late_s = std::max(late_s, std::chrono::duration<double>(Clock::now() - due).count());
        play(row, devices);
    }
    const double took_s = std::chrono::duration<double>(Clock::now() - start).count();
    std::fprintf(stderr, "xorg_pen: %zu events in %.3f s, late by %.1f ms at most\n", rows.size(), took_s,
                 1e3 * late_s);
}

int device_id(Display* display, const std::string& name) {
    int count = 0, id = -1;
    XIDeviceInfo* devices = XIQueryDevice(display, XIAllDevices, &count);
    for (int i = 0; i < count; ++i) {
        if (devices[i].name == name) id = devices[i].deviceid;
    }
    XIFreeDeviceInfo(devices);
    if (id < 0) throw std::runtime_error("no device " + name);
    return id;
}

void set_enabled(const std::string& name, unsigned char enabled) {
    Display* display = XOpenDisplay(nullptr);
    if (display == nullptr) throw std::runtime_error("no X server at DISPLAY");
    const Atom property = XInternAtom(display, "Device Enabled", False);
    XIChangeProperty(display, device_id(display, name), property, XA_INTEGER, 8, XIPropModeReplace, &enabled, 1);
    XCloseDisplay(display);
}

}  // namespace
}  // namespace palpa::xorg

int main(int argc, char** argv) {
    try {
        const std::string first = argc > 1 ? argv[1] : "";
        const bool switches = first == "--disable" || first == "--enable";
        if (argc > 3 || (switches && argc != 3)) {
            throw std::runtime_error("usage: xorg_pen [SCRIPT.tsv [START_S]] | --disable NAME | --enable NAME");
        }
        if (switches) {
            palpa::xorg::set_enabled(argv[2], first == "--enable" ? 1 : 0);
            return 0;
        }
        std::ifstream file;
        if (argc >= 2) {
            file.open(argv[1]);
            if (!file) throw std::runtime_error(std::string(argv[1]) + ": cannot be read");
        }
        palpa::xorg::run(argc >= 2 ? file : std::cin, argc == 3 ? std::stod(argv[2]) : 0.0);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "xorg_pen: %s\n", error.what());
        return 1;
    }
    return 0;
}
