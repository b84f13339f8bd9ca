#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/loads.h"
#include "mechanics/statics.h"
#include "mechanics/voxel_load.h"
#include "mechanics/voxel_solve.h"
#include "tests/close_to.h"
#include "tests/mechanics/paper_beams.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

// Clamped at xmin, 10 N along z on xmax.
struct Cantilever {
    VoxelCells cells;
    GridLevel level;
    Eigen::Matrix3Xd load_N;
};
Cantilever cantilever(const Voxels& voxels, int voxels_per_cell, std::span<const Material> materials) {
    Cantilever out{cells_of(voxels, voxels_per_cell, materials), {}, {}};
    out.level = finest_level(out.cells);
    std::vector<std::uint8_t> fixed(at(n_nodes(out.level)), 0);
    CHECK(fix_side(voxels, out.cells, out.level, Side::xmin, 7, fixed) > 0);
    CHECK(free_motions(out.cells, out.level, fixed).empty());
    out.load_N = spread_force(out.cells, out.level, faces_on_side(voxels, Side::xmax), {0.0, 0.0, 10.0});
    fix_nodes(fixed, out.level);
    return out;
}

double tip_mm(PaperBeam kind, int along) {
    const Cantilever beam = cantilever(paper_beam(kind, along), 1, kHardAndSoft);
    const VoxelSolution solution = solve(make_multigrid(beam.level), beam.load_N, {1e-8, 500});
    CHECK(solution.converged);
    MESSAGE(along << " cells: " << solution.iterations << " iterations, " << solution.energy_error);
    return 1e3 * solution.work_J / 10.0;
}

}  // namespace

TEST_CASE("voxels: five beams of 80 x 8 x 8 cells (thirds 90 x 9 x 9) to 1e-6 of the same element elsewhere") {
    CHECK(tip_mm(PaperBeam::homogeneous, 80) == close_to(0.4816322).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::hshsh, 80) == close_to(1.0044452).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::shshs, 80) == close_to(1.4321732).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::hsh, 90) == close_to(0.5028904).epsilon(1e-6));
    CHECK(tip_mm(PaperBeam::shs, 90) == close_to(1.7670337).epsilon(1e-6));
}

TEST_CASE("voxels: full cells give every displacement of factorise() on the same mesh") {
    const Voxels voxels = paper_beam(PaperBeam::shshs, 40);
    const Cantilever beam = cantilever(voxels, 2, kHardAndSoft);  // bands of four cells
    const VoxelSolution solution = solve(make_multigrid(beam.level, 60), beam.load_N, {1e-16, 500});

    Problem problem;
    problem.mesh = hex_box(Box{{0.1, 0.01, 0.01}, {20, 2, 2}, {}});
    for (Eigen::Index cell = 0; cell < problem.mesh.cells.cols(); ++cell) {
        const auto x = static_cast<int>(cell % 20);
        problem.materials.push_back(kHardAndSoft[x / 4 % 2 == 0 ? 1 : 0]);
    }
    const Faces outer = boundary_faces(problem.mesh);
    fix(nodes_of(faces_on(problem.mesh, outer, Side::xmin)), "xyz", 0.0, problem.supports);
    const Solution reference =
        solve(factorise(problem, best_solver()),
              traction_load(problem.mesh, faces_on(problem.mesh, outer, Side::xmax), {0, 0, 1e5}));
    REQUIRE(reference.u_m.cols() == solution.u_m.cols());  // both number nodes x fastest
    CHECK((reference.u_m - solution.u_m).norm() < 1e-6 * reference.u_m.norm());

    const DirectSolution direct = solve_directly(beam.level, beam.load_N);
    CHECK(direct.backward_error < 1e-13);
    CHECK((reference.u_m - direct.u_m).norm() < 1e-9 * reference.u_m.norm());
}

TEST_CASE("voxels: the estimate of the energy error is not below the true error of what is returned") {
    const Cantilever beam = cantilever(paper_beam(PaperBeam::hshsh, 40), 1, kHardAndSoft);
    const Multigrid multigrid = make_multigrid(beam.level, 60);
    const double exact_J = solve_directly(beam.level, beam.load_N).work_J;
    for (const double wanted : {1e-1, 1e-2, 1e-3, 1e-5}) {
        CAPTURE(wanted);
        const VoxelSolution solution = solve(multigrid, beam.load_N, {wanted, 500});
        CHECK(solution.converged);
        const double error = 1.0 - solution.work_J / exact_J;  // from 0, f . u is the squared energy norm
        CHECK(error >= -1e-9);
        CHECK(error <= solution.energy_error);
    }
}

