#pragma once
// What the surface does under unit forces: the precomputed answer that makes contact fast. Of the responses in
// operators.h these are the ones between the surface's nodes.
//
// Source: James & Pai, "A unified treatment of elastostatic contact simulation for real time haptics",
// Haptics-e 2(1), 2001.

#include <cstdint>
#include <vector>

#include "mechanics/operators.h"

namespace palpa::mechanics {

struct SurfaceRequest {
    std::vector<int> touch_nodes;  // mesh nodes that a tool can touch; one column each (three with tangential)
    std::vector<int> other_nodes;  // further nodes whose depression is wanted; rows only
    bool tangential = false;       // also all three components between touch nodes, for friction
    bool sideways = false;         // also how pressing moves the surface along x and y, for steady sliding
    int block = 64;                // right-hand sides solved at once
};

// Part of the surface zmax: touch nodes inside the rectangle (x_min, x_max, y_min, y_max), the others outside
// it.
SurfaceRequest request_rectangle(const Mesh& mesh, const Faces& outer, const std::array<double, 4>& touch_m);

// Plain data: may be stored and read back (under `fingerprint`).
struct Compliance {
    // Which content this is, from new_revision(); what is remembered of a contact belongs to one revision. 0: not
    // told, nothing is remembered. Whoever changes the numbers gives a new one.
    std::uint64_t revision = 0;
    int n_touch = 0;
    std::vector<int> node;        // mesh nodes, n_surface of them, the touch nodes first
    Eigen::Matrix3Xd position_m;  // at rest
    Eigen::VectorXd area_m2;      // tributary
    double surface_z_m = 0.0;     // highest node: the plane that depths are counted from
    double thickness_m = 0.0;     // down to the lowest node of the mesh
    // Depression (towards -z) at row per newton pressing (towards -z) at column: n_surface x n_touch.
    Eigen::MatrixXd normal_m_per_N;
    // Displacement along +x (+y) at row per newton pressing at column, n_surface x n_touch; empty unless asked
    // for sideways. By Maxwell-Betti also the depression at column per newton along +x (+y) at row.
    Eigen::MatrixXd along_x_m_per_N;
    Eigen::MatrixXd along_y_m_per_N;
    // Touch nodes only, 3 n_touch squared, empty unless asked for. Row 3 k + c: c = 0 into the tissue, 1
    // along x, 2 along y.
    Eigen::MatrixXd full_m_per_N;
    double asymmetry = 0.0;  // max |C - C^T| / max |C| before it was made symmetric
};

// A number that no other content in this process has. May be called from any thread.
std::uint64_t new_revision();

// Throws Cancelled when asked to stop, SolverError when the result is not symmetric to 1e-9 (a damaged
// factorisation). May run in a worker thread; MUMPS is locked one block at a time.
Compliance surface_compliance(const Mesh& mesh, const Factored& factored, const SurfaceRequest& request,
                              const Progress& progress = {});

// 64-bit FNV-1a over everything the compliance depends on, and this format's version. Equal inputs, equal
// number.
std::uint64_t fingerprint(const Problem& problem, const SurfaceRequest& request);

}  // namespace palpa::mechanics
