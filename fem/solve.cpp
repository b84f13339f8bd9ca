#include "fem/solve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unordered_set>

#include "fem/mesh_file.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "mechanics/face_point.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// The centre of a load, and the faces that the load acts on.
struct LoadCentre {
    Vector3d at_m;
    Faces faces;
    double width_m = 0.0;  // of the loaded patch; 0 if not known
};

struct Loads {
    Matrix3Xd force_N;
    double applied_N = 0.0;
    bool partial = false;
    std::optional<LoadCentre> centre;
};

Vector3d centre_on_side(const Mesh& mesh, Side side, const std::array<double, 2>& centre_m) {
    Vector3d at;
    const int axis = axis_of(side);
    at(axis) = is_max(side) ? mesh.nodes_m.row(axis).maxCoeff() : mesh.nodes_m.row(axis).minCoeff();
    at(axis == 0 ? 1 : 0) = centre_m[0];
    at(axis == 2 ? 1 : 2) = centre_m[1];
    return at;
}

void add_pressures(const FemCase& model, Loads& loads) {
    const Mesh& mesh = model.problem.mesh;
    for (const ParabolicPressure& pressure : model.pressures) {
        const PressureLoad load = parabolic_load(mesh, model.outer, pressure, LoadShare::consistent);
        loads.force_N += load.force_N;
        loads.applied_N += std::abs(load.applied_N);
        loads.partial = loads.partial || load.partial;
        if (loads.centre) continue;
        loads.centre = LoadCentre{centre_on_side(mesh, pressure.side, pressure.centre_m),
                                  faces_on(mesh, model.outer, pressure.side), pressure.diameter_m};
    }
}

void add_tractions(const FemCase& model, Loads& loads) {
    const Mesh& mesh = model.problem.mesh;
    for (const CaseTraction& traction : model.tractions) {
        const Eigen::VectorXd area_m2 = tributary_area_m2(mesh, traction.faces);
        const Vector3d t(traction.vector_Pa[0], traction.vector_Pa[1], traction.vector_Pa[2]);
        loads.force_N += traction.pressure_Pa ? pressure_load(mesh, traction.faces, *traction.pressure_Pa)
                                              : traction_load(mesh, traction.faces, traction.vector_Pa);
        loads.applied_N += area_m2.sum() * (traction.pressure_Pa ? std::abs(*traction.pressure_Pa) : t.norm());
        if (!loads.centre) loads.centre = LoadCentre{mesh.nodes_m * area_m2 / area_m2.sum(), traction.faces, 0.0};
    }
}

Vector3d outward_normal(const Matrix3Xd& x) {
    const Vector3d area = x.cols() == 4 ? (x.col(2) - x.col(0)).cross(x.col(3) - x.col(1))
                                        : (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0));
    return area.normalized();
}

double depression_at_m(const Mesh& mesh, const LoadCentre& centre, const Matrix3Xd& u_m) {
    OnFace nearest{{}, std::numeric_limits<double>::infinity()};
    double depression_m = 0.0;
    for (Index f = 0; f < centre.faces.cell.size(); ++f) {
        const Eigen::VectorXi corners = centre.faces.corners.col(f);
        const Matrix3Xd x = corners_of_face_m(mesh, centre.faces, f);
        const OnFace here = nearest_on_face(x, centre.at_m);
        if (here.away_m >= nearest.away_m) continue;
        nearest = here;
        const Vector3d n = outward_normal(x);
        depression_m = 0.0;
        for (Index k = 0; k < corners.size(); ++k) depression_m -= here.weight(k) * n.dot(u_m.col(corners(k)));
    }
    return depression_m;
}

void sum_reactions(const FemCase& model, FemResult& result) {
    const Matrix3Xd& reaction = result.solution.reaction_N;
    std::vector<bool> counted(static_cast<std::size_t>(reaction.size()), false);
    for (const CaseSupport& support : model.supports) {
        Vector3d sum = Vector3d::Zero();
        for (const int node : support.nodes) {
            for (const char letter : support.axes) {
                const int dof = 3 * node + (letter - 'x');
                if (counted[static_cast<std::size_t>(dof)]) continue;
                counted[static_cast<std::size_t>(dof)] = true;
                sum(letter - 'x') += reaction.data()[dof];
            }
        }
        result.reaction_N.push_back(sum);
    }
    for (Index dof = 0; dof < reaction.size(); ++dof) {
        if (!counted[static_cast<std::size_t>(dof)]) result.body_reaction_N(dof % 3) += reaction.data()[dof];
    }
}

// Returns the largest residual of the reduced equations, over the largest nodal load or reaction: with prescribed
// displacements alone the loads are 0.
double relative_residual(const Factored& factored, const Matrix3Xd& load_N, const Solution& solution) {
    const auto K = factored.K_N_per_m.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd out_of_balance = load_N.reshaped() - K * solution.u_m.reshaped();
    const double left = reduce_load(factored.reduction, out_of_balance).lpNorm<Eigen::Infinity>();
    const double size = std::max(load_N.cwiseAbs().maxCoeff(), solution.reaction_N.cwiseAbs().maxCoeff());
    return size > 0.0 ? left / size : left;
}

