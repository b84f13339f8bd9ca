// A browser drives no arm and no pins.

#include "app/live/tactile_driver.h"

namespace palpa::app {

struct TactileDriver::Impl {};

bool drives_devices(const scene::Scene&) { return false; }
std::vector<std::string> missing_devices(const scene::Scene&) { return {}; }

TactileDriver::TactileDriver(const scene::Scene&, std::shared_ptr<const scene::Plan>, const DriverOptions&) {}
TactileDriver::~TactileDriver() = default;

bool TactileDriver::ready() { return false; }
void TactileDriver::hand_over(const scene::State&) {}
bool TactileDriver::latest(session::TactileMoment&) { return false; }
void TactileDriver::stop() {}
void TactileDriver::release() {}
std::vector<session::TactileDevice> TactileDriver::devices() const { return {}; }
files::Json TactileDriver::report() const { return {}; }

}  // namespace palpa::app
