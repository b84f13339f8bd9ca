#pragma once
// The surface compliance: how the surface's nodes move under unit forces on them. It is computed once, so that contact
// is fast afterwards. Of the responses in operators.h it holds those between nodes of the surface.
//
// Source: James & Pai, "A unified treatment of elastostatic contact simulation for real time haptics",
// Haptics-e 2(1), 2001.

#include <cstdint>
#include <vector>

#include "mechanics/operators.h"

namespace palpa::mechanics {

struct SurfaceRequest {
    std::vector<int> touch_nodes;  // mesh nodes that a tool can touch; one column each (three with tangential)
    std::vector<int> other_nodes;  // further nodes whose depression is wanted: rows without a column
    bool tangential = false;       // asks also for all three components between touch nodes, for friction
    bool sideways = false;         // asks also how pressing moves the surface along x and y, for steady sliding
    int block = 64;                // right-hand sides solved at once
};

// Returns a request for the nodes of the side zmax: those inside the rectangle (x_min, x_max, y_min, y_max) are touch
// nodes, the rest other nodes.
SurfaceRequest request_rectangle(const Mesh& mesh, const Faces& outer, const std::array<double, 4>& touch_m);

// Plain data: may be stored and read back (under `fingerprint`).
struct Compliance {
    // Identifies the content, by a number from new_revision(): what ContactWork remembers is used again only for the
    // same revision, and never for 0. Code that changes the content sets a new revision.
    std::uint64_t revision = 0;
    int n_touch = 0;
    std::vector<int> node;        // mesh nodes, n_surface of them, the touch nodes first
    Eigen::Matrix3Xd position_m;  // at rest, 3 x n_surface
    Eigen::VectorXd area_m2;      // tributary area, n_surface
    double surface_z_m = 0.0;     // z of the highest node: the plane from which depths count
    double thickness_m = 0.0;     // from there down to the lowest node of the mesh
    // Depression (towards -z) at row per newton pressing (towards -z) at column: n_surface x n_touch.
    Eigen::MatrixXd normal_m_per_N;
    // Displacement along +x (+y) at row per newton pressing at column, n_surface x n_touch; empty unless asked for by
    // `sideways`. By Maxwell-Betti also the depression at column per newton along +x (+y) at row.
    Eigen::MatrixXd along_x_m_per_N;
    Eigen::MatrixXd along_y_m_per_N;
    // Between touch nodes only, 3 n_touch x 3 n_touch; empty unless asked for by `tangential`. Row and column 3 k + c
    // belong to touch node k: c = 0 into the tissue, 1 along x, 2 along y.
    Eigen::MatrixXd full_m_per_N;
    double asymmetry = 0.0;  // max |C - C^T| / max |C| before C was made symmetric
};

// Returns a number that no other content in this process has. May be called from any thread.
std::uint64_t new_revision();

// Throws LoadError for a request without touch nodes or with nodes that the mesh does not have, Cancelled when asked to
// stop, and SolverError if the result is not symmetric to 1e-9 (a damaged factorisation). May run in a worker thread;
// MUMPS is locked for one block at a time.
Compliance surface_compliance(const Mesh& mesh, const Factored& factored, const SurfaceRequest& request,
                              const Progress& progress = {});

// Returns the 64-bit FNV-1a hash of everything that the compliance depends on and of the version of its format. Equal
// inputs give equal numbers.
std::uint64_t fingerprint(const Problem& problem, const SurfaceRequest& request);

}  // namespace palpa::mechanics
