#pragma once
// Tissue that is one force over depth, the same everywhere: for every display. It gives way straight down, so that nothing
// resists motion along its surface. scene/tissue.h describes the functions at the end.
//
//   law      F(d) = k d exp(d / g)        k: stiffness at the surface, g: depth over which it grows; absent: F = k d
//   points   linear from (0, 0) through the points, which rise strictly in depth and in force
//
// Either ends at a greatest depth.

#include <Eigen/Core>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "files/json.h"
#include "mechanics/operators.h"
#include "scene/contact.h"
#include "scene/stages.h"
#include "scene/surface.h"

namespace palpa::scene {

struct Plan;
struct Scene;
struct SurfaceEffect;

struct ForceCurve {
    double stiffness_N_per_m = 0.0;  // k, of the law; not used beside points
    double growth_m = std::numeric_limits<double>::infinity();
    std::vector<double> depth_m;  // of the points, from 0 on; empty: the law
    std::vector<double> force_N;
    double greatest_depth_m = 10e-3;
};

// Force (N) and slope (N/m) at a depth, which is clamped to 0 ... greatest_depth_m.
double force_at_N(const ForceCurve& curve, double depth_m) noexcept;
double slope_at_N_per_m(const ForceCurve& curve, double depth_m) noexcept;
// The depth of a force, from 0 to greatest_depth_m, to 1e-12 of that.
double depth_of_m(const ForceCurve& curve, double force_N) noexcept;

// For tissues that hold a curve: what a plan says about forces, and the answer to a touch.
void describe_curve(const ForceCurve& curve, const Scene& scene, Plan& plan);
void answer_from_curve(const ForceCurve& curve, const Press& press, Contact& contact);

// What a scene file asks for.
struct ForceCurveOptions {
    ForceCurve curve;
    double indenter_radius_m = 8e-3;  // for pictures
    Eigen::Vector2d size_m{0.12, 0.12};
};

// Reads the key `force_curve` of a tissue: stiffness_N_per_mm, growth_mm and greatest_depth_mm, or the arrays depth_mm and
// force_N; and indenter_radius_mm. Throws InputError.
ForceCurveOptions read_force_curve(files::JsonReader json);

struct ForceCurveTissue {
    ForceCurveOptions options;
};
struct ForceCurveWork {};

bool takes_seconds(const ForceCurveOptions& options);
std::vector<std::filesystem::path> input_files(const ForceCurveOptions& options);
files::Json file_hashes(const ForceCurveOptions& options);
std::filesystem::path map_folder(const ForceCurveOptions& options);
inline bool knows_surface(const ForceCurveOptions&) { return false; }

ForceCurveTissue prepare(const ForceCurveOptions& options, const Scene& scene, const mechanics::Progress& progress);
bool serves(const ForceCurveTissue& tissue, const Scene& scene);
void describe(const ForceCurveTissue& tissue, const Scene& scene, Plan& plan);
std::vector<Stage> stages(const ForceCurveTissue& tissue, const Scene& scene);
files::Json identity(const ForceCurveTissue& tissue);

ForceCurveWork make_work(const ForceCurveTissue& tissue);
void answer(const ForceCurveTissue& tissue, StageId stage, const Press& press, ForceCurveWork& work, Contact& contact);
double rise_N(const ForceCurveTissue& tissue, const Station& station, ForceCurveWork& work);
void sample_surface(const ForceCurveTissue& tissue, const SurfaceEffect& effect, const Contact& contact,
                    const ForceCurveWork& work, SurfaceShape& shape);
Push push_to(const ForceCurveTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, ForceCurveWork& work);

}  // namespace palpa::scene