Eigen::VectorXd von_mises_of(const CellFields& fields) {
    Eigen::VectorXd out(fields.stress_Pa.cols());
    for (Index cell = 0; cell < out.size(); ++cell) {
        const Voigt s = fields.stress_Pa.col(cell);
        const double normal = std::pow(s(0) - s(1), 2) + std::pow(s(1) - s(2), 2) + std::pow(s(2) - s(0), 2);
        out(cell) = std::sqrt(0.5 * normal + 3.0 * s.tail<3>().squaredNorm());
    }
    return out;
}

// Sets the stress of cells that move as rigid bodies to NaN: they carry stress, but their strain is only round-off.
void blank_rigid_cells(const Problem& problem, FemResult& result) {
    double softest = std::numeric_limits<double>::infinity();
    for (const Material& m : problem.materials) softest = std::min(softest, m.young_Pa);
    for (Index cell = 0; cell < result.von_mises_Pa.size(); ++cell) {
        if (!(problem.materials[static_cast<std::size_t>(cell)].young_Pa > problem.rigid_contrast * softest)) continue;
        result.fields.stress_Pa.col(cell).setConstant(std::numeric_limits<double>::quiet_NaN());
        result.von_mises_Pa(cell) = std::numeric_limits<double>::quiet_NaN();
    }
}

// Returns whether the tool stands on a plane of symmetry across `axis`: a side of the mesh whose nodes cannot leave it.
bool on_symmetry_plane(const FemCase& model, int axis) {
    const auto x_m = model.problem.mesh.nodes_m.row(axis);
    const double tool_m = model.indenter->centre_m[static_cast<std::size_t>(axis)];
    const double near_m = 1e-6 * (x_m.maxCoeff() - x_m.minCoeff());
    if (tool_m - x_m.minCoeff() > near_m && x_m.maxCoeff() - tool_m > near_m) return false;
    const std::vector<int>& held = model.problem.supports.dof;
    const std::unordered_set<int> is_held(held.begin(), held.end());
    for (int i = 0; i < static_cast<int>(x_m.size()); ++i) {
        if (std::abs(x_m(i) - tool_m) <= near_m && !is_held.contains(3 * i + axis)) return false;
    }
    return true;
}

// Returns the width of the whole contact, of which the mesh may hold a half or a quarter.
double contact_width_m(const FemCase& model, double area_m2) {
    for (const int axis : {0, 1}) area_m2 *= on_symmetry_plane(model, axis) ? 2.0 : 1.0;
    return 2.0 * std::sqrt(area_m2 / std::numbers::pi);
}

void judge_linearity(const FemCase& model, const Loads& loads, FemResult& result) {
    const auto z = model.problem.mesh.nodes_m.row(2);
    double width_m = loads.centre ? loads.centre->width_m : 0.0;
    if (result.contact) width_m = contact_width_m(model, result.contact->area_m2);
    const double depth_m = result.contact ? result.contact->depth_m : std::abs(result.centre_m.value_or(0.0));
    result.max_strain = max_principal_strain(result.fields);
    result.max_rotation_rad = max_rotation_rad(model.problem.mesh, result.solution.u_m);
    // the strain that a rotation brings and small displacements leave out; a bar that bends is about as far off
    const double turned = 0.5 * result.max_rotation_rad * result.max_rotation_rad;
    result.linear_ratio =
        std::max({result.max_strain, turned, linearity_ratio(depth_m, z.maxCoeff() - z.minCoeff(), width_m)});
    result.linear = linear_range(result.linear_ratio);
}

// What the displacements and the loads give, whatever the law.
void sum_up(const FemCase& model, const Loads& loads, FemResult& result) {
    const Mesh& mesh = model.problem.mesh;
    result.max_displacement_m = result.solution.u_m.colwise().norm().maxCoeff();
    if (!result.solution.u_m.allFinite() || !std::isfinite(result.max_displacement_m) ||
        !std::isfinite(result.solution.energy_J)) {
        throw std::runtime_error(model.file + ": the displacement is not finite (loads of " +
                                 files::short_number(loads.applied_N) + " N)");
    }
    sum_reactions(model, result);
    result.applied_N = loads.applied_N;
    result.partial = loads.partial;
    if (loads.centre) result.centre_m = depression_at_m(mesh, *loads.centre, result.solution.u_m);
    if (loads.applied_N > 0.0) {
        result.skel_m = loads.force_N.cwiseProduct(result.solution.u_m).sum() / loads.applied_N;
    }
}

LargeProblem large_problem(const FemCase& model) {
    LargeProblem problem{model.problem.mesh, model.problem.element, {}, model.problem.supports};
    problem.materials.reserve(model.problem.materials.size());
    for (std::size_t cell = 0; cell < model.problem.materials.size(); ++cell) {
        const auto region = static_cast<std::size_t>(problem.mesh.region(static_cast<Index>(cell)));
        problem.materials.push_back(with_law(model.problem.materials[cell], model.laws[region]));
    }
    return problem;
}

