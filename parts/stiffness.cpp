#include "parts/stiffness.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "files/clock.h"
#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/beam.h"
#include "mechanics/error.h"
#include "mechanics/linear_range.h"
#include "mechanics/voxel_load.h"
#include "mechanics/voxel_solve.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

// Cells with supports and the load's nodal forces for 1 N.
struct CellModel {
    VoxelCells cells;
    GridLevel level;
    Eigen::Matrix3Xd load_N;
};

int largest_axis(const Point& direction) {
    int axis = 0;
    for (int c = 1; c < 3; ++c) {
        if (std::abs(direction[static_cast<std::size_t>(c)]) > std::abs(direction[static_cast<std::size_t>(axis)]))
            axis = c;
    }
    return axis;
}

VoxelFaces loaded_faces(const Part& part, const PartLoad& load) {
    const std::string key = "loads." + load.name;
    if (load.face) return faces_on_side(part.voxels, *load.face);
    const int axis = largest_axis(load.direction);
    const bool up = load.direction[static_cast<std::size_t>(axis)] < 0.0;  // the surface looks against the force
    VoxelFaces faces = faces_near(part.voxels, load.at_m, 0.5 * load.patch_m, axis, up);
    if (faces.centre_m.empty()) {
        throw files::bad_input(part.file, key + ".at_mm", "a force on air: no voxel's surface within patch_mm / 2",
                               "a place on the surface that looks against the direction");
    }
    return faces;
}

CellModel model_of(const Part& part, const PartLoad& load, int voxels_per_cell) {
    const std::vector<Material> materials = elastic_of(part);
    CellModel out{cells_of(part.voxels, voxels_per_cell, materials), {}, {}};
    out.level = finest_level(out.cells);
    std::vector<std::uint8_t> fixed(out.level.node_place.size(), 0);
    for (std::size_t i = 0; i < part.supports.size(); ++i) {
        const PartSupport& support = part.supports[i];
        const int n = support.face ? fix_side(part.voxels, out.cells, out.level, *support.face, support.axes, fixed)
                                   : fix_region(out.cells, out.level, support.region, support.axes, fixed);
        if (n == 0) {
            throw files::bad_input(part.file, "supports[" + std::to_string(i) + "]", "no node of a cell in it",
                                   "a region that holds a corner of a cell (smaller cells, or a larger region)");
        }
    }
    const std::string loose = free_motions(out.cells, out.level, fixed);
    if (!loose.empty())
        throw files::bad_input(part.file, "supports", "a part that " + loose, "supports that hold the part");
    out.load_N = spread_force(out.cells, out.level, loaded_faces(part, load), load.direction);
    fix_nodes(fixed, out.level);
    return out;
}

// Largest principal strain in the middle of cells that are at least half full.
double max_strain(const CellModel& model, const Eigen::Matrix3Xd& u_m) {
    double largest = 0.0;
    const NodeNumbers number(model.level);
    for (std::size_t i = 0; i < model.cells.place.size(); ++i) {
        if (model.cells.share[static_cast<std::size_t>(model.cells.pattern[i])] < 0.5) continue;
        const auto& p = model.cells.place[i];
        Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
        for (int corner = 0; corner < 8; ++corner) {
            const Eigen::Vector3i side(corner & 1, corner >> 1 & 1, corner >> 2);
            const int node = number(p[0] + side(0), p[1] + side(1), p[2] + side(2));
            gradient += u_m.col(node) * (2.0 * side.cast<double>().transpose().array() - 1.0).matrix();
        }
        gradient *= 0.25 / model.cells.cell_m;
        const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
        if (strain.norm() <= largest) continue;  // no principal strain is above the norm
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(strain, Eigen::EigenvaluesOnly);
        largest = std::max(largest, eigen.eigenvalues().cwiseAbs().maxCoeff());
    }
    return largest;
}

void judge_strain(MethodResult& result) {
    if (linear_range(result.max_strain) == LinearRange::red)
        result.why_not = "strains reach " + files::short_number(100.0 * result.max_strain) + " %, which is not small";
}

void solve_cells(const PartLoad& load, const CellModel& model, double energy_error, MethodResult& out) {
    Eigen::Matrix3Xd u_m;
    double compliance = 0.0;  // m/N
    if (out.method == Method::factorised) {
        const DirectSolution solution = solve_directly(model.level, model.load_N);
        u_m = solution.u_m;
        compliance = solution.work_J;
        out.energy_error = solution.backward_error;
    } else {
        const Multigrid multigrid = make_multigrid(model.level);
        const VoxelSolution solution = solve(multigrid, model.load_N, {energy_error, 500});
        u_m = solution.u_m;
        compliance = solution.work_J;
        out.energy_error = solution.energy_error;
        out.iterations = solution.iterations;
        out.converged = solution.converged;
        out.memory_bytes = memory_bytes(multigrid);
    }
    out.answered = compliance > 0.0;
    out.displacement_m = compliance * load.force_N;
    out.stiffness_N_per_m = 1.0 / compliance;
    out.cells = static_cast<std::int64_t>(model.cells.place.size());
    out.max_strain = load.force_N * max_strain(model, u_m);
    judge_strain(out);
}

