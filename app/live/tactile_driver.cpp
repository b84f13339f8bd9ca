#include "app/live/tactile_driver.h"

#include "session/tactile_run.h"

namespace palpa::app {

struct TactileDriver::Impl {
    session::TactileLive live;
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
    impl_.reset(new Impl{{scene, std::move(plan), live}});
}
TactileDriver::~TactileDriver() = default;

void TactileDriver::hand_over(const scene::State& state) {
    session::PenContact pen;
    pen.time_s = state.contact.time_s;
    pen.x_m = state.touch.p_m.x();
    pen.y_m = state.touch.p_m.y();
    pen.depth_m = state.contact.depth_m;
    pen.normal_N = state.touch.down ? state.touch.force_N : 0.0;
    pen.tangential_N = state.contact.tangential_N;
    pen.down = state.touch.down ? 1.0 : 0.0;
    impl_->live.hand_over(pen);
}

bool TactileDriver::latest(session::TactileMoment& moment) { return impl_->live.latest(moment); }
void TactileDriver::stop() { impl_->live.stop(); }
void TactileDriver::release() { impl_->live.restart(); }
std::vector<session::TactileDevice> TactileDriver::devices() const { return impl_->live.devices(); }
files::Json TactileDriver::report() const { return impl_->live.report(); }

}  // namespace palpa::app
