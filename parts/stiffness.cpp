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
#include "parts/thin_walls.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

constexpr int kFewestCells = 2;
constexpr std::int64_t kMostHalved = 60'000;  // cells that are halved to judge them: eight times as many take seconds
constexpr double kDegrees = 180.0 / 3.14159265358979323846;

void judge_strain(const CellStrain& unit, double force_N, MethodResult& result) {
    result.max_strain = force_N * unit.strain;
    const double turn_deg = kDegrees * force_N * unit.rotation_rad;
    if (turn_deg > kMostTurn_deg)
        result.why_not = "cells turn by " + files::short_number(turn_deg) + " degrees, above 15";
    if (linear_range(result.max_strain) == LinearRange::red)
        result.why_not = "strains reach " + files::short_number(100.0 * result.max_strain) + " %, which is not small";
}

// Whether some line across the force, through the middle of the load, meets fixed nodes on both sides of it.
bool held_on_both_sides(const GridLevel& level, const Eigen::Matrix3Xd& load_N, int force_axis) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    const auto place = [&](int node) {
        const auto& p = level.node_place[static_cast<std::size_t>(node)];
        return Eigen::Vector3d(p[0], p[1], p[2]);
    };
    for (int node = 0; node < n_nodes(level); ++node) middle += load_N.col(node).norm() * place(node);
    middle /= load_N.colwise().norm().sum();
    for (int axis = 0; axis < 3; ++axis) {
        const int other = 3 - axis - force_axis;
        if (axis == force_axis) continue;
        bool low = false, high = false;
        for (int node = 0; node < n_nodes(level); ++node) {
            if (level.free(axis, node) != 0.0 || std::abs(place(node)(other) - middle(other)) > 1.0) continue;
            low |= place(node)(axis) < middle(axis) - 1.0;
            high |= place(node)(axis) > middle(axis) + 1.0;
        }
        if (low && high) return true;
    }
    return false;
}

// Along a load.
double height_along_m(const Part& part, const PartLoad& load) {
    const FilledBox box = filled_box(part.voxels);
    const auto c = static_cast<std::size_t>(largest_axis(load.direction));
    return part.voxels.frame.pitch_m * (box.high[c] - box.low[c]);
}

bool is_one_cell_thick(const CellModel& model) {
    return *std::min_element(model.cells.n.begin(), model.cells.n.end()) < kFewestCells;
}

// The smaller cells that judge these: half as large, or the next larger whole number of voxels where half of an odd number
// would be too many cells; 0 if these are too many, too.
int finer_voxels_per_cell(int voxels_per_cell, std::int64_t cells) {
    for (const int n : {std::max(1, voxels_per_cell / 2), (voxels_per_cell + 1) / 2}) {
        const double times = std::pow(static_cast<double>(voxels_per_cell) / n, 3.0);
        if (static_cast<double>(cells) * times <= 8.0 * kMostHalved) return n;
    }
    return 0;
}

void judge_stretch(const Part& part, const PartLoad& load, const CellModel& model, const Eigen::Matrix3Xd& load_N,
                   MethodResult& out) {
    const double height_m = height_along_m(part, load);
    if (out.displacement_m <= kMostHeldDepth * height_m) return;
    if (!held_on_both_sides(model.level, load_N, largest_axis(load.direction))) return;
    out.why_not = "held on both sides of the load, the part goes " +
                  files::short_number(out.displacement_m / height_m) +
                  " times its height deep: it stretches, which small displacements leave out";
}

// The displacement for 1 N on other cells, m; absent where these cannot answer.
std::optional<double> compliance_on(const Part& part, const PartLoad& load, int voxels_per_cell) {
    try {
        const CellModel model = cell_model(part, voxels_per_cell);
        const VoxelSolution solution = solve(make_multigrid(model.level), unit_load_N(part, model, load), {1e-3, 500});
        if (!solution.converged || !(solution.work_J > 0.0)) return std::nullopt;
        return solution.work_J;
    } catch (const files::InputError&) {
        return std::nullopt;  // a support between their corners
    } catch (const MeshError&) {
        return std::nullopt;  // too many
    }
}

