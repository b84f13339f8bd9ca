#pragma once
// Opens the devices of a trial in a thread of its own, which takes a second or more, and closes them. Not for browsers.

#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "scene/state.h"
#include "session/device_rows.h"

namespace palpa::app {

// `Opened` drives devices from its constructor to its destructor.
template <class Opened>
class DeviceOpener {
  public:
    // make() returns a std::unique_ptr<Opened>, or throws.
    template <class Make>
    explicit DeviceOpener(Make make) {
        thread_ = std::thread([make = std::move(make), &opened = opened_, closed = closing_.get_future()] {
            try {
                opened.set_value(make());
            } catch (...) {
                opened.set_exception(std::current_exception());
            }
            closed.wait();
        });
    }
    ~DeviceOpener() {
        try {
            if (opening_.valid()) live = opening_.get();
        } catch (const std::exception&) {
            // nothing was opened, and nobody waits for it any more
        }
        live.reset();
        closing_.set_value();
        thread_.join();
    }
    DeviceOpener(const DeviceOpener&) = delete;
    DeviceOpener& operator=(const DeviceOpener&) = delete;

    // True once `live` is there. Throws what make() threw; no further call is meant then.
    bool ready() {
        if (!live && opening_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) live = opening_.get();
        return live != nullptr;
    }

    std::unique_ptr<Opened> live;  // null until the devices are open

  private:
    std::promise<std::unique_ptr<Opened>> opened_;
    std::future<std::unique_ptr<Opened>> opening_ = opened_.get_future();
    std::promise<void> closing_;
    // Opens the devices, and stays: the system ends simulators together with the thread that started them.
    std::thread thread_;
};

// The touch on the screen, as a loop takes it over.
inline session::PenContact pen_contact(const scene::State& state) {
    session::PenContact pen;
    pen.time_s = state.contact.time_s;
    pen.x_m = state.touch.p_m.x();
    pen.y_m = state.touch.p_m.y();
    pen.depth_m = state.contact.depth_m;
    pen.normal_N = state.touch.down ? state.touch.force_N : 0.0;
    pen.tangential_N = state.contact.tangential_N;
    pen.down = state.touch.down ? 1.0 : 0.0;
    return pen;
}

}  // namespace palpa::app
