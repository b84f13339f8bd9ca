#pragma once
// A device that a trial drives (arm and pins, or a soft device): the same course for all of them. It opens in a thread of
// its own, follows the trial, stops at F12 whatever screen is open, and rests when the trial ends.
//
// A driver D has: ready(), hand_over(state), stop(), release(), devices(), report(), and what it shows, S, is a DriveState
// with a `moment` that has `fault` and `stopped`.

#include <exception>
#include <memory>
#include <optional>
#include <string_view>

#include "files/json.h"
#include "scene/state.h"

namespace palpa::app {

inline constexpr const char* kStopKey = "F12";

template <class Driver, class What>
struct DeviceControl {
    std::unique_ptr<Driver> driver;       // while a trial drives devices
    std::optional<What> shown;            // nothing: the scene asks for none of them
    std::optional<double> fault_since_s;  // window's clock; a fault lasts since then
    // What a person asked for last, stop or release, until the loop's moments say so too: those from before say the opposite.
    std::optional<bool> asked_to_stop;
    std::optional<double> asked_s;  // when that was first waited for
    files::Json report;             // of the last trial's loop
};

// Shows this from now on. A stop outlives the trial in which it came.
template <class Control, class What>
void show_instead(What next, Control& control) {
    if (control.shown && control.shown->moment.stopped) {
        next.moment.stopped = true;
        next.moment.fault = control.shown->moment.fault;
    }
    control.shown = std::move(next);
}

// True once the device runs, or could not be opened (DriveState::problem), or if there is none. opened(shown) is called
// once it runs.
template <class Control, class Opened>
bool is_ready(Control& control, const Opened& opened) {
    if (!control.driver || control.shown->runs) return true;
    try {
        if (!control.driver->ready()) return false;
    } catch (const std::exception& error) {
        control.driver.reset();
        control.shown->opening = false;
        control.shown->problem = error.what();
        return true;
    }
    control.shown->devices = control.driver->devices();
    opened(*control.shown);
    control.shown->opening = false;
    control.shown->runs = true;
    if (control.shown->moment.stopped) {  // F12 came meanwhile
        control.driver->stop();
        control.asked_to_stop = true;
    }
    return true;
}

template <class Control>
void rest(Control& control) {
    if (!control.driver) return;
    control.report = control.driver->report();
    control.driver.reset();
    control.fault_since_s.reset();
    if (!control.shown) return;
    control.shown->runs = control.shown->opening = false;
    // what the last moment showed of force and shape is over; a stop is not
    auto& moment = control.shown->moment;
    const bool stopped = moment.stopped;
    const char* fault = stopped ? moment.fault : "";
    moment = {};
    moment.stopped = stopped;
    moment.fault = fault;
    if constexpr (requires { control.shown->has_shape; }) control.shown->has_shape = false;
}

// Gives the loop the touch, and takes over its latest moment. Returns true if there is a new one.
template <class Control>
bool follow(double now_s, const scene::State& state, Control& control) {
    constexpr double kAnswers_s = 0.5;  // a loop that is still stopped so long after its release was stopped anew
    auto& moment = control.shown->moment;
    control.driver->hand_over(state);
    const bool fresh = control.driver->latest(moment);
    if (fresh && control.asked_to_stop) {
        if (!control.asked_s) control.asked_s = now_s;
        const bool late = !*control.asked_to_stop && now_s - *control.asked_s > kAnswers_s;
        if (late || moment.stopped == *control.asked_to_stop) {
            control.asked_to_stop.reset();
            control.asked_s.reset();
        } else {
            moment.stopped = *control.asked_to_stop;
            moment.fault = moment.stopped ? kStopKey : "";
        }
    }
    if (std::string_view(moment.fault) == "stopped") moment.fault = kStopKey;  // by whom
    if (*moment.fault == '\0') {
        control.fault_since_s.reset();
    } else if (!control.fault_since_s) {
        control.fault_since_s = now_s;
    }
    return fresh;
}

template <class Control>
void stop(Control& control) {
    if (!control.shown) return;
    if (control.driver) control.driver->stop();
    control.asked_to_stop = true;
    control.asked_s.reset();
    control.shown->moment.stopped = true;
    control.shown->moment.fault = kStopKey;
}

// Returns true if the device was stopped and nothing drives it: it has to be begun anew.
template <class Control>
bool release(Control& control) {
    if (!control.shown || !control.shown->moment.stopped) return false;
    control.shown->moment.stopped = false;
    control.shown->moment.fault = "";
    control.fault_since_s.reset();
    control.asked_to_stop = false;
    control.asked_s.reset();
    if (control.driver) control.driver->release();
    return !control.driver;
}

// The device has stopped, or a fault of it does not pass.
template <class Control>
bool failed(double now_s, const Control& control) {
    constexpr double kPasses_s = 0.5;  // a short silence passes by itself
    if (!control.driver) return false;
    return control.shown->moment.stopped || (control.fault_since_s && now_s - *control.fault_since_s > kPasses_s);
}

}  // namespace palpa::app
