#include "parts/stiffness.h"

#include <algorithm>
#include <cmath>

#include "files/clock.h"
#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/elastica.h"
#include "mechanics/error.h"
#include "mechanics/linear_range.h"
#include "mechanics/voxel_solve.h"
#include "parts/beam_model.h"
#include "parts/cell_model.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

constexpr int kFewestCells = 2;
constexpr double kDegrees = 180.0 / 3.14159265358979323846;

void judge_strain(const CellStrain& unit, double force_N, MethodResult& result) {
    result.max_strain = force_N * unit.strain;
    const double turn_deg = kDegrees * force_N * unit.rotation_rad;
    if (turn_deg > kMostTurn_deg)
        result.why_not = "cells turn by " + files::short_number(turn_deg) + " degrees, above 15";
    if (linear_range(result.max_strain) == LinearRange::red)
        result.why_not = "strains reach " + files::short_number(100.0 * result.max_strain) + " %, which is not small";
}

void solve_cells(const PartLoad& load, const CellModel& model, const Eigen::Matrix3Xd& load_N, double energy_error,
                 MethodResult& out) {
    Eigen::Matrix3Xd u_m;
    double compliance = 0.0;  // m/N
    if (out.method == Method::factorised) {
        const DirectSolution solution = solve_directly(model.level, load_N);
        u_m = solution.u_m;
        compliance = solution.work_J;
        out.energy_error = solution.backward_error;
    } else {
        const Multigrid multigrid = make_multigrid(model.level);
        const VoxelSolution solution = solve(multigrid, load_N, {energy_error, 500});
        u_m = solution.u_m;
        compliance = solution.work_J;
        out.energy_error = solution.energy_error;
        out.iterations = solution.iterations;
        out.converged = solution.converged;
        out.memory_bytes = memory_bytes(multigrid);
    }
    out.answered = compliance > 0.0;
    if (!out.answered) {
        out.why_not = "the load is where the part is held: nothing moves";
        return;
    }
    out.displacement_m = compliance * load.force_N;
    out.stiffness_N_per_m = 1.0 / compliance;
    out.cells = static_cast<std::int64_t>(model.cells.place.size());
    judge_strain(greatest_strain(model, u_m), load.force_N, out);
    const int across = *std::min_element(model.cells.n.begin(), model.cells.n.end());
    if (across < kFewestCells)
        out.why_not = "one cell across the part does not bend as the part does; smaller cells are needed";
}

// The displacement at the tip by the beam's method, m.
double tip_m(const PartBeam& beam, const PartLoad& load, Method method) {
    // the part of the force that bends, and of the path
    const double along = beam.across * beam.across;
    if (method == Method::paper) return along * load.force_N / paper_spring_N_per_m(beam);
    if (method == Method::elastica)
        return beam.across * elastica_tip(beam.pieces, beam.clamped_low, beam.across * load.force_N).across_m;
    return along * load.force_N * beam_tip(beam.pieces, beam.clamped_low, method == Method::timoshenko).m_per_N;
}

void bend_beam(const Part& part, const PartLoad& load, MethodResult& out) {
    const PartBeam beam = beam_of(part, load);
    out.why_not = beam.why_not;
    if (!out.why_not.empty()) return;
    out.answered = true;
    out.displacement_m = tip_m(beam, load, out.method);
    out.stiffness_N_per_m = load.force_N / out.displacement_m;
    const double bent_m = tip_m(beam, load, Method::euler_bernoulli);
    const double shear = tip_m(beam, load, Method::timoshenko) / bent_m - 1.0;
    if (out.method != Method::timoshenko && shear > kMostShear)
        out.why_not = "shear, which it leaves out, adds " + files::short_number(100.0 * shear) + " %";
    if (!beam.doubt.empty()) out.why_not = beam.doubt;
    if (beam.length_m < kLeastSlenderness * beam.height_m)
        out.why_not = "length over height is " + files::short_number(beam.length_m / beam.height_m) + ", below 5";
    const double excess = bent_m / tip_m(beam, load, Method::elastica) - 1.0;
    if (out.method != Method::elastica && excess > kMostBend)
        out.why_not = "the beam bends too far: without large angles it goes " + files::short_number(100.0 * excess) +
                      " % further than with them (elastica)";
    if (out.method == Method::paper) {
        out.why_not =
            "the spring takes a force per angle for a moment per angle: one piece has 2/3 of a beam's "
            "stiffness, and every cut makes it stiffer (" +
            std::to_string(beam.pieces.size()) + (beam.pieces.size() == 1 ? " piece here)" : " pieces here)");
    }
}

// Compares with the factorisation, or with `voxels`, whichever was asked for and can be trusted.
void compare_methods(std::vector<MethodResult>& results) {
    const MethodResult* best = nullptr;
    for (const MethodResult& result : results) {
        const bool good = result.answered && result.converged && result.why_not.empty();
        if (good && result.method >= Method::voxels && (best == nullptr || result.method > best->method))
            best = &result;
    }
    for (MethodResult& result : results) {
        if (best == nullptr || !result.answered || result.method == best->method) continue;
        result.error = result.displacement_m / best->displacement_m - 1.0;
        result.against = name_of(best->method);
    }
}

}  // namespace

const char* name_of(Method method) {
    switch (method) {
        case Method::paper:
            return "paper";
        case Method::euler_bernoulli:
            return "euler-bernoulli";
        case Method::timoshenko:
            return "timoshenko";
        case Method::elastica:
            return "elastica";
        case Method::voxels:
            return "voxels";
        case Method::factorised:
            return "factorised";
    }
    return "";
}

std::vector<MethodResult> stiffness_of(const Part& part, const PartLoad& load, const StiffnessOptions& options) {
    std::vector<MethodResult> out;
    std::optional<CellModel> model;
    Eigen::Matrix3Xd load_N;
    for (const Method method : options.methods) {
        MethodResult result;
        result.method = method;
        const double began_s = files::steady_s();
        try {
            if (method < Method::voxels) {
                bend_beam(part, load, result);
            } else {
                if (!model) {
                    model = cell_model(part, voxels_per_cell(part, options.cell_m));
                    load_N = unit_load_N(part, *model, load);
                }
                solve_cells(load, *model, load_N, options.energy_error, result);
            }
        } catch (const MeshError& error) {
            throw files::InputError(part.file + ": " + error.what());
        } catch (const LoadError& error) {
            throw files::InputError(part.file + ": loads." + load.name + ": " + error.what());
        }
        result.time_s = files::steady_s() - began_s;
        out.push_back(result);
    }
    compare_methods(out);
    return out;
}

}  // namespace palpa::parts
