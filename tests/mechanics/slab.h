#pragma once
// The slabs that several tests press on.

#include "mechanics/compliance.h"
#include "mechanics/contact.h"
#include "mechanics/loads.h"

namespace palpa::mechanics {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSlow = true;  // instrumented: the largest meshes are left out
#else
inline constexpr bool kSlow = false;
#endif

inline constexpr Indenter kBall{IndenterShape::sphere, 0.008};

inline Box graded_box(double width_m, double thickness_m, int n, int nz, double finest_m) {
    return {{width_m, width_m, thickness_m}, {n, n, nz}, Grading{{0.5 * width_m, 0.5 * width_m}, finest_m}};
}

// One material, bottom clamped.
inline Problem slab_problem(const Mesh& hexes, Element element, const Material& material) {
    Problem problem;
    problem.mesh = element == Element::tet4 ? split_to_tets(hexes) : hexes;
    problem.element = element;
    problem.materials.assign(static_cast<std::size_t>(problem.mesh.cells.cols()), material);
    const Faces outer = boundary_faces(problem.mesh);
    fix(nodes_of(faces_on(problem.mesh, outer, Side::zmin)), "xyz", 0.0, problem.supports);
    return problem;
}

inline int nearest_node(const Mesh& mesh, double x_m, double y_m, double z_m) {
    Eigen::Index nearest = 0;
    (mesh.nodes_m.colwise() - Eigen::Vector3d(x_m, y_m, z_m)).colwise().squaredNorm().minCoeff(&nearest);
    return static_cast<int>(nearest);
}

// The slab of the CalculiX decks: 1000 times stiffer sphere inside, off-centre parabolic load.
inline Problem calculix_problem(Element element) {
    const Mesh hexes = hex_box(graded_box(0.1, 0.05, 6, 4, 0.008));
    Problem problem = slab_problem(hexes, element, {2500.0, 0.45});
    assign_sphere({{0.05, 0.05, 0.03}, 0.015}, 1, problem.mesh);
    const Material list[2] = {{2500.0, 0.45}, {2.5e6, 0.3}};
    problem.materials = materials_of_cells(problem.mesh.region, list);
    return problem;
}

inline ParabolicPressure calculix_pressure() { return {Side::zmax, {0.047, 0.052}, 0.03, 0.025}; }

inline Compliance slab_compliance(const Problem& problem, const std::array<double, 4>& touch_m,
                                  bool tangential = false) {
    SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), touch_m);
    request.tangential = tangential;
    return surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
}

}  // namespace palpa::mechanics