// Cells as small as voxels are taken as they are. Where walls or layers are thinner than two cells, cells twice as large may be
// as wrong as these, so that smaller ones are asked in any case.
void judge_cells(const Part& part, const PartLoad& load, int voxels_per_cell, MethodResult& out) {
    if (!out.answered) return;
    const auto against = [&](int n) -> std::optional<double> {
        const std::optional<double> other = compliance_on(part, load, n);
        if (!other) return std::nullopt;
        return *other * load.force_N / out.displacement_m - 1.0;
    };
    out.coarser = against(2 * voxels_per_cell);
    if (voxels_per_cell == 1 || !out.why_not.empty()) return;
    const bool far_apart = !out.coarser || std::abs(*out.coarser) > kMostByCells;
    if (!far_apart && share_of_thin_walls(part.voxels, kFewestCells * voxels_per_cell) < kMostThin) return;
    const int finer = finer_voxels_per_cell(voxels_per_cell, out.cells);
    const std::optional<double> other = finer > 0 ? against(finer) : out.coarser;
    if (!other || std::abs(*other) <= kMostApart) return;
    const double cell_mm = 1e3 * part.voxels.frame.pitch_m * (finer > 0 ? finer : 2 * voxels_per_cell);
    out.why_not = "on cells of " + files::short_number(cell_mm) + " mm the displacement is " +
                  files::short_number(100.0 * std::abs(*other)) + " % " + (*other > 0.0 ? "greater" : "less") +
                  ": smaller cells are needed";
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
    if (is_one_cell_thick(model)) out.why_not = kOneCellAcross;
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

// At the surface, for the lever of the straight beam, which no bent one exceeds.
double greatest_bending_strain(const PartBeam& beam, double across_N) {
    double most = 0.0;
    for (const BeamPiece& piece : beam.pieces) {
        const double lever_m =
            beam.clamped_low ? beam.pieces.back().to_m - piece.from_m : piece.to_m - beam.pieces.front().from_m;
        most = std::max(most, across_N * lever_m * 0.5 * piece.height_m / piece.section.bending_N_m2);
    }
    return most;
}

void bend_beam(const PartBeam& beam, const PartLoad& load, MethodResult& out) {
    out.why_not = beam.why_not;
    if (!out.why_not.empty()) return;
    out.answered = true;
    out.displacement_m = tip_m(beam, load, out.method);
    out.stiffness_N_per_m = load.force_N / out.displacement_m;
    const double strain = greatest_bending_strain(beam, beam.across * load.force_N);
    if (linear_range(strain) == LinearRange::red)
        out.why_not = "strains reach up to " + files::short_number(100.0 * strain) + " %, which is not small";
    const double bent_m = tip_m(beam, load, Method::euler_bernoulli);
    const double shear = tip_m(beam, load, Method::timoshenko) / bent_m - 1.0;
    if (out.method != Method::timoshenko && shear > kMostShear)
        out.why_not = "shear, which it leaves out, adds " + files::short_number(100.0 * shear) + " %";
    if (out.method == Method::timoshenko && shear > kMostSoft)
        out.why_not = "shear adds " + files::short_number(100.0 * shear) +
                      " %: stiff layers on a soft core bend by themselves, which it leaves out";
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
        if (result.method < Method::voxels && result.why_not.empty() && std::abs(*result.error) > kMostApart)
            result.why_not = "`" + result.against + "` says " + files::short_number(1e3 * best->displacement_m) +
                             " mm: the part is no such beam";
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

Validity beam_validity(const Part& part, const PartBeam& beam, const PartLoad& load, Method method) {
    const auto judge = [&](double force_N) {
        PartLoad there = load;
        there.force_N = force_N;
        MethodResult out;
        out.method = method;
        bend_beam(beam, there, out);
        if (out.why_not.empty()) out.why_not = axial_doubt(part, there);
        return out;
    };
    constexpr double kFirst = 1e-3, kMost = 1e6;  // of the load's force
    MethodResult good = judge(kFirst * load.force_N);
    if (!good.why_not.empty()) return {0.0, good.why_not};
    double low_N = kFirst * load.force_N, high_N = 2.0 * low_N;
    MethodResult bad = judge(high_N);
    while (bad.why_not.empty() && high_N < kMost * load.force_N) {
        good = bad;
        low_N = high_N;
        high_N *= 2.0;
        bad = judge(high_N);
    }
    if (bad.why_not.empty()) return {};
    while (high_N > 1.01 * low_N) {
        const double middle_N = std::sqrt(low_N * high_N);
        MethodResult result = judge(middle_N);
        const bool applies = result.why_not.empty();
        (applies ? low_N : high_N) = middle_N;
        (applies ? good : bad) = std::move(result);
    }
    return {good.displacement_m, bad.why_not};
}

Validity cell_validity(const Part& part, const PartLoad& load, const CellModel& model, const Eigen::Matrix3Xd& load_N,
                       const Eigen::Matrix3Xd& u_m, double compliance_m_per_N) {
    if (is_one_cell_thick(model)) return {0.0, kOneCellAcross};
    const CellStrain unit = greatest_strain(model, u_m);
    Validity out;
    const auto limit = [&](double to_m, const char* why_not) {
        if (to_m < out.to_m) out = {to_m, why_not};
    };
    limit(compliance_m_per_N * kMostTurn_deg / (kDegrees * unit.rotation_rad), kCellsTurn);
    limit(compliance_m_per_N * kRed / unit.strain, kCellsStrain);
    if (held_on_both_sides(model.level, load_N, largest_axis(load.direction)))
        limit(kMostHeldDepth * height_along_m(part, load), kHeldPartStretches);
    return out;
}

std::vector<MethodResult> stiffness_of(const Part& part, const PartLoad& load, const StiffnessOptions& options) {
    std::vector<MethodResult> out;
    std::optional<CellModel> model;
    Eigen::Matrix3Xd load_N;
    const std::string axial = axial_doubt(part, load);
    for (const Method method : options.methods) {
        MethodResult result;
        result.method = method;
        const double began_s = files::steady_s();
        try {
            if (method < Method::voxels) {
                bend_beam(beam_of(part, load), load, result);
            } else {
                if (!model) {
                    model = cell_model(part, voxels_per_cell(part, options.cell_m));
                    load_N = unit_load_N(part, *model, load);
                }
                solve_cells(load, *model, load_N, options.energy_error, result);
                judge_stretch(part, load, *model, load_N, result);
                judge_cells(part, load, voxels_per_cell(part, options.cell_m), result);
            }
        } catch (const MeshError& error) {
            throw files::InputError(part.file + ": " + error.what());
        } catch (const LoadError& error) {
            throw files::InputError(part.file + ": loads." + load.name + ": " + error.what());
        }
        if (result.answered && result.why_not.empty()) result.why_not = axial;
        result.time_s = files::steady_s() - began_s;
        out.push_back(result);
    }
    compare_methods(out);
    return out;
}

}  // namespace palpa::parts
