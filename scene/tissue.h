#pragma once
// What every tissue answers. A new tissue is an alternative of TissueOptions (scene/scene.h), Tissue and TissueWork,
// and an overload for its own types of each function that every tissue answers; scene/tissue.cpp alone asks which it is.

#include <variant>
#include <vector>

#include "scene/force_curve.h"
#include "scene/linear_tissue.h"
#include "scene/map_tissue.h"
#include "scene/part_tissue.h"
#include "scene/soft_block.h"

namespace palpa::scene {

// Prepared; part of a plan.
using Tissue = std::variant<MapTissue, LinearTissue, PartTissue, ForceCurveTissue, SoftBlockTissue>;
// What a touch changes; part of a state.
using TissueWork = std::variant<MapWork, LinearWork, PartWork, ForceCurveWork, SoftBlockWork>;

// Of a tissue that is asked for:
bool takes_seconds(const TissueOptions& options);  // true if preparing it takes so long that progress must be shown
std::vector<std::filesystem::path> input_files(const TissueOptions& options);
files::Json file_hashes(const TissueOptions& options);           // SHA-256 of its input files, for logs
std::filesystem::path map_folder(const TissueOptions& options);  // empty for a tissue that is not made from a map

// Whether a finger's contact with its surface can be computed. Here, so that the reader of scene files needs no tissue.
inline bool knows_surface(const TissueOptions& options) {
    return std::visit([](const auto& of_kind) { return knows_surface(of_kind); }, options);
}

// Whether a finger's force depends on its depth alone, so that curve_of() the tissue is one.
inline bool is_curve(const TissueOptions& options) {
    return std::holds_alternative<ForceCurveOptions>(options) || std::holds_alternative<SoftBlockOptions>(options);
}

// nullptr for a tissue that is no part
const PartOptions* part_options(const TissueOptions& options);
PartOptions* part_options(TissueOptions& options);
void leave_out_nodules(TissueOptions& options);  // sets `nodules` to false

// Reads or computes the tissue, which may take seconds to minutes: `progress` reports and may cancel. Throws
// InputError, mechanics' errors for a block that cannot be solved, and mechanics::Cancelled.
Tissue prepare(const TissueOptions& options, const Scene& scene, const mechanics::Progress& progress);

// Returns whether a prepared tissue can be used for this scene; see serves() of plans (scene/plan.h).
bool serves(const Tissue& tissue, const Scene& scene);

// Returns the block whose surface a finger can press, or nullptr for a tissue that knows none.
const LinearTissue* block_of(const Tissue& tissue);

// Returns force over depth where that is all the tissue is, or nullptr.
const ForceCurve* curve_of(const Tissue& tissue);

// Return the parts, and what presses them, for pictures; nullptr for a tissue that is none.
const PartTissue* parts_of(const Tissue& tissue);
const PartWork* part_work_of(const TissueWork& work);

// Takes the tissue's next method, unless something presses. Returns its name; nullptr if the tissue stays as it is.
const char* next_method(const Tissue& tissue, TissueWork& work);

// Returns how often buttons went on since the start; nothing for a tissue without buttons.
std::optional<std::int64_t> switch_events(const Tissue& tissue, const TissueWork& work);

// Fills what the plan says about its tissue, from tissue_name on, and adds to its notes.
void describe(const Tissue& tissue, const Scene& scene, Plan& plan);

// Returns the stages that depend on the tissue, in order, those per frame last. For each of depth, friction and
// tangential among them, answer() is called at every sample.
std::vector<Stage> stages(const Tissue& tissue, const Scene& scene);

files::Json identity(const Tissue& tissue);  // what a run's settings say about the tissue besides name and source

TissueWork make_work(const Tissue& tissue);

// Fills the part of the contact that belongs to the stage. Is also called while nothing touches (press.down is false),
// so that a tissue can end a touch. Allocates nothing and does not throw; nor do the next two, once `shape` has its
// size.
void answer(const Tissue& tissue, StageId stage, const Press& press, TissueWork& work, Contact& contact);

// Returns the rise of the resisting tangential force up to a station (N), for the avatar's laws. The contact of the
// touch stays as it is.
double rise_N(const Tissue& tissue, const Station& station, TissueWork& work);

// The force on a finger that is held at a depth at a place, for devices. Depths at and above the surface give 0. Allocates
// nothing and does not throw. A work that pushes is not used for touches.
Push push_to(const Tissue& tissue, const Eigen::Vector2d& p_m, double depth_m, TissueWork& work);

// Computes the surface under the last contact.
void sample_surface(const Tissue& tissue, const SurfaceEffect& effect, const Contact& contact, const TissueWork& work,
                    SurfaceShape& shape);

}  // namespace palpa::scene
