// Element, mesh and Poisson's ratio on the slab of mechanics.h, and on a wide slab against the exact bonded layer.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "accuracy/mechanics.h"
#include "accuracy/mechanics_blocks.h"
#include "files/text.h"
#include "mechanics/layer.h"
#include "mechanics/loads.h"

namespace palpa::accuracy {

using namespace mechanics;

namespace {

constexpr double kDiameter_m = 0.016;
constexpr double kForce_N = 0.025;
constexpr std::array<double, 3> kPoissons{0.30, 0.45, 0.499};
constexpr std::array<Element, 3> kElements{Element::tet4, Element::hex8, Element::hex8_bbar};

PressureLoad press_at(const Mesh& mesh, double x_m, double y_m) {
    return parabolic_load(mesh, boundary_faces(mesh), {Side::zmax, {x_m, y_m}, kDiameter_m, kForce_N},
                          LoadShare::consistent);
}

Material tissue(double poisson) { return {kBenchTissue.young_Pa, poisson}; }

double quarter_mean_m(double poisson, int n) {
    const Eigen::VectorXd x = nested_coordinates_m(0.05, n);
    const Mesh mesh = hex_box(x, x, (0.05 - x.reverse().array()).matrix());
    const Problem problem = quarter_block(mesh, Element::hex8_bbar, tissue(poisson));
    const PressureLoad load = press_at(mesh, 0.0, 0.0);
    return mean_displacement_m(load, solve(factorise(problem, best_solver()), load.force_N).u_m);
}

// Assembles and factors until the budget is spent; keeps the last factor and notes the memory that it holds.
Factored repeat_factorise(const Problem& problem, const Effort& effort, AccuracyRow& row) {
    std::optional<Factored> factored;
    double before_MB = 0.0;
    const Timing timing = time_calls(1, 20, effort.offline_s, [&](int) {
        factored.reset();
        before_MB = heap_MB();
        factored.emplace(factorise(problem, best_solver()));
    });
    row.memory_MB = heap_MB() - before_MB;
    set_size(problem, *factored, row);
    set_offline(timing, row);
    return std::move(*factored);
}

// Times the solution of single right-hand sides.
void time_solves(const Factored& factored, const PressureLoad& load, const Effort& effort, AccuracyRow& row) {
    const Eigen::VectorXd b = reduce_load(factored.reduction, load.force_N.reshaped());
    Eigen::MatrixXd q = b;
    set_steps(time_calls(20, 1000, effort.steps_s,
                         [&](int) {
                             q = b;
                             factored.cholesky.solve(q);
                         }),
              row);
}

std::string slab_series(Element element, double poisson) {
    return std::string(name_of(element)) + " nu " + files::short_number(poisson);
}

// Measures a slab 400 mm wide, of which symmetry allows to compute a quarter.
AccuracyRow layer_row(Element element, double poisson, const Effort& effort) {
    const int n = effort.quick ? 12 : 20;
    const int nz = effort.quick ? 8 : 12;
    const double finest_m = effort.quick ? 0.0025 : 0.0015;
    const Mesh hexes = hex_box(Box{{0.2, 0.2, 0.05}, {n, n, nz}, Grading{{0.0, 0.0}, finest_m}});
    const Problem problem = quarter_block(hexes, element, tissue(poisson));
    AccuracyRow row{.group = "wide slab", .series = slab_series(element, poisson)};
    row.choice = row.series;
    row.reference = "depression under the load's centre of the exact bonded layer (Hankel integral)";
    row.reference_error_percent = 1e-6;
    row.note = "400 mm wide; a quarter by symmetry";
    const PressureLoad load = press_at(problem.mesh, 0.0, 0.0);
    const Factored factored = repeat_factorise(problem, effort, row);
    time_solves(factored, load, effort, row);
    Eigen::Index centre = 0;
    (problem.mesh.nodes_m.colwise() - Eigen::Vector3d(0.0, 0.0, 0.05)).colwise().squaredNorm().minCoeff(&centre);
    const double u0_m = -solve(factored, load.force_N).u_m(2, centre);
    const double exact_m =
        layer_depression_m({kBenchTissue.young_Pa, poisson, 0.05}, {0.5 * kDiameter_m, kForce_N}, 0.0);
    row.error_percent = 100.0 * (u0_m / exact_m - 1.0);
    row.worst_error_percent = std::abs(row.error_percent);
    return row;
}

// Returns the expected time in seconds, as on two cores of a shared EPYC, 2026-11.
double expected_s(int nodes, const Effort& effort) {
    const double factor_s = 2.5e-6 * std::pow(nodes, 1.4);
    return std::max(factor_s, std::min(effort.offline_s, 20.0 * factor_s)) + effort.steps_s;
}

}  // namespace

SlabReference slab_reference(double poisson, std::span<const int> finest) {
    SlabReference out;
    for (const int n : finest) {
        // the error is proportional to the square of the cell size
        const double limit_m = (4.0 * quarter_mean_m(poisson, n) - quarter_mean_m(poisson, n / 2)) / 3.0;
        if (out.mean_m == 0.0) out.mean_m = limit_m;
        out.uncertainty_percent = std::max(out.uncertainty_percent, 100.0 * std::abs(limit_m / out.mean_m - 1.0));
    }
    return out;
}

AccuracyRow slab_row(Element element, const std::array<int, 3>& cells, bool graded, double poisson,
                     const SlabReference& reference, const Effort& effort) {
    const Mesh hexes =
        graded ? graded_slab(cells, 0.4 * 0.1 / cells[0]) : hex_box(Box{{0.1, 0.1, 0.05}, cells, std::nullopt});
    const Problem problem = block(hexes, element, tissue(poisson));
    AccuracyRow row{
        .group = "slab",
        .series = std::string(name_of(element)) + (graded ? "" : " uniform") + " nu " + files::short_number(poisson)};
    row.choice = row.series;
    row.reference = "mean depression; Richardson limit of the B-bar series";
    row.reference_error_percent = reference.uncertainty_percent;
    const PressureLoad load = press_at(problem.mesh, 0.05, 0.05);
    const Factored factored = repeat_factorise(problem, effort, row);
    time_solves(factored, load, effort, row);
    const double mean_m = mean_displacement_m(load, solve(factored, load.force_N).u_m);
    row.error_percent = 100.0 * (mean_m / reference.mean_m - 1.0);
    row.worst_error_percent = std::abs(row.error_percent);
    return row;
}

std::vector<Measurement> slab_measurements(const Effort& effort) {
    std::vector<std::array<int, 3>> meshes{{8, 8, 5}, {16, 16, 9}};
    if (!effort.quick) meshes.insert(meshes.end(), {{24, 24, 13}, {32, 32, 17}});
    const std::vector<int> finest = effort.quick ? std::vector{16, 12} : std::vector{24, 20, 16};
    const auto references = std::make_shared<std::map<double, SlabReference>>();
    std::vector<Measurement> list;
    for (const double poisson : kPoissons) {
        list.push_back({"reference of the slab, nu " + files::short_number(poisson), effort.quick ? 0.6 : 4.5,
                        [=](auto&) { (*references)[poisson] = slab_reference(poisson, finest); }});
        for (const Element element : kElements) {
            for (const auto& cells : meshes) {
                const int nodes = (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
                list.push_back({"slab, " + slab_series(element, poisson) + ", " + std::to_string(nodes) + " nodes",
                                expected_s(nodes, effort), [=](std::vector<AccuracyRow>& rows) {
                                    rows.push_back(
                                        slab_row(element, cells, true, poisson, references->at(poisson), effort));
                                }});
            }
        }
    }
    for (const double poisson : kPoissons) {
        list.push_back({"slab not graded, nu " + files::short_number(poisson), expected_s(2890, effort),
                        [=](std::vector<AccuracyRow>& rows) {
                            rows.push_back(slab_row(Element::hex8_bbar, {16, 16, 9}, false, poisson,
                                                    references->at(poisson), effort));
                        }});
    }
    for (const double poisson : kPoissons) {
        for (const Element element : kElements) {
            list.push_back(
                {"wide slab, " + slab_series(element, poisson), expected_s(5700, effort),
                 [=](std::vector<AccuracyRow>& rows) { rows.push_back(layer_row(element, poisson, effort)); }});
        }
    }
    return list;
}

}  // namespace palpa::accuracy
