#include "app/live/tangible_driver.h"

#include "app/live/device_opener.h"
#include "session/tangible_run.h"

namespace palpa::app {

struct TangibleDriver::Impl : DeviceOpener<session::TangibleLive> {
    using DeviceOpener::DeviceOpener;
};

std::vector<std::string> missing_soft_device(const scene::Scene& scene) {
    return scene.tangible ? session::missing_tangible_ports(*scene.tangible) : std::vector<std::string>{};
}

TangibleDriver::TangibleDriver(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan,
                               const DriverOptions& options) {
    session::TangibleLiveOptions live;
    live.simulate = options.simulate;
    live.rows = options.rows;
    impl_ = std::make_unique<Impl>(
        [scene, plan, live] { return std::make_unique<session::TangibleLive>(scene, plan, live); });
}

TangibleDriver::~TangibleDriver() = default;

bool TangibleDriver::ready() { return impl_->ready(); }
void TangibleDriver::hand_over(const scene::State& state) {
    if (impl_->live) impl_->live->hand_over(pen_contact(state));
}
bool TangibleDriver::latest(session::TangibleMoment& moment) { return impl_->live && impl_->live->latest(moment); }
bool TangibleDriver::latest(session::TangibleShape& shape) { return impl_->live && impl_->live->latest(shape); }
session::TangibleBody TangibleDriver::body() const {
    return impl_->live ? impl_->live->body() : session::TangibleBody{};
}
void TangibleDriver::stop() {
    if (impl_->live) impl_->live->stop();
}
void TangibleDriver::release() {
    if (impl_->live) impl_->live->restart();
}
std::vector<session::TactileDevice> TangibleDriver::devices() const {
    return impl_->live ? impl_->live->devices() : std::vector<session::TactileDevice>{};
}
files::Json TangibleDriver::report() const { return impl_->live ? impl_->live->report() : files::Json(); }

}  // namespace palpa::app
