#pragma once
// A recorded or generated map as a tissue, which answers from tables. scene/tissue.h describes the functions.

#include <cstdint>
#include <optional>

#include "files/json.h"
#include "mechanics/operators.h"
#include "scene/contact.h"
#include "scene/scene.h"
#include "scene/stages.h"
#include "scene/surface.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/map.h"

namespace palpa::scene {

struct Plan;

// A map prepared for look-up.
struct MapTissue {
    stiffnessmaps::Map map;
    stiffnessmaps::Field field;
    double noise_N = 0.0;      // standard deviation in the map's normal force, before stiffness_scale
    double smoothing_m = 0.0;  // Gaussian sigma of the tangential force's smoothing
};

// What a sample changes.
struct MapWork {
    stiffnessmaps::Place place;  // of the touch: found by the depth stage, used by the tangential stage
};

bool takes_seconds(const MapOptions& options);
std::vector<std::filesystem::path> input_files(const MapOptions& options);
files::Json file_hashes(const MapOptions& options);
std::filesystem::path map_folder(const MapOptions& options);
inline bool knows_surface(const MapOptions&) { return false; }

MapTissue prepare(const MapOptions& options, const Scene& scene, const mechanics::Progress& progress);
bool serves(const MapTissue& tissue, const Scene& scene);
void describe(const MapTissue& tissue, const Scene& scene, Plan& plan);
std::vector<Stage> stages(const MapTissue& tissue, const Scene& scene);
files::Json identity(const MapTissue& tissue);

MapWork make_work(const MapTissue& tissue);
void answer(const MapTissue& tissue, StageId stage, const Press& press, MapWork& work, Contact& contact);
double rise_N(const MapTissue& tissue, const Station& station, MapWork& work);
void sample_surface(const MapTissue& tissue, const SurfaceEffect& effect, const Contact& contact, const MapWork& work,
                    SurfaceShape& shape);
Push push_to(const MapTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, MapWork& work);

}  // namespace palpa::scene
