#pragma once
// A recorded or generated map as a tissue: tables, which answer at once. scene/tissue.h says what each of these is for.

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

// A map, prepared for look-up.
struct MapTissue {
    stiffnessmaps::Map map;
    stiffnessmaps::Field field;
    double noise_N = 0.0;      // of the map
    double smoothing_m = 0.0;  // of the tangential force
};

// What a sample changes.
struct MapWork {
    stiffnessmaps::Place place;  // of the touch; between the stages of one sample
};

bool takes_seconds(const MapOptions& options);
std::vector<std::filesystem::path> input_files(const MapOptions& options);
files::Json file_hashes(const MapOptions& options);
std::filesystem::path map_folder(const MapOptions& options);

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

}  // namespace palpa::scene
