#pragma once
// One reading of a pointing device, as it arrived. Everything else is computed from this struct; a recorded trace is a
// list of samples (platform/trace.h).

#include <cstdint>
#include <limits>
#include <string_view>

namespace palpa::platform {

// A number that the device did not report. Written as "n/a" in files.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

enum class Tool : std::uint8_t { pen, finger, mouse, keyboard };
inline constexpr int kToolCount = 4;
enum class Phase : std::uint8_t { hover, down, move, up, cancel, ui };

// What a person asked of the program between samples; only samples of phase `ui` carry an action.
//   resize        x_px, y_px, width_px, height_px hold the part of the window that the tissue has now, so that a replay
//                 maps positions in the same way
//   mark          x_px, y_px hold the position of the mark
//   confidence_*  how sure the person is of the last mark
//   hidden, shown the window went out of sight, or came back; nothing is sampled in between
//   pause, resume the person stopped the trial's clock, or let it run again; nothing is palpated in between
enum class Action : std::uint8_t {
    none,
    resize,
    mark,
    undo,
    finish,
    confidence_1,
    confidence_2,
    confidence_3,
    confidence_4,
    confidence_5,
    hidden,
    shown,
    pause,
    resume,
    method  // the next method of the tissue
};

struct Sample {
    double t_host_s = 0.0;         // steady clock of the host, stamped on arrival
    double t_device_s = kMissing;  // the device's (or X server's) own clock, wrap-arounds undone
    std::int64_t pointer_id = 0;   // tells fingers and pens apart while they touch
    Tool tool = Tool::mouse;
    Phase phase = Phase::hover;
    double x_px = 0.0;               // from the left edge of the window's drawing area
    double y_px = 0.0;               // from its top edge, downwards
    double pressure = kMissing;      // 0..1 over the device's range; above 1 on some tablets
    double pressure_raw = kMissing;  // counts, as the device reports them
    double tilt_x_deg = kMissing;
    double tilt_y_deg = kMissing;
    double width_px = kMissing;  // contact ellipse
    double height_px = kMissing;
    Action action = Action::none;
};

// Names in traces and logs. parse_name() returns false and leaves `out` as it is for an unknown name.
std::string_view name_of(Tool tool);
std::string_view name_of(Phase phase);
std::string_view name_of(Action action);
bool parse_name(std::string_view name, Tool& out);
bool parse_name(std::string_view name, Phase& out);
bool parse_name(std::string_view name, Action& out);

}  // namespace palpa::platform
