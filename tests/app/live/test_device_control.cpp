// The course of a device beside a trial, with a driver that the test leads.

#include <doctest/doctest.h>
#include <stdexcept>
#include <string>

#include "app/live/device_control.h"
#include "app/screens/device_state.h"

using namespace palpa;
using namespace palpa::app;

namespace {

struct LedMoment {
    double force_N = 0.0;
    const char* fault = "";
    bool stopped = false;
};

struct LedShown : DriveState {
    LedMoment moment;
};

// What the test wants the device to do, and what it was asked for.
struct Led {
    bool ready = true;
    std::string refuses;
    const char* fault = "";
    int stops = 0;
    int releases = 0;
};

struct LedDriver {
    Led& led;
    bool ready() const {
        if (!led.refuses.empty()) throw std::runtime_error(led.refuses);
        return led.ready;
    }
    void hand_over(const scene::State&) const {}
    bool latest(LedMoment& moment) const {
        moment.force_N = 0.8;
        moment.fault = led.fault;
        moment.stopped = std::string(led.fault) == "stopped";
        return true;
    }
    void stop() const {
        ++led.stops;
        led.fault = "stopped";
    }
    void release() const {
        ++led.releases;
        led.fault = "";
    }
    std::vector<session::TactileDevice> devices() const { return {{"motors", "two", "port", true}}; }
    files::Json report() const { return {{"stops", led.stops}}; }
};

using LedControl = DeviceControl<LedDriver, LedShown>;

void open(Led& led, LedControl& control) {
    if (!control.shown) control.shown.emplace();
    control.driver = std::make_unique<LedDriver>(LedDriver{led});
    control.shown->opening = true;
}

// A device that runs, and was stopped by a person.
struct Stopped {
    Stopped() {
        open(led, control);
        CHECK(is_ready(control, [](LedShown&) {}));
        stop(control);
    }
    bool stopped_at(double now_s) {
        follow(now_s, scene::State{}, control);
        return control.shown->moment.stopped;
    }
    Led led;
    LedControl control;
};

bool ready(LedControl& control) {
    return is_ready(control, [](LedShown&) {});
}

}  // namespace

TEST_CASE("device control: F12 holds over trials until it is released, and stops a device that is still opening") {
    Led led;
    led.ready = false;
    LedControl control;
    const scene::State state;
    CHECK(ready(control));  // there is none
    open(led, control);
    CHECK_FALSE(ready(control));
    stop(control);
    led.ready = true;
    CHECK(ready(control));
    CHECK(led.stops == 2);  // once more as it came
    CHECK(control.shown->runs);
    follow(1.0, state, control);
    CHECK(control.shown->moment.stopped);
    CHECK(std::string(control.shown->moment.fault) == kStopKey);  // by whom
    CHECK(failed(1.0, control));
    CHECK(control.shown->moment.force_N == 0.8);
    rest(control);
    CHECK(control.shown->moment.force_N == 0.0);  // the device rests: no force of the last moment is shown any more
    CHECK(control.shown->moment.stopped);
    CHECK(control.report["stops"] == 2);
    show_instead(LedShown{}, control);  // the next trial
    CHECK(control.shown->moment.stopped);
    CHECK(release(control));  // nothing drives it: it has to be begun anew
    CHECK_FALSE(control.shown->moment.stopped);
    CHECK_FALSE(release(control));
    CHECK(led.releases == 0);
}

TEST_CASE(
    "device control: a short fault passes, one that lasts fails the trial, and a device that cannot open says why") {
    Led led;
    LedControl control;
    const scene::State state;
    open(led, control);
    REQUIRE(ready(control));
    led.fault = "silence";
    follow(1.0, state, control);
    follow(1.4, state, control);
    CHECK_FALSE(failed(1.4, control));
    CHECK(failed(1.6, control));
    led.fault = "";
    follow(1.7, state, control);
    CHECK_FALSE(failed(9.0, control));
    rest(control);
    led.refuses = "strip.json: found no port";
    open(led, control);
    CHECK(ready(control));
    CHECK(control.shown->problem == led.refuses);
    CHECK_FALSE(control.driver);
    CHECK_FALSE(control.shown->opening);
}

TEST_CASE("device control: a moment from before the release is no new stop, and one from after it is") {
    Stopped device;
    CHECK(device.stopped_at(1.0));
    release(device.control);
    device.led.fault = "stopped";  // of a tick that the loop had taken before
    CHECK_FALSE(device.stopped_at(1.1));
    CHECK(std::string(device.control.shown->moment.fault).empty());
    device.led.fault = "";
    CHECK_FALSE(device.stopped_at(1.11));
    device.led.fault = "stopped";  // by the guard
    CHECK(device.stopped_at(1.12));
}

TEST_CASE("device control: a device that stays stopped after its release is shown so") {
    Stopped device;
    release(device.control);
    device.led.fault = "stopped";
    CHECK_FALSE(device.stopped_at(1.0));
    CHECK(device.stopped_at(1.6));
}
