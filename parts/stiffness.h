#pragma once
// The stiffness of a part under one of its loads, by several methods.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "parts/part_file.h"

namespace palpa::parts {

struct CellModel;  // cell_model.h
struct PartBeam;   // beam_model.h

// paper                        the torsion spring by which the paper replaces a beam (parts/beam_model.h); never applies
// euler_bernoulli, timoshenko  the part as a clamped beam along `axis` (mechanics/beam.h)
// elastica                     the same beam without shear, bent by any angle (mechanics/elastica.h)
// voxels                       finite cells and conjugate gradients with multigrid (mechanics/voxel_solve.h)
// factorised                   the same cells by one factorisation: the check, at a gigabyte for 50,000 cells
enum class Method { paper, euler_bernoulli, timoshenko, elastica, voxels, factorised };
const char* name_of(Method method);

struct StiffnessOptions {
    std::vector<Method> methods;
    std::optional<double> cell_m;  // absent: the part's
    double energy_error = 1e-3;    // of `voxels`
};

struct MethodResult {
    Method method = Method::voxels;
    std::string why_not;    // why the answer should not be trusted, or why there is none; "" if the method applies
    bool answered = false;  // the numbers below are there
    double displacement_m = 0.0;  // along the load, its mean over the loaded surface, under the load's force
    double stiffness_N_per_m = 0.0;
    std::optional<double> error;  // relative, against `against`
    std::string against;
    std::optional<double> coarser;  // displacement on cells twice as large over this one, less one
    std::int64_t cells = 0;
    int iterations = 0;
    double energy_error = 0.0;
    double max_strain = 0.0;  // of cells that are at least half full
    bool converged = true;
    double time_s = 0.0;
    std::size_t memory_bytes = 0;
};

// Answers with every method in turn. Throws InputError if the load has no surface under it, if nothing is held, and for a
// cell that is no whole number of voxels.
std::vector<MethodResult> stiffness_of(const Part& part, const PartLoad& load, const StiffnessOptions& options);

// How far an answer in proportion to the force can be followed.
struct Validity {
    double to_m =
        std::numeric_limits<double>::infinity();  // along the load, at its own place; 0: the method never applies
    std::string why_not;                          // why not beyond it
};

// Of paper, euler_bernoulli and timoshenko, for the part as the beam that beam_of() finds: up to where stiffness_of() says that
// the method applies, found by bisection to 1 %.
Validity beam_validity(const Part& part, const PartBeam& beam, const PartLoad& load, Method method);

// Of finite cells, by the solution u_m for 1 N; why_not is one of kCellLimits.
inline constexpr const char* kCellsTurn = "cells turn by more than 15 degrees";
inline constexpr const char* kCellsStrain = "strains are above 25 %, which is not small";
inline constexpr const char* kHeldPartStretches =
    "held on both sides of the load, it stretches, which small displacements leave out";
inline constexpr const char* kOneCellAcross =
    "one cell across the part does not bend as the part does; smaller cells are needed";
inline constexpr const char* kCellLimits[] = {"", kCellsTurn, kCellsStrain, kHeldPartStretches, kOneCellAcross};
Validity cell_validity(const Part& part, const PartLoad& load, const CellModel& model, const Eigen::Matrix3Xd& load_N,
                       const Eigen::Matrix3Xd& u_m, double compliance_m_per_N);

// How much further than the elastica a linear beam may go, and how much of a beam's answer the shear may be that it leaves
// out, before its answer is not taken to apply. A uniform beam is 3 % off where its chord turns by 10 degrees; one with a soft
// piece long before.
inline constexpr double kMostBend = 0.03;
inline constexpr double kMostShear = 0.05;
// Shear by `timoshenko` beyond which a core is so soft that its faces bend by themselves; and how far a beam may be from the
// cells before it is none. Both ours: a sandwich is 2 % off where shear adds 44 %, 17 % where it adds four times as much.
inline constexpr double kMostSoft = 1.0;
inline constexpr double kMostApart = 0.1;
// How far the displacement on cells twice as large may be from that on cells before cells half as large are asked, which may
// differ by kMostApart. Ours: cells of 1.5 mm pass on the toothbrush of the examples, 5 % off, and of 3 mm, 17 % off, do not.
inline constexpr double kMostByCells = 0.15;
// The share of walls and layers thinner than two cells from which smaller cells are asked in any case; ours. Curved sides of a
// part of five cells across have 5 %.
inline constexpr double kMostThin = 0.1;
// How deep a part that is held on both sides of its load may go, over its height along the load: a plate then stretches, and
// is some 5 % stiffer than in small displacements (Timoshenko, Woinowsky-Krieger, Theory of Plates and Shells, section 97).
inline constexpr double kMostHeldDepth = 0.25;
// A cell's rotation beyond which the linear answer of cells is not taken to apply: the slope at the tip of a uniform beam
// whose chord turns by 10 degrees.
inline constexpr double kMostTurn_deg = 15.0;
// The least length over height of a beam; ours.
inline constexpr double kLeastSlenderness = 5.0;

}  // namespace palpa::parts
