#pragma once
// The tissues. A new one is an alternative in TissueOptions (scene/scene.h), Tissue and TissueWork, and an overload of
// each function below for its own types; no other place asks which tissue it is.

#include <variant>
#include <vector>

#include "scene/linear_tissue.h"
#include "scene/map_tissue.h"

namespace palpa::scene {

using Tissue = std::variant<MapTissue, LinearTissue>;  // prepared, in a plan
using TissueWork = std::variant<MapWork, LinearWork>;  // what a touch changes, in a state

// Of what was asked for:
bool takes_seconds(const TissueOptions& options);  // to prepare: somebody must be told
std::vector<std::filesystem::path> input_files(const TissueOptions& options);
files::Json file_hashes(const TissueOptions& options);           // SHA-256 of what it is made from, for logs
std::filesystem::path map_folder(const TissueOptions& options);  // empty if it is made from no map

// Reads or computes it, in seconds: `progress` tells and may stop it. Throws InputError, and mechanics' errors for a
// block that cannot be solved.
Tissue prepare(const TissueOptions& options, const Scene& scene, const mechanics::Progress& progress);

// Whether it was prepared for this scene, see the function of the same name for plans.
bool serves(const Tissue& tissue, const Scene& scene);

// Fills what the plan says of its tissue, from its name to the notes.
void describe(const Tissue& tissue, const Scene& scene, Plan& plan);

// The stages that depend on the tissue, in order; those per frame last. Each of depth, friction and tangential that is
// among them goes to answer() at every sample.
std::vector<Stage> stages(const Tissue& tissue, const Scene& scene);

files::Json identity(const Tissue& tissue);  // what a run's settings say of it besides name and source

TissueWork make_work(const Tissue& tissue);

// From a touch to the contact, stage by stage; also while nothing touches (press.down), so that it can let go.
// Allocates nothing and does not throw, nor do the next two once `shape` has its size.
void answer(const Tissue& tissue, StageId stage, const Press& press, TissueWork& work, Contact& contact);

// Rise of the resisting tangential force up to a station, as the laws ask for it. The touch stays as it is.
double rise_N(const Tissue& tissue, const Station& station, TissueWork& work);

// The surface under the last contact.
void sample_surface(const Tissue& tissue, const SurfaceEffect& effect, const Contact& contact, const TissueWork& work,
                    SurfaceShape& shape);

}  // namespace palpa::scene
