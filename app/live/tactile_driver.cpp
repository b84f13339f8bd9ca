#include "app/live/tactile_driver.h"

#include <chrono>
#include <exception>
#include <future>
#include <thread>

#include "session/tactile_run.h"

namespace palpa::app {

struct TactileDriver::Impl {
    std::unique_ptr<session::TactileLive> live;  // null until the devices are open
    std::promise<std::unique_ptr<session::TactileLive>> opened;
    std::future<std::unique_ptr<session::TactileLive>> opening = opened.get_future();
    std::promise<void> closing;
    // Opens the devices, and stays: the system ends simulators together with the thread that started them.
    std::thread opener;
};

bool drives_devices(const scene::Scene& scene) {
    if (!scene.tactile) return false;
    const scene::TactileOptions& tactile = *scene.tactile;
    return (tactile.arm && !tactile.arm->device.empty()) || (tactile.display && !tactile.display->device.empty());
}

std::vector<std::string> missing_devices(const scene::Scene& scene) {
    if (!drives_devices(scene)) return {};
    return session::missing_ports(*scene.tactile);
}

TactileDriver::TactileDriver(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan,
                             const TactileDriverOptions& options) {
    session::TactileLiveOptions live;
    live.simulate = options.simulate;
    live.rows = options.rows;
    impl_ = std::make_unique<Impl>();
    impl_->opener = std::thread([scene, plan, live, &opened = impl_->opened, closed = impl_->closing.get_future()] {
        try {
            opened.set_value(std::make_unique<session::TactileLive>(scene, plan, live));
        } catch (...) {
            opened.set_exception(std::current_exception());
        }
        closed.wait();
    });
}

TactileDriver::~TactileDriver() {
    try {
        if (impl_->opening.valid()) impl_->live = impl_->opening.get();
    } catch (const std::exception&) {
        // nothing was opened, and nobody waits for it any more
    }
    impl_->live.reset();
    impl_->closing.set_value();
    impl_->opener.join();
}

bool TactileDriver::ready() {
    if (!impl_->live && impl_->opening.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        impl_->live = impl_->opening.get();
    return impl_->live != nullptr;
}

void TactileDriver::hand_over(const scene::State& state) {
    if (!impl_->live) return;
    session::PenContact pen;
    pen.time_s = state.contact.time_s;
    pen.x_m = state.touch.p_m.x();
    pen.y_m = state.touch.p_m.y();
    pen.depth_m = state.contact.depth_m;
    pen.normal_N = state.touch.down ? state.touch.force_N : 0.0;
    pen.tangential_N = state.contact.tangential_N;
    pen.down = state.touch.down ? 1.0 : 0.0;
    impl_->live->hand_over(pen);
}

bool TactileDriver::latest(session::TactileMoment& moment) { return impl_->live && impl_->live->latest(moment); }
void TactileDriver::stop() {
    if (impl_->live) impl_->live->stop();
}
void TactileDriver::release() {
    if (impl_->live) impl_->live->restart();
}
std::vector<session::TactileDevice> TactileDriver::devices() const {
    return impl_->live ? impl_->live->devices() : std::vector<session::TactileDevice>{};
}
files::Json TactileDriver::report() const { return impl_->live ? impl_->live->report() : files::Json(); }

}  // namespace palpa::app