// Where the beam begins and ends: at its clamp and under the load.
struct BeamSpan {
    double low_m = 0.0;
    double high_m = 0.0;
    bool clamped_low = true;
    std::string why_not;
};

double load_place_m(const Part& part, const PartLoad& load, std::size_t axis, const FilledBox& box) {
    const double h = part.voxels.frame.pitch_m;
    if (!load.face) return load.at_m[axis];
    if (axis_of(*load.face) != static_cast<int>(axis)) return 0.5 * (box.low[axis] + box.high[axis]) * h;
    return (is_max(*load.face) ? box.high[axis] : box.low[axis]) * h;
}

// The clamp is one support that holds x, y and z: a side square to the axis, or a box, whose side towards the load counts.
BeamSpan beam_span(const Part& part, const PartLoad& load) {
    if (!part.axis) return {0, 0, true, "the part names no axis"};
    if (largest_axis(load.direction) == *part.axis) return {0, 0, true, "the load is along the axis"};
    const BeamSpan unclamped{0, 0, true, "the part is not clamped by one side square to its axis, or one box"};
    if (part.supports.size() != 1 || part.supports[0].axes != 7) return unclamped;
    const PartSupport& support = part.supports[0];
    const auto axis = static_cast<std::size_t>(*part.axis);
    const FilledBox box = filled_box(part.voxels);
    const double h = part.voxels.frame.pitch_m, load_m = load_place_m(part, load, axis, box);
    double low_m = box.low[axis] * h, high_m = box.high[axis] * h;  // of the clamp
    if (support.face) {
        if (axis_of(*support.face) != *part.axis) return unclamped;
        if (is_max(*support.face)) {
            low_m = high_m;
        } else {
            high_m = low_m;
        }
    } else {
        const auto* held = std::get_if<BoxRegion>(&support.region.shape);
        if (held == nullptr) return unclamped;
        low_m = std::max(low_m, held->min_m[axis]);
        high_m = std::min(high_m, held->max_m[axis]);
    }
    if (load_m > high_m + h) return {high_m, load_m, true, ""};
    if (load_m < low_m - h) return {load_m, low_m, false, ""};
    return {0, 0, true, "the load is at the clamp"};
}

void bend_beam(const Part& part, const PartLoad& load, MethodResult& out) {
    const BeamSpan span = beam_span(part, load);
    out.why_not = span.why_not;
    if (!out.why_not.empty()) return;
    std::vector<BeamPiece> pieces;
    try {
        pieces = beam_pieces(part.voxels, elastic_of(part), *part.axis, largest_axis(load.direction), span.low_m,
                             span.high_m);
    } catch (const MeshError& error) {
        out.why_not = error.what();
        return;
    }
    const BeamTip tip = beam_tip(pieces, span.clamped_low, out.method == Method::timoshenko);
    const double along = std::abs(load.direction[static_cast<std::size_t>(largest_axis(load.direction))]);
    out.answered = true;
    out.displacement_m =
        tip.m_per_N * load.force_N * along * along;  // the part of the force that bends, and of the path
    out.stiffness_N_per_m = load.force_N / out.displacement_m;
    const double length_m = span.high_m - span.low_m;
    double height_m = 0.0;
    for (const BeamPiece& piece : pieces) height_m = std::max(height_m, piece.height_m);
    const double chord_deg = std::atan(out.displacement_m / length_m) * 180.0 / 3.14159265358979323846;
    if (length_m < kLeastSlenderness * height_m)
        out.why_not = "length over height is " + files::short_number(length_m / height_m) + ", below 5";
    if (chord_deg > kMostChord_deg)
        out.why_not = "the chord turns by " + files::short_number(chord_deg) + " degrees, above 10";
}

int voxels_per_cell(const Part& part, const std::optional<double>& cell_m) {
    if (!cell_m) return part.voxels_per_cell;
    const double n = *cell_m / part.voxels.frame.pitch_m;
    if (!(std::round(n) >= 1.0 && n < 1e4 && std::abs(n - std::round(n)) < 1e-6 * n)) {
        throw files::bad_input(
            part.file, "cell size", files::short_number(n) + " voxels",
            "a whole number of voxels of " + files::short_number(1e3 * part.voxels.frame.pitch_m) + " mm");
    }
    return static_cast<int>(std::lround(n));
}

// Compares with the factorisation, or with `voxels`, whichever was asked for.
void compare_methods(std::vector<MethodResult>& results) {
    const MethodResult* best = nullptr;
    for (const MethodResult& result : results) {
        if (result.answered && result.converged && result.method >= Method::voxels &&
            (best == nullptr || result.method > best->method))
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
        case Method::euler_bernoulli:
            return "euler-bernoulli";
        case Method::timoshenko:
            return "timoshenko";
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
    for (const Method method : options.methods) {
        MethodResult result;
        result.method = method;
        const double began_s = files::steady_s();
        try {
            if (method == Method::euler_bernoulli || method == Method::timoshenko) {
                bend_beam(part, load, result);
            } else {
                if (!model) model = model_of(part, load, voxels_per_cell(part, options.cell_m));
                solve_cells(load, *model, options.energy_error, result);
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