FemResult solve_large_loads(const FemCase& model, const FemProgress& progress) {
    FemResult result;
    Loads loads{Matrix3Xd::Zero(3, model.problem.mesh.nodes_m.cols()), 0.0, false, std::nullopt};
    add_pressures(model, loads);
    add_tractions(model, loads);
    progress("solve", 0, 0);
    const LargeProblem problem = large_problem(model);
    result.large = solve_large(problem, loads.force_N);
    const LargeSolution& large = *result.large;
    result.solution.u_m = large.u_m;
    result.solution.reaction_N = large.reaction_N;
    result.solution.energy_J = large.energy_J;
    result.solution.solve_s = large.solve_s;
    sum_up(model, loads, result);
    result.fields = large_cell_fields(make_large_body(problem.mesh, problem.element, problem.materials), large.u_m);
    result.von_mises_Pa = von_mises_of(result.fields);
    result.max_strain = max_principal_strain(result.fields);
    result.equations = large.equations;
    result.residual = large.residual;
    result.converged = large.status == LargeStatus::converged;
    result.assemble_s = large.assemble_s;
    result.factor_s = large.factor_s;
    return result;
}

FemResult solve_loads(const FemCase& model, const Factored& factored, const FemProgress& progress) {
    const Mesh& mesh = model.problem.mesh;
    FemResult result;
    Loads loads{Matrix3Xd::Zero(3, mesh.nodes_m.cols()), 0.0, false, std::nullopt};
    add_pressures(model, loads);
    add_tractions(model, loads);
    if (model.indenter) {
        // the other loads act first: since the problem is linear, the contact can be solved on top of them
        const Matrix3Xd before_m = solve(factored, loads.force_N).u_m;
        result.contact = press_indenter(model, factored, before_m, progress);
        loads.force_N += result.contact->force_N;
        loads.applied_N += result.contact->normal_N;
        loads.centre = LoadCentre{centre_on_side(mesh, Side::zmax, model.indenter->centre_m),
                                  faces_on(mesh, model.outer, Side::zmax), 0.0};
    }
    progress("solve", 0, 0);
    result.solution = solve(factored, loads.force_N);
    sum_up(model, loads, result);
    result.fields = cell_fields(mesh, model.problem.materials, result.solution.u_m);
    result.von_mises_Pa = von_mises_of(result.fields);
    blank_rigid_cells(model.problem, result);
    result.equations = factored.reduction.equations;
    result.residual = relative_residual(factored, loads.force_N, result.solution);
    result.converged =
        result.solution.backward_error < kMostBackwardError && (!result.contact || result.contact->settled);
    judge_linearity(model, loads, result);
    result.assemble_s = factored.assemble_s;
    result.factor_s = factored.factor_s;
    return result;
}

}  // namespace

FemResult solve_case(const FemCase& model, const FemProgress& progress) {
    FemResult result;
    if (is_large(model)) {
        with_key(model.file, "loads", "loads that can be computed with",
                 [&] { result = solve_large_loads(model, progress); });
        return result;
    }
    std::optional<Factored> factored;
    progress("factor", 0, 0);
    // all other faults of supports were refused when the case was read
    with_key(model.file, "supports",
             "a rigid inclusion held completely, by fixing xyz where it meets the support, or a material at "
             "most 1e8 times as stiff as the softest, which the program lets deform",
             [&] { factored.emplace(factorise(model.problem, best_solver())); });
    with_key(model.file, "loads", "loads that can be computed with",
             [&] { result = solve_loads(model, *factored, progress); });
    return result;
}

files::VtuGrid vtu_of(const FemCase& model, const FemResult& result) {
    const auto list = [](const auto& matrix, double scale) {
        std::vector<double> out(static_cast<std::size_t>(matrix.size()));
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = scale * static_cast<double>(matrix.data()[i]);
        return out;
    };
    const Mesh& mesh = model.problem.mesh;
    files::VtuGrid grid;
    grid.points = list(mesh.nodes_m, 1e3);
    grid.corners = static_cast<int>(mesh.cells.rows());
    grid.cells.assign(mesh.cells.data(), mesh.cells.data() + mesh.cells.size());
    Eigen::MatrixXd tensor = result.fields.strain;
    tensor.bottomRows<3>() *= 0.5;  // engineering shear -> tensor component
    grid.on_points = {{"displacement_mm", 3, list(result.solution.u_m, 1e3)},
                      {"reaction_N", 3, list(result.solution.reaction_N, 1.0)}};
    grid.in_cells = {{"strain", 6, list(tensor, 1.0)},
                     {"stress_Pa", 6, list(result.fields.stress_Pa, 1.0)},
                     {"von_mises_Pa", 1, list(result.von_mises_Pa, 1.0)},
                     {"material", 1, list(mesh.region, 1.0)}};
    return grid;
}

}  // namespace palpa::fem
