#pragma once
// The stages that a plan can consist of. Each stage has one or more forms; the table below states what each form costs
// and how large its error is. `palpa explain` and the cost panel show these figures.

#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/path.h"

namespace palpa::scene {

enum class StageId : std::size_t {
    calibration,
    position,
    depth,
    friction,
    tangential,
    display_ratio,
    delay,
    texture_drag,
    surface,
    footprint,
    crease,
    depth_gain
};
inline constexpr std::size_t kStageCount = 12;

const char* name_of(StageId id);

struct Stage {
    StageId id;
    bool per_frame = false;  // runs once per frame instead of once per sample
    std::string fidelity;    // how it is computed here
    std::string error;       // how large its error is, and against what reference
    double cost_us = 0.0;    // median over the shipped trace (`palpa explain --measure`, docs/performance.md)
};

enum class StageForm : std::size_t {
    calibration_fitted,
    calibration_with_points,
    calibration_bare,
    position,
    depth_recorded_map,
    depth_made_map,
    depth_linear,
    depth_linear_coarse,
    depth_linear_too_coarse,
    depth_force_curve,
    depth_soft_block,
    friction_linear,
    depth_part_beam,
    depth_part_voxels,
    depth_part_button,
    tangential_as_recorded,
    tangential_energy,
    tangential_energy_smoothed,
    tangential_linear,
    tangential_part,
    display_ratio_on_map,
    display_ratio_on_linear,
    delay_on_map,
    delay_on_linear,
    texture_drag,
    surface_sphere,
    surface_nodes,
    footprint_ring,
    crease_shadow,
    depth_exaggerated,
};
inline constexpr std::size_t kStageFormCount = static_cast<std::size_t>(StageForm::depth_exaggerated) + 1;

struct StageFigures {
    StageForm form;
    StageId id;
    bool per_frame;
    double cost_us;          // as in Stage
    std::string_view error;  // each {} stands for a figure of the tissue or the profile
};

inline constexpr std::array<StageFigures, kStageFormCount> kStageFigures{{
    {StageForm::calibration_fitted, StageId::calibration, false, 0.03,
     "{} % of the force (median over points left out of the fit)"},
    {StageForm::calibration_with_points, StageId::calibration, false, 0.03, "{} points in the profile"},
    {StageForm::calibration_bare, StageId::calibration, false, 0.03, "not known: the profile brings no points"},
    {StageForm::position, StageId::position, false, 0.05, "exact"},
    {StageForm::depth_recorded_map, StageId::depth, false, 0.09,
     "about {} mN of noise in the map (more where the tissue changes between its places, less where its cells share "
     "recorded ones)"},
    {StageForm::depth_made_map, StageId::depth, false, 0.09,
     "{} % of the greatest force (95th percentile, from twice the pitch)"},
    {StageForm::depth_linear, StageId::depth, false, 15.0,
     "1.3 % of the depth (median, worst 2.4 %) against 1.2 mm on the shipped block at 2 mm; a contact radius below two "
     "spacings is worse"},
    {StageForm::depth_linear_coarse, StageId::depth, false, 15.0,
     "1.3 % of the depth (median, worst 2.4 %) against 1.2 mm on the shipped block at 2 mm; a contact radius below two "
     "spacings is worse; at {} mm the contact's radius spans {} spacings here, fewer where it is shallower"},
    {StageForm::depth_linear_too_coarse, StageId::depth, false, 15.0,
     "not known, the force can be several times too large: even at {} mm the contact's radius spans {} spacings here, "
     "fewer where it is shallower; four are wanted (a smaller spacing_mm)"},
    {StageForm::depth_force_curve, StageId::depth, false, 0.1, "exact"},
    {StageForm::depth_soft_block, StageId::depth, false, 0.1,
     "that of the mesh; a device's loop takes one Newton step of the contact per tick instead"},
    {StageForm::friction_linear, StageId::friction, false, 77.0,  // p99 132
     "tangential force 0.2 % of mu F (median, worst 4 %) against 1.5 mm on the shipped block at 2 mm, raster trace, mu "
     "0.3"},
    {StageForm::depth_part_beam, StageId::depth, false, 0.3,
     "between stations at most {} of the depth; the model's own error: palpa part evaluate"},
    {StageForm::depth_part_voxels, StageId::depth, false, 0.3,
     "{} of the energy (estimate), between stations at most {} of the depth"},
    {StageForm::depth_part_button, StageId::depth, false, 0.2, "1/1,024 of the travel between the points of the table"},
    {StageForm::tangential_as_recorded, StageId::tangential, false, 0.06, "wrong in any other direction than +x"},
    {StageForm::tangential_energy, StageId::tangential, false, 0.06,
     "derived from the normal force (work argument), not measured"},
    {StageForm::tangential_energy_smoothed, StageId::tangential, false, 0.06,
     "derived from the normal force (work argument), not measured; smoothing lowers lag by about a fifth, delay by "
     "about a half"},
    {StageForm::tangential_linear, StageId::tangential, false, 22.0, "detail below one node spacing is averaged away"},
    {StageForm::tangential_part, StageId::tangential, false, 0.1, "that of depth"},
    {StageForm::display_ratio_on_map, StageId::display_ratio, false, 0.5, "0.0002 mm against 5 times as many stations"},
    {StageForm::display_ratio_on_linear, StageId::display_ratio, false, 140.0,
     "0.0002 mm against 5 times as many stations"},
    {StageForm::delay_on_map, StageId::delay, false, 0.4, "exact at the stations"},
    {StageForm::delay_on_linear, StageId::delay, false, 110.0, "exact at the stations"},
    {StageForm::texture_drag, StageId::texture_drag, false, 0.01, "exact: the texture takes what the avatar loses"},
    {StageForm::surface_sphere, StageId::surface, true, 6.0,
     "7 % of the depth at worst against the exact bonded layer (25 mm, depth to 2 mm)"},
    {StageForm::surface_nodes, StageId::surface, true, 13.0, "that of depth"},
    {StageForm::footprint_ring, StageId::footprint, true, 0.03, "drawn on purpose: no part of the tissue"},
    {StageForm::crease_shadow, StageId::crease, true, 0.03, "drawn on purpose: no part of the tissue"},
    {StageForm::depth_exaggerated, StageId::depth_gain, true, 0.03, "drawn {} times as deep as the tissue gives way"},
}};

constexpr bool each_form_stands_at_its_place() {
    for (std::size_t i = 0; i < kStageFigures.size(); ++i)
        if (static_cast<std::size_t>(kStageFigures[i].form) != i) return false;
    return true;
}
static_assert(each_form_stands_at_its_place());

constexpr const StageFigures& figures_of(StageForm form) { return kStageFigures[static_cast<std::size_t>(form)]; }

struct Scene;

// Returns a stage by its row of the table; `figures` replace each {} of the error, in order.
Stage stage_of(StageForm form, std::string fidelity, std::initializer_list<std::string_view> figures = {});

// Appends the stages of the cues whose strength is not 0.
void add_cue_stages(const Scene& scene, std::vector<Stage>& out);

// Appends the stages of the scene's laws and of what follows from them, on a tissue that can answer at `limit` stations of the path.
void add_law_stages(const Scene& scene, const avatar::StationLimit& limit, StageForm display_ratio, StageForm delay,
                    std::vector<Stage>& out);

}  // namespace palpa::scene
