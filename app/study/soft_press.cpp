#include "app/study/soft_press.h"

#include "session/tangible_run.h"

namespace palpa::app {

std::vector<study::FeltMoment> press_soft_device(const scene::Scene& scene, const scene::Plan& plan,
                                                 std::span<const devices::PressRow> press, std::uint64_t seed) {
    const session::TangibleRecord record = session::press_tangible(scene, plan, press, seed);
    std::vector<study::FeltMoment> felt;
    for (std::size_t i = 0; i < record.time_s.size(); ++i)
        felt.push_back({record.force_N[i], record.depth_m[i], 0.0, 0.0});
    return felt;
}

}  // namespace palpa::app
