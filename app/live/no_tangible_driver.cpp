// Browsers drive no soft device, nor does a build without PALPA_TANGIBLE.

#include "app/live/tangible_driver.h"
#include "app/screens/words.h"
#include "files/input_error.h"

namespace palpa::app {

struct TangibleDriver::Impl {};

std::vector<std::string> missing_soft_device(const scene::Scene& scene) {
    if (!scene.tangible) return {};
    return {words::kNoSoftDevices};
}

TangibleDriver::TangibleDriver(const scene::Scene& scene, std::shared_ptr<const scene::Plan>, const DriverOptions&) {
    throw files::InputError(scene.file.string() + ": tangible: " + words::kNoSoftDevices);
}
TangibleDriver::~TangibleDriver() = default;

bool TangibleDriver::ready() { return false; }
void TangibleDriver::hand_over(const scene::State&) {}
bool TangibleDriver::latest(session::TangibleMoment&) { return false; }
bool TangibleDriver::latest(session::TangibleShape&) { return false; }
session::TangibleBody TangibleDriver::body() const { return {}; }
void TangibleDriver::stop() {}
void TangibleDriver::release() {}
std::vector<session::TactileDevice> TangibleDriver::devices() const { return {}; }
files::Json TangibleDriver::report() const { return {}; }

}  // namespace palpa::app
