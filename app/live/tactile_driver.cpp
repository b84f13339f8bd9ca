#include "app/live/tactile_driver.h"

#include "app/live/device_opener.h"
#include "session/tactile_run.h"

namespace palpa::app {

struct TactileDriver::Impl : DeviceOpener<session::TactileLive> {
    using DeviceOpener::DeviceOpener;
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
                             const DriverOptions& options) {
    session::TactileLiveOptions live;
    live.simulate = options.simulate;
    live.rows = options.rows;
    impl_ = std::make_unique<Impl>(
        [scene, plan, live] { return std::make_unique<session::TactileLive>(scene, plan, live); });
}

TactileDriver::~TactileDriver() = default;

bool TactileDriver::ready() { return impl_->ready(); }
void TactileDriver::hand_over(const scene::State& state) {
    if (impl_->live) impl_->live->hand_over(pen_contact(state));
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
