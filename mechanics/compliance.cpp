#include "mechanics/compliance.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

constexpr std::uint64_t kFormatVersion = 1;

// Component c of a surface node: 0 into the tissue, 1 along x, 2 along y.
NodeWeight component(int node, int c) { return c == 0 ? NodeWeight{node, 2, -1.0} : NodeWeight{node, c - 1, 1.0}; }

Compliance empty_compliance(const Mesh& mesh, const SurfaceRequest& request) {
    Compliance out;
    out.revision = new_revision();
    out.n_touch = static_cast<int>(request.touch_nodes.size());
    out.node = request.touch_nodes;
    out.node.insert(out.node.end(), request.other_nodes.begin(), request.other_nodes.end());
    const Eigen::VectorXd area = tributary_area_m2(mesh, faces_on(mesh, boundary_faces(mesh), Side::zmax));
    const auto n_surface = static_cast<Index>(out.node.size());
    out.position_m.resize(3, n_surface);
    out.area_m2.resize(n_surface);
    for (Index i = 0; i < n_surface; ++i) {
        const int node = out.node[static_cast<std::size_t>(i)];
        out.position_m.col(i) = mesh.nodes_m.col(node);
        out.area_m2(i) = area(node);
    }
    out.surface_z_m = mesh.nodes_m.row(2).maxCoeff();
    out.thickness_m = out.surface_z_m - mesh.nodes_m.row(2).minCoeff();
    out.normal_m_per_N.resize(n_surface, out.n_touch);
    if (request.tangential) out.full_m_per_N.resize(3 * out.n_touch, 3 * out.n_touch);
    if (request.sideways) {
        out.along_x_m_per_N.resize(n_surface, out.n_touch);
        out.along_y_m_per_N.resize(n_surface, out.n_touch);
    }
    return out;
}

void check_request(const Mesh& mesh, const SurfaceRequest& request) {
    if (request.touch_nodes.empty() || request.block < 1) {
        throw LoadError(text("compliance: ", request.touch_nodes.size(), " touch nodes in blocks of ", request.block,
                             "; wanted at least one of each"));
    }
    for (const auto* list : {&request.touch_nodes, &request.other_nodes}) {
        for (const int node : *list) {
            if (node >= 0 && node < mesh.nodes_m.cols()) continue;
            throw LoadError(text("compliance: node ", node, " is not one of the mesh's ", mesh.nodes_m.cols()));
        }
    }
}

// Stores the requested rows of one solved column in the matrices.
void store_column(const Reduction& reduction, const Eigen::Ref<const Eigen::VectorXd>& q, int column, bool tangential,
                  Compliance& out) {
    const int touched = tangential ? column / 3 : column;
    const int direction = tangential ? column % 3 : 0;
    const auto row = [&](int i, int c) {
        return response(reduction, component(out.node[static_cast<std::size_t>(i)], c), q);
    };
    if (direction == 0) {
        for (int i = 0; i < out.normal_m_per_N.rows(); ++i) out.normal_m_per_N(i, touched) = row(i, 0);
        for (int i = 0; i < out.along_x_m_per_N.rows(); ++i) {
            out.along_x_m_per_N(i, touched) = row(i, 1);
            out.along_y_m_per_N(i, touched) = row(i, 2);
        }
    }
    if (!tangential) return;
    for (int i = 0; i < out.n_touch; ++i) {
        for (int c = 0; c < 3; ++c) out.full_m_per_N(3 * i + c, column) = row(i, c);
    }
}

// Averages a matrix with its transpose. Returns max |C - C^T| / max |C|.
double make_symmetric(Eigen::Ref<Eigen::MatrixXd> C) {
    double asymmetry = 0.0;
    double largest = 0.0;
    for (Index j = 0; j < C.cols(); ++j) {
        largest = std::max(largest, std::abs(C(j, j)));
        for (Index i = j + 1; i < C.rows(); ++i) {
            asymmetry = std::max(asymmetry, std::abs(C(i, j) - C(j, i)));
            C(i, j) = C(j, i) = 0.5 * (C(i, j) + C(j, i));
        }
    }
    return largest > 0.0 ? asymmetry / largest : std::numeric_limits<double>::infinity();
}

struct Fnv {
    std::uint64_t hash = 14695981039346656037ull;
    void add(const void* data, std::size_t bytes) {
        const auto* byte = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ byte[i]) * 1099511628211ull;
    }
    template <class T>
    void add_list(const T* data, std::size_t n) {
        const auto count = static_cast<std::uint64_t>(n);
        add(&count, sizeof count);
        if (n > 0) add(data, n * sizeof(T));
    }
};

}  // namespace

std::uint64_t new_revision() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

SurfaceRequest request_rectangle(const Mesh& mesh, const Faces& outer, const std::array<double, 4>& touch_m) {
    SurfaceRequest request;
    for (const int node : nodes_of(faces_on(mesh, outer, Side::zmax))) {
        const double x = mesh.nodes_m(0, node);
        const double y = mesh.nodes_m(1, node);
        const bool inside = x >= touch_m[0] && x <= touch_m[1] && y >= touch_m[2] && y <= touch_m[3];
        (inside ? request.touch_nodes : request.other_nodes).push_back(node);
    }
    return request;
}

Compliance surface_compliance(const Mesh& mesh, const Factored& factored, const SurfaceRequest& request,
                              const Progress& progress) {
    check_request(mesh, request);
    Compliance out = empty_compliance(mesh, request);
    const int per_node = request.tangential ? 3 : 1;
    std::vector<NodeSum> loads;
    for (const int node : request.touch_nodes) {
        for (int c = 0; c < per_node; ++c) loads.push_back({component(node, c)});
    }
    solve_loads(factored, loads, request.block, progress,
                [&](int column, const Eigen::Ref<const Eigen::VectorXd>& q_m) {
                    store_column(factored.reduction, q_m, column, request.tangential, out);
                });
    out.asymmetry = make_symmetric(out.normal_m_per_N.topRows(out.n_touch));
    if (request.tangential) out.asymmetry = std::max(out.asymmetry, make_symmetric(out.full_m_per_N));
    if (!(out.asymmetry < 1e-9) || !out.normal_m_per_N.allFinite()) {
        throw SolverError(text("compliance: not symmetric, |C - C^T| / |C| = ", out.asymmetry, ", must be < 1e-9"), 0);
    }
    return out;
}

std::uint64_t fingerprint(const Problem& problem, const SurfaceRequest& request) {
    Fnv fnv;
    const auto element = static_cast<std::uint64_t>(problem.element);
    const std::uint64_t asked = (request.tangential ? 1u : 0u) + (request.sideways ? 2u : 0u);
    const std::uint64_t flags[3] = {kFormatVersion, element, asked};
    fnv.add_list(flags, 3);
    fnv.add_list(problem.mesh.nodes_m.data(), static_cast<std::size_t>(problem.mesh.nodes_m.size()));
    fnv.add_list(problem.mesh.cells.data(), static_cast<std::size_t>(problem.mesh.cells.size()));
    fnv.add_list(problem.materials.data(), problem.materials.size());
    fnv.add_list(&problem.rigid_contrast, 1);
    fnv.add_list(problem.supports.dof.data(), problem.supports.dof.size());
    fnv.add_list(problem.supports.value_m.data(), problem.supports.value_m.size());
    fnv.add_list(request.touch_nodes.data(), request.touch_nodes.size());
    fnv.add_list(request.other_nodes.data(), request.other_nodes.size());
    return fnv.hash;
}

}  // namespace palpa::mechanics
