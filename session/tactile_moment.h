#pragma once
// What the loop of a force arm and a shape display shows of itself: the latest moment for the screens, and which
// devices take part. Nothing here knows the loop, so that screens and the web build need no more than this.

#include <array>
#include <cstdint>
#include <limits>
#include <string>

namespace palpa::session {

// Where the heights that the pins reached come from. A servo reports nothing, so without a simulator they are an
// estimate.
enum class ReachedBy : std::uint8_t { nothing, estimate, simulator };

struct TactileMoment {
    static constexpr std::size_t kMostPins = 144;
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    double time_s = 0.0;  // on the loop's clock
    double x_m = 0.0;     // place on the tissue
    double y_m = 0.0;
    double depth_m = 0.0;     // of the finger's bone into the tissue, work-conjugate mean
    double force_N = 0.0;     // rendered against the press
    double sensor_N = kNone;  // between arm and display; NaN without a sensor
    bool arm = false;         // an arm takes part

    std::int32_t rows = 0;  // of pins; 0 without a shape display
    std::int32_t columns = 0;
    double stroke_m = 0.0;
    std::array<double, kMostPins>
        wanted_m{};  // rows x columns, row by row from the lowest y; 0 = lowest, stroke_m = top
    std::array<double, kMostPins> reached_m{};
    ReachedBy reached = ReachedBy::nothing;
    double mismatch_m = kNone;  // rms between wanted and reached at this moment
    double mismatch_s = kNone;  // how long the reached heights are behind the wanted ones
    double shape_scale = 1.0;   // below 1: the shape is scaled into the stroke
    std::int32_t clipped = 0;   // pins at an end of their stroke that should be beyond it

    double linearity = 0.0;  // mechanics/linear_range.h: amber above 0.10, red above 0.25
    bool over_edge = false;  // the finger reaches beyond the tissue that is known
    bool held = false;       // above the force limit: force and shape hold
    double force_limit_N = kNone;

    const char* fault = "";                  // static text: why nothing is commanded now; "" if something is
    bool stopped = false;                    // that is F12, or another fault that stays until a person releases it
    double stiffness_delay_N_s_per_m = 0.0;  // stiffness x loop delay; above 8 the arm may begin to swing

    double round_trip_p50_s = kNone;  // of the link
    double round_trip_p99_s = kNone;
    double silent_s = kNone;    // since the arm's last answer; NaN while it answers
    std::int64_t lost = 0;      // packets
    double step_p50_s = kNone;  // of the loop
    double step_p99_s = kNone;
    std::int64_t steps = 0;
    std::int64_t late_steps = 0;
    std::int64_t held_steps = 0;
};

// The force at this moment: none while a fault keeps the devices at rest, whatever was rendered last.
inline double force_now_N(const TactileMoment& moment) {
    return moment.stopped || *moment.fault != '\0' ? 0.0 : moment.force_N;
}

// A device of a run, for logs and screens: every one is called real or simulated.
struct TactileDevice {
    std::string role;  // "arm", "force sensor", "pins"
    std::string name;  // of its device file
    std::string port;  // path, or host:port; empty while it is not open
    bool simulated = false;
};

}  // namespace palpa::session
