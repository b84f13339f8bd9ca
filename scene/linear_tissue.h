#pragma once
// A block of linear elastic tissue with stiff nodules, palpated live: the frictionless contact of the indenter is
// solved anew at every sample on a precomputed surface compliance; where asked for, Coulomb friction drags along from
// sample to sample. Shapes and materials come from a phantom.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "files/json.h"
#include "mechanics/compliance.h"
#include "mechanics/contact.h"
#include "mechanics/friction.h"
#include "scene/contact.h"
#include "scene/scene.h"
#include "scene/stages.h"
#include "scene/surface.h"
#include "stiffnessmaps/phantom.h"

namespace palpa::scene {

struct Plan;

// Plain data, constant while it runs. Positions are the phantom's: its corner at the origin.
struct LinearTissue {
    stiffnessmaps::Phantom phantom;
    mechanics::Compliance compliance;
    mechanics::Indenter indenter;
    std::size_t n_x = 0;  // surface nodes, x fastest; height field of the picture
    std::size_t n_y = 0;
    double spacing_m[2] = {0.0, 0.0};
    std::optional<double> friction;
    int mesh_nodes = 0;
    bool from_cache = false;
    std::string cache_warning;  // why it could not be stored, for people; empty if it was
};

// Contacts half a node spacing before and behind a place. Each place asked for at every sample has a work of its own:
// it hardly moves from one sample to the next, so its set of nodes and their factor stay.
struct SlopeWork {
    mechanics::ContactWork ahead;
    mechanics::ContactWork behind;
};

// What a sample changes.
struct LinearWork {
    mechanics::ContactWork work;
    mechanics::Contact contact;  // of the touch
    mechanics::Contact probe;    // of places beside it
    double depth_m = 0.0;        // where the search for the depth starts
    SlopeWork slope;             // of the touch
    // At the path's stations.
    mechanics::ContactWork station;
    SlopeWork station_slope;
    SlopeWork reference_slope;
    // With friction only. What the next sample starts from is `friction`.
    mechanics::FrictionState friction;
    mechanics::FrictionWork friction_work;
    mechanics::Contact sliding;
    Eigen::Vector2d drag_N = Eigen::Vector2d::Zero();  // Coulomb force; positive opposes motion along +x (+y)
    std::int64_t skipped_slides = 0;                   // half spacings that a leap of the pen left out
};

// Builds the mesh, factors it and computes the compliance: seconds to minutes, unless `cache` (a folder; empty: none)
// holds it from an earlier run. May run in a worker thread. Throws InputError for the phantom, mechanics' errors for
// what cannot be solved, and mechanics::Cancelled.
LinearTissue make_linear_tissue(const LinearOptions& options, const std::filesystem::path& cache,
                                const mechanics::Progress& progress);

LinearWork make_work(const LinearTissue& tissue);

// Depth for a normal force.
struct LinearAnswer {
    double depth_m = 0.0;
    bool saturated = false;  // the force is not reached at the depth limit
    double linearity = 0.0;  // mechanics/linear_range.h: amber above 0.10, red above 0.25
};
LinearAnswer press(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double force_N, LinearWork& work);

// Force that resists motion along u at a depth: slope of the elastic energy, averaged over one node spacing, which
// takes out the ripple of the node-wise contact. Never negative. Two contact solves.
double tangential_force_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u,
                          double depth_m, LinearWork& work);

// Rise of that force over reference_m along u up to e, at the depth of `force_N` at e; the touch stays as it is. Five
// places.
double tangential_rise_N(const LinearTissue& tissue, const Eigen::Vector2d& e_m, const Eigen::Vector2d& u,
                         double force_N, double reference_m, LinearWork& work);

// Drags the rough tool from where it was to p at a depth, in steps of at most half a node spacing (after a jump the
// last 16 of them; what came before has worn off and is counted) and leaves the Coulomb force in work.drag_N. The contact on the way
// has friction in its pressure too, so its normal force differs a little from the one that was pressed with.
void drag(const LinearTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, LinearWork& work);
// Lifted: forgets.
void let_go(LinearWork& work);
// tangential_force_N and the Coulomb force along u; what goes downhill lowers the sum, which is never negative.
double rough_tangential_force_N(const LinearTissue& tissue, const Eigen::Vector2d& p_m, const Eigen::Vector2d& u,
                                double depth_m, LinearWork& work);

// Sink of the surface nodes under the contact last pressed, n_x * n_y, metres downwards.
void surface_sink_m(const LinearTissue& tissue, const LinearWork& work, Eigen::VectorXd& out_m);

// As a tissue: scene/tissue.h says what each of these is for.
bool takes_seconds(const LinearOptions& options);
std::vector<std::filesystem::path> input_files(const LinearOptions& options);
files::Json file_hashes(const LinearOptions& options);
std::filesystem::path map_folder(const LinearOptions& options);

LinearTissue prepare(const LinearOptions& options, const Scene& scene, const mechanics::Progress& progress);
bool serves(const LinearTissue& tissue, const Scene& scene);
void describe(const LinearTissue& tissue, const Scene& scene, Plan& plan);
std::vector<Stage> stages(const LinearTissue& tissue, const Scene& scene);
files::Json identity(const LinearTissue& tissue);

void answer(const LinearTissue& tissue, StageId stage, const Press& press, LinearWork& work, Contact& contact);
double rise_N(const LinearTissue& tissue, const Station& station, LinearWork& work);
void sample_surface(const LinearTissue& tissue, const SurfaceEffect& effect, const Contact& contact,
                    const LinearWork& work, SurfaceShape& shape);

}  // namespace palpa::scene
