#include "app/commands/map_info.h"

#include "avatar/display_ratio.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"

namespace palpa {

Json map_info(const Map& map, const Field& field) {
    Json json = map_json(map);
    json["shape"] = {map.n_depths(), map.n_y, map.n_x};
    json["missing"] = missing_count(map);
    const ForceRange range = force_range(map);
    json["force_range_N"] = {range.lowest_N, range.highest_N};
    json["not_rising_with_depth"] = field.isotonic_changed;
    const DisplayRatio law = display_ratio_clear();
    const double noise_N = normal_noise_N(map);
    json["noise_N"] = noise_N;
    json["smoothing_mm"] = 1e3 * default_smoothing_m(map, noise_N, law.path.reference_m, law.gate_N);
    if (map.tangential == TangentialKind::recorded) {
        const TangentialAgreement agreement = tangential_agreement(map, field);
        json["tangential_against_energy"] = {
            {"correlation", agreement.correlation}, {"slope", agreement.slope}, {"n", agreement.n}};
    }
    return json;
}

}  // namespace palpa
