#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/error.h"
#include "mechanics/voxel_cells.h"
#include "tests/close_to.h"
#include "tests/mechanics/paper_beams.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

Hex cube(double edge_m) {
    Hex corners;
    corners << 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1;
    return edge_m * corners;
}

}  // namespace

TEST_CASE("voxel cells: a full cell of one material is hex8 with B-bar, whatever its voxels") {
    const Material material{3e9, 0.45};
    for (const int k : {1, 2, 5}) {
        CAPTURE(k);
        Voxels voxels = empty_voxels({k, k, k}, {0.002 / k, {}});
        EditHistory history;
        apply({EditKind::add, {EverywhereRegion{}}, 0, {}}, voxels, history);
        const VoxelCells cells = cells_of(voxels, k, std::span(&material, 1));
        REQUIRE(cells.stiffness_N_per_m.size() == 1);
        const HexMatrix reference = hex8_bbar_stiffness_N_per_m(cube(0.002), material);
        CHECK((cells.stiffness_N_per_m[0] - reference).norm() < 1e-14 * reference.norm());
        CHECK(cells.share[0] == 1.0);
    }
}

TEST_CASE(
    "voxel cells: random voxels give a symmetric matrix without force on rigid motions, and the energy of a strain") {
    constexpr unsigned kSeed = 7;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    Voxels voxels = empty_voxels({4, 4, 4}, {0.25, {}});
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 4; ++y)
            set_line(y, z, {{0, 1 + static_cast<int>(random() % 3), static_cast<int>(random() % 2)}}, voxels);
    const VoxelCells cells = cells_of(voxels, 4, kHardAndSoft);
    const HexMatrix& K = cells.stiffness_N_per_m[0];
    CHECK((K - K.transpose()).norm() < 1e-14 * K.norm());
    const Hex corners = cube(1.0);
    Hex moved, turned, stretched;
    moved.setOnes();
    for (int a = 0; a < 8; ++a) {
        turned.col(a) = Eigen::Vector3d(0.3, -0.2, 0.5).cross(corners.col(a));
        stretched.col(a) = Eigen::Vector3d(1e-3, -2e-4, 3e-4).cwiseProduct(corners.col(a));
    }
    CHECK((K * moved.reshaped()).norm() < 1e-12 * K.norm());
    CHECK((K * turned.reshaped()).norm() < 1e-12 * K.norm());
    // a uniform strain has at most the energy of the materials' volumes, and of the soft fill; of one material just that
    const VoxelCounts counts = count(voxels, 2);
    Voigt strain;
    strain << 1e-3, -2e-4, 3e-4, 0.0, 0.0, 0.0;
    double energy_J = 0.0;
    for (std::size_t m = 0; m < 2; ++m)
        energy_J +=
            static_cast<double>(counts.of_material[m]) / 64.0 * 0.5 * strain.dot(stress_Pa(kHardAndSoft[m], strain));
    const double mixed_J = 0.5 * stretched.reshaped().dot(K * stretched.reshaped());
    CHECK(mixed_J < energy_J);
    CHECK(mixed_J > 0.5 * energy_J);
    const std::array<Material, 2> alike{kHardAndSoft[0], kHardAndSoft[0]};
    const HexMatrix one = cells_of(voxels, 4, alike).stiffness_N_per_m[0];
    const auto filled = static_cast<double>(counts.of_material[0] + counts.of_material[1]);
    const double one_J = filled / 64.0 * 0.5 * strain.dot(stress_Pa(alike[0], strain));
    CHECK(0.5 * stretched.reshaped().dot(one * stretched.reshaped()) == close_to(one_J).epsilon(1e-5));
}

TEST_CASE(
    "voxel cells: layers within a cell stretch and shear one behind the other, and side by side along themselves") {
    const std::array<Material, 2> materials{Material{8e9, 0.0}, Material{2e9, 0.0}};
    for (int axis = 0; axis < 3; ++axis) {
        CAPTURE(axis);
        Voxels voxels = empty_voxels({4, 4, 4}, {0.25, {}});
        for (int z = 0; z < 4; ++z) {  // one layer in four is soft
            for (int y = 0; y < 4; ++y) {
                const int material = (axis == 1 && y == 1) || (axis == 2 && z == 1) ? 1 : 0;
                if (axis == 0)
                    set_line(y, z, {{0, 1, 0}, {1, 2, 1}, {2, 4, 0}}, voxels);
                else
                    set_line(y, z, {{0, 4, material}}, voxels);
            }
        }
        const VoxelCells cells = cells_of(voxels, 4, materials);
        const HexMatrix& K = cells.stiffness_N_per_m[0];
        const Hex corners = cube(1.0);
        const auto energy_J = [&](int moved, int over) {  // of the displacement u_moved = x_over
            Hex u = Hex::Zero();
            u.row(moved) = corners.row(over);
            return u.reshaped().dot(K * u.reshaped());
        };
        const int along = (axis + 1) % 3;
        const double series_Pa = 1.0 / (0.75 / 8e9 + 0.25 / 2e9), parallel_Pa = 0.75 * 8e9 + 0.25 * 2e9;
        CHECK(energy_J(axis, axis) == close_to(series_Pa).epsilon(1e-9));
        CHECK(energy_J(along, axis) == close_to(0.5 * series_Pa).epsilon(1e-9));
        CHECK(energy_J(along, along) == close_to(parallel_Pa).epsilon(1e-9));
    }
}

TEST_CASE("voxel cells: equal patterns share a matrix, empty cells are left out") {
    const VoxelCells bands = cells_of(paper_beam(PaperBeam::hshsh, 100), 2, kHardAndSoft);
    CHECK(bands.place.size() == 50 * 5 * 5);
    CHECK(bands.stiffness_N_per_m.size() == 2);
    const VoxelCells wide = cells_of(paper_beam(PaperBeam::hshsh, 100), 3, kHardAndSoft);
    CHECK(wide.n == std::array<int, 3>{34, 4, 4});
    CHECK(wide.cell_m == close_to(0.003));
    Voxels hollow = paper_beam(PaperBeam::homogeneous, 100);
    EditHistory history;
    apply({EditKind::remove, {BoxRegion{{0.02, 0.004, 0.004}, {0.04, 0.008, 0.008}}}, 0, {}}, hollow, history);
    CHECK(cells_of(hollow, 2, kHardAndSoft).place.size() == 50 * 5 * 5 - 10 * 2 * 2);
}

TEST_CASE("voxel cells: no voxels, no cells, materials that are not there or not elastic are refused") {
    const Voxels voxels = paper_beam(PaperBeam::hshsh, 20);
    CHECK_THROWS_AS(cells_of(voxels, 0, kHardAndSoft), MeshError);
    CHECK_THROWS_AS(cells_of(voxels, 1, std::span(kHardAndSoft).first(1)), MaterialError);
    CHECK_THROWS_AS(cells_of(voxels, 1, std::vector<Material>{{1.0, 0.5}, {1.0, 0.3}}), MaterialError);
    CHECK_THROWS_AS(cells_of(empty_voxels({3, 3, 3}, {1.0, {}}), 1, kHardAndSoft), MeshError);
}
