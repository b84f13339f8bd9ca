#pragma once
// A block of linear elastic tissue with stiff nodules, palpated live: the frictionless contact of the indenter is
// solved anew at every sample, on a precomputed surface compliance. If the scene asks for Coulomb friction, a second
// contact with friction is carried from sample to sample. Shapes and materials come from a phantom.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "files/json.h"
#include "mechanics/compliance.h"
#include "mechanics/contact.h"
#include "mechanics/friction.h"
#include "mechanics/surface_grid.h"
#include "scene/contact.h"
#include "scene/scene.h"
#include "scene/stages.h"
#include "scene/surface.h"
#include "stiffnessmaps/phantom.h"

namespace palpa::scene {

struct Plan;

// The prepared block; constant while it runs. Positions are in the phantom's frame, whose origin is the block's corner.
struct LinearTissue {
    stiffnessmaps::Phantom phantom;
    mechanics::Compliance compliance;
    mechanics::Indenter indenter;
    std::size_t n_x = 0;  // surface nodes along x and y, numbered x fastest
    std::size_t n_y = 0;
    double spacing_m[2] = {0.0, 0.0};              // between them; the least, if they are graded
    std::optional<mechanics::SurfaceGrid> graded;  // their coordinates, unless they are even
    std::optional<double> friction;                // coefficient; absent: frictionless
    int mesh_nodes = 0;                            // of the whole mesh
    std::uint64_t content = 0;                     // fingerprint of mesh, materials and supports
    bool from_cache = false;
    std::string cache_warning;  // why the compliance could not be stored, for people; else empty
};

// Scratch memory of the contacts half a node spacing ahead of and behind a place. Each place that is asked at every
// sample has its own: it hardly moves from one sample to the next, so that its active set and factor can be used again.
struct SlopeWork {
    mechanics::ContactWork ahead;
    mechanics::ContactWork behind;
};

// What a sample changes.
struct LinearWork {
    mechanics::ContactWork work;
    mechanics::Contact contact;  // at the touch
    mechanics::Contact probe;    // at other places, overwritten by each
    double depth_m = 0.0;        // where the search for the touch's depth starts
    SlopeWork slope;             // at the touch
    // At the path's stations, and the reference distance before them.
    mechanics::ContactWork station;
    SlopeWork station_slope;
    SlopeWork reference_slope;
    // With friction only. The next sample starts from `friction`.
    mechanics::FrictionState friction;
    mechanics::FrictionWork friction_work;
    mechanics::Contact sliding;
    Eigen::Vector2d drag_N = Eigen::Vector2d::Zero();  // Coulomb force; positive opposes motion along +x (+y)
    std::int64_t skipped_slides = 0;                   // half spacings that drag() has left out since the start
};

// Builds the mesh, factors it and computes the compliance, which takes seconds to minutes unless `cache` (a folder;
// empty for none) holds the compliance of an earlier run. May run in a worker thread. Throws InputError for a phantom
// that is wrong or needs too much memory, mechanics' errors for what cannot be solved, and mechanics::Cancelled.
LinearTissue make_linear_tissue(const LinearOptions& options, const std::filesystem::path& cache,
                                const mechanics::Progress& progress);

// Spreads the sink of graded nodes (n_x * n_y values) evenly over the block, at most 96 x 96 of them, so that a picture has
// one spacing.
void spread_evenly(const LinearTissue& tissue, const Eigen::VectorXd& node_sink_m, SurfaceShape& shape);

// Returns the lesser node spacing at a place.
double spacing_at_m(const LinearTissue& tissue, const Eigen::Vector2d& p_m);

// Throws InputError if the grading's centre is not on the block.
void check_grading(const LinearOptions& options, const stiffnessmaps::Phantom& phantom);

// Takes the coordinates of graded nodes, and their least spacing, from the tissue's compliance.
void take_grid(LinearTissue& tissue);

LinearWork make_work(const LinearTissue& tissue);

// The depth for a normal force.
struct LinearAnswer {
    double depth_m = 0.0;
    bool saturated = false;  // the force is not reached at the greatest depth allowed; the depth stays there
    bool inexact = false;    // the contact did not settle, or the force was missed (mechanics/contact.h)
    double linearity = 0.0;  // mechanics/linear_range.h: amber above 0.10, red above 0.25
};
LinearAnswer press(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double force_N, LinearWork& work);

// Returns the force (N) that resists motion along u at a depth: the slope of the elastic energy, averaged over one node
// spacing, so that it does not ripple as nodes join and leave the contact. Never negative. Costs two contact solves.
double tangential_force_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u,
                          double depth_m, LinearWork& work);

// Returns how much that force (N) rises from e - reference_m u to e, both at the depth to which `force_N` presses at e.
// The contact of the touch stays as it is. Costs five contact solves.
double tangential_rise_N(const LinearTissue& tissue, const Eigen::Vector2d& e_m, const Eigen::Vector2d& u,
                         double force_N, double reference_m, LinearWork& work);

// Drags the rough tool from where it was to p at a depth and leaves the Coulomb force in work.drag_N. The steps are at
// most half a node spacing. After a jump only the last 16 steps are taken, since the effect of those before has worn
// off; they are counted in work.skipped_slides. In this contact the pressure depends on friction too, so its normal
// force differs a little from the one that was pressed with.
void drag(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, LinearWork& work);
// Forgets the friction of a touch that has ended.
void let_go(LinearWork& work);
// Returns the energy slope of tangential_force_N, here of either sign, plus the Coulomb force along u (N). The sum is
// never negative.
double rough_tangential_force_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u,
                                double depth_m, LinearWork& work);

// Computes the sink of the surface nodes under the last touch: n_x * n_y values, metres downwards.
void surface_sink_m(const LinearTissue& tissue, const LinearWork& work, Eigen::VectorXd& out_m);

// The functions that every tissue has; scene/tissue.h describes them.
bool takes_seconds(const LinearOptions& options);
std::vector<std::filesystem::path> input_files(const LinearOptions& options);
files::Json file_hashes(const LinearOptions& options);
std::filesystem::path map_folder(const LinearOptions& options);
inline bool knows_surface(const LinearOptions&) { return true; }

LinearTissue prepare(const LinearOptions& options, const Scene& scene, const mechanics::Progress& progress);
bool serves(const LinearTissue& tissue, const Scene& scene);
void describe(const LinearTissue& tissue, const Scene& scene, Plan& plan);
std::vector<Stage> stages(const LinearTissue& tissue, const Scene& scene);
files::Json identity(const LinearTissue& tissue);

void answer(const LinearTissue& tissue, StageId stage, const Press& press, LinearWork& work, Contact& contact);
double rise_N(const LinearTissue& tissue, const Station& station, LinearWork& work);
void sample_surface(const LinearTissue& tissue, const SurfaceEffect& effect, const Contact& contact,
                    const LinearWork& work, SurfaceShape& shape);
Push push_to(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, LinearWork& work);

}  // namespace palpa::scene
