#pragma once
// A soft block of one material at large strains under a rigid sphere, pressed at one place, its middle: for devices, whose
// loop takes one Newton step of its contact per tick (mechanics/sphere_press.h). A pen, which knows its force, is answered
// from the converged force over depth. scene/tissue.h describes the functions at the end.

#include <Eigen/Core>
#include <filesystem>

#include "mechanics/sphere_press.h"
#include "scene/force_curve.h"

namespace palpa::scene {

struct SoftBlockOptions {
    mechanics::SpherePressBlock block;
    double greatest_depth_m = 6e-3;
};

// Reads the key `block` of a tissue: size_mm, law, mu_Pa, kappa_Pa, sphere_radius_mm, greatest_depth_mm, cells, finest_mm.
// Throws InputError.
SoftBlockOptions read_soft_block(files::JsonReader json);

struct SoftBlockTissue {
    SoftBlockOptions options;
    mechanics::SpherePress press;
    ForceCurve curve;  // converged, at kCurvePoints depths
};
using SoftBlockWork = mechanics::SpherePressWork;
inline constexpr int kCurvePoints = 48;

bool takes_seconds(const SoftBlockOptions& options);
std::vector<std::filesystem::path> input_files(const SoftBlockOptions& options);
files::Json file_hashes(const SoftBlockOptions& options);
std::filesystem::path map_folder(const SoftBlockOptions& options);
inline bool knows_surface(const SoftBlockOptions&) { return false; }

SoftBlockTissue prepare(const SoftBlockOptions& options, const Scene& scene, const mechanics::Progress& progress);
bool serves(const SoftBlockTissue& tissue, const Scene& scene);
void describe(const SoftBlockTissue& tissue, const Scene& scene, Plan& plan);
std::vector<Stage> stages(const SoftBlockTissue& tissue, const Scene& scene);
files::Json identity(const SoftBlockTissue& tissue);

SoftBlockWork make_work(const SoftBlockTissue& tissue);
void answer(const SoftBlockTissue& tissue, StageId stage, const Press& press, SoftBlockWork& work, Contact& contact);
double rise_N(const SoftBlockTissue& tissue, const Station& station, SoftBlockWork& work);
void sample_surface(const SoftBlockTissue& tissue, const SurfaceEffect& effect, const Contact& contact,
                    const SoftBlockWork& work, SurfaceShape& shape);
Push push_to(const SoftBlockTissue& tissue, const Eigen::Vector2d& p_m, double depth_m, SoftBlockWork& work);

}  // namespace palpa::scene