TEST_CASE("voxels: a warm start after an edit needs fewer iterations, and its work is right to second order") {
    Voxels voxels = paper_beam(PaperBeam::homogeneous, 40);
    const Cantilever before = cantilever(voxels, 1, kHardAndSoft);
    const VoxelSolution old = solve(make_multigrid(before.level, 60), before.load_N, {1e-6, 500});
    EditHistory history;
    apply({EditKind::permute, {BallRegion{{0.05, 0.005, 0.01}, 0.004}}, 1, {}}, voxels, history);
    const Cantilever after = cantilever(voxels, 1, kHardAndSoft);
    const Multigrid multigrid = make_multigrid(after.level, 60);
    const double exact_J = solve_directly(after.level, after.load_N).work_J;
    const VoxelSolution warm = solve(multigrid, after.load_N, {1e-4, 500}, old.u_m);
    const VoxelSolution cold = solve(multigrid, after.load_N, {1e-4, 500});
    CHECK(warm.iterations < cold.iterations);
    CHECK(std::abs(warm.work_J / exact_J - 1.0) < 2e-4);
}

TEST_CASE("voxels: moduli 1e6 apart end with an estimate that holds, or say that they did not converge") {
    const std::vector<Material> far{{8.3e9, 0.28}, {8.3e3, 0.394}};
    const Cantilever beam = cantilever(paper_beam(PaperBeam::hshsh, 40), 1, far);
    const double exact_J = solve_directly(beam.level, beam.load_N).work_J;
    const VoxelSolution solution = solve(make_multigrid(beam.level, 60), beam.load_N, {1e-3, 500});
    MESSAGE(solution.iterations << " iterations, error " << 1.0 - solution.work_J / exact_J);
    const double error = std::abs(solution.work_J / exact_J - 1.0);
    CHECK((!solution.converged || error < 2e-3));
    const VoxelSolution short_of = solve(make_multigrid(beam.level, 60), beam.load_N, {1e-12, 2});
    CHECK_FALSE(short_of.converged);
    CHECK(short_of.u_m.allFinite());
}

TEST_CASE("voxels: cells 1/64 full neither stop the solver nor change the answer") {
    // a beam 8 x 8 voxels thick, one more layer of single voxels here and there on top: cells with 1 of 64 voxels
    Voxels voxels = empty_voxels({80, 8, 12}, {0.1 / 80, {}});
    EditHistory history;
    apply({EditKind::add, {BoxRegion{{0, 0, 0}, {1, 1, 0.01}}}, 0, {}}, voxels, history);
    const Cantilever plain = cantilever(voxels, 4, kHardAndSoft);
    for (int x = 0; x < 80; x += 8) set_line(0, 8, {{x, x + 1, 0}}, voxels);
    const Cantilever studded = cantilever(voxels, 4, kHardAndSoft);
    CHECK(*std::min_element(studded.cells.share.begin(), studded.cells.share.end()) == close_to(1.0 / 64.0));
    const VoxelSolution one = solve(make_multigrid(plain.level, 30), plain.load_N, {1e-6, 500});
    const VoxelSolution other = solve(make_multigrid(studded.level, 30), studded.load_N, {1e-6, 500});
    CHECK(other.converged);
    CHECK(other.work_J == close_to(one.work_J).epsilon(1e-3));
}

TEST_CASE("voxels: a load of another size or with NaN is refused, no load moves nothing") {
    const Cantilever beam = cantilever(paper_beam(PaperBeam::homogeneous, 20), 1, kHardAndSoft);
    const Multigrid multigrid = make_multigrid(beam.level);
    CHECK_THROWS_AS(solve(multigrid, Eigen::Matrix3Xd::Zero(3, 2), {}), LoadError);
    Eigen::Matrix3Xd bad = beam.load_N;
    bad(0, 0) = std::nan("");
    CHECK_THROWS_AS(solve(multigrid, bad, {}), LoadError);
    const VoxelSolution none = solve(multigrid, 0.0 * beam.load_N, {});
    CHECK(none.converged);
    CHECK(none.u_m.isZero(0.0));
}
