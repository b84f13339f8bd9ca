#include "app/commands/map_info.h"

#include "avatar/display_ratio.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"

namespace palpa::app {

files::Json map_info(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field) {
    files::Json json = stiffnessmaps::map_json(map);
    json["shape"] = {map.n_depths(), map.n_y, map.n_x};
    json["missing"] = stiffnessmaps::missing_count(map);
    const stiffnessmaps::ForceRange range = stiffnessmaps::force_range(map);
    json["force_range_N"] = {range.lowest_N, range.highest_N};
    json["changed_by_isotonic_regression"] = field.isotonic_changed;
    const avatar::DisplayRatio law = avatar::display_ratio_clear();
    const double noise_N = stiffnessmaps::normal_noise_N(map);
    json["noise_N"] = stiffnessmaps::knows_noise(map) ? files::Json(noise_N) : files::Json();
    json["smoothing_mm"] = 1e3 * default_smoothing_m(map, noise_N, law.path.reference_m, law.gate_N);
    if (map.tangential == stiffnessmaps::TangentialKind::recorded) {
        const stiffnessmaps::TangentialAgreement agreement = stiffnessmaps::tangential_agreement(map, field);
        json["tangential_against_energy"] = {
            {"correlation", agreement.correlation}, {"slope", agreement.slope}, {"n", agreement.n}};
    }
    return json;
}

}  // namespace palpa::app
