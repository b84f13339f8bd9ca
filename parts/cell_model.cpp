#include "parts/cell_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

VoxelFaces loaded_faces(const Part& part, const PartLoad& load) {
    if (load.face) return faces_on_side(part.voxels, *load.face);
    const int axis = largest_axis(load.direction);
    const bool up = load.direction[static_cast<std::size_t>(axis)] < 0.0;  // the surface looks against the force
    VoxelFaces faces = faces_near(part.voxels, load.at_m, 0.5 * load.patch_m, axis, up);
    if (faces.centre_m.empty()) {
        throw files::bad_input(part.file, "loads." + load.name + ".at_mm",
                               "a force on air: no voxel's surface within patch_mm / 2",
                               "a place on the surface that looks against the direction");
    }
    return faces;
}

// Gradient of the displacement in the middle of a cell: row = axis of the displacement, column = axis of the slope.
Eigen::Matrix3d middle_gradient(const VoxelCells& cells, std::size_t cell, const NodeNumbers& number,
                                const Eigen::Matrix3Xd& u_m) {
    const auto& p = cells.place[cell];
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i side(corner & 1, corner >> 1 & 1, corner >> 2);
        const int node = number(p[0] + side(0), p[1] + side(1), p[2] + side(2));
        gradient += u_m.col(node) * (2.0 * side.cast<double>().transpose().array() - 1.0).matrix();
    }
    return gradient * 0.25 / cells.cell_m;
}

}  // namespace

int largest_axis(const Point& direction) {
    int axis = 0;
    for (int c = 1; c < 3; ++c) {
        if (std::abs(direction[static_cast<std::size_t>(c)]) > std::abs(direction[static_cast<std::size_t>(axis)]))
            axis = c;
    }
    return axis;
}

CellModel cell_model(const Part& part, int voxels_per_cell) {
    const std::vector<Material> materials = elastic_of(part);
    CellModel out{cells_of(part.voxels, voxels_per_cell, materials), {}};
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
    fix_nodes(fixed, out.level);
    return out;
}

Eigen::Matrix3Xd unit_load_N(const Part& part, const CellModel& model, const PartLoad& load) {
    return spread_force(model.cells, model.level, loaded_faces(part, load), load.direction);
}

CellStrain greatest_strain(const CellModel& model, const Eigen::Matrix3Xd& u_m) {
    CellStrain out;
    const NodeNumbers number(model.level);
    for (std::size_t i = 0; i < model.cells.place.size(); ++i) {
        if (model.cells.share[static_cast<std::size_t>(model.cells.pattern[i])] < 0.5) continue;
        const Eigen::Matrix3d gradient = middle_gradient(model.cells, i, number, u_m);
        const Eigen::Matrix3d twist = 0.5 * (gradient - gradient.transpose());
        out.rotation_rad = std::max(out.rotation_rad, twist.norm() / std::sqrt(2.0));
        const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
        if (strain.norm() <= out.strain) continue;  // no principal strain is above the norm
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(strain, Eigen::EigenvaluesOnly);
        out.strain = std::max(out.strain, eigen.eigenvalues().cwiseAbs().maxCoeff());
    }
    return out;
}

int voxels_per_cell(const Part& part, const std::optional<double>& cell_m) {
    if (!cell_m) return part.voxels_per_cell;
    const double n = *cell_m / part.voxels.frame.pitch_m;
    if (!(std::round(n) >= 1.0 && n < 1e4 && std::abs(n - std::round(n)) < 1e-6 * n)) {
        throw files::bad_input(part.file, "cell size", files::short_number(n) + " voxels",
                               "a whole number of voxels of " + files::short_number(1e3 * part.voxels.frame.pitch_m) +
                                   " mm, fewer than 10,000");
    }
    return static_cast<int>(std::lround(n));
}

}  // namespace palpa::parts
