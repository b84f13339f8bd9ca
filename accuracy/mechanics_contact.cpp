// A ball of 8 mm radius pressed 2 mm deep: the error of the mesh's spacing, against a much finer mesh and against
// Hertz.

#include <cmath>
#include <memory>
#include <optional>

#include "accuracy/mechanics.h"
#include "accuracy/mechanics_blocks.h"
#include "files/text.h"
#include "mechanics/layer.h"

namespace palpa::accuracy {

using namespace mechanics;

namespace {

constexpr double kHertzBlock_m = 0.25;

struct ContactMesh {
    Element element;
    std::array<int, 3> cells;
    double finest_m;
};

// Times factorisation and surface compliance together, and keeps only the compliance.
Compliance prepare(const Problem& problem, const std::array<double, 4>& touch_m, const Effort& effort,
                   AccuracyRow& row) {
    std::optional<Compliance> made;
    const SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), touch_m);
    const Timing timing = time_calls(1, 5, effort.offline_s, [&](int) {
        const Factored factored = factorise(problem, best_solver());
        set_size(problem, factored, row);
        made.emplace(surface_compliance(problem.mesh, factored, request));
    });
    set_offline(timing, row);
    row.memory_MB = compliance_MB(*made);
    return std::move(*made);
}

// The number of depths at which forces are compared: at a single depth, the error would depend on whether a node has
// just come into contact.
constexpr int kDepths = 9;
double depth_m(double middle_m, int k) { return middle_m * (0.9 + 0.2 * k / (kDepths - 1)); }

double force_N(const Compliance& c, double x_m, double y_m, double depth) {
    ContactWork work = make_contact_work(c, 200);
    Contact contact;
    const Tool tool{kBenchBall, {x_m, y_m, depth}};
    press_to_depth(c, {&tool, 1}, {}, work, contact);
    return contact.tool[0].normal_N;
}

Mesh quarter_mesh(double width_m, double height_m, int n, double fine_m) {
    const Eigen::VectorXd x = graded_coordinates_m(width_m, n, 0.0, fine_m);
    const Eigen::VectorXd z = graded_coordinates_m(height_m, n, 0.0, fine_m);
    return hex_box(x, x, (height_m - z.reverse().array()).matrix());
}

// Returns the forces of a quarter of the slab, times four.
std::array<double, kDepths> quarter_forces_N(int n, double fine_m) {
    const Problem problem = quarter_block(quarter_mesh(0.05, 0.05, n, fine_m), Element::hex8_bbar, kBenchTissue);
    const SurfaceRequest request =
        request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.0, 0.008, 0.0, 0.008});
    const Compliance c = surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
    std::array<double, kDepths> out{};
    for (int k = 0; k < kDepths; ++k) out[static_cast<std::size_t>(k)] = 4.0 * force_N(c, 0.0, 0.0, depth_m(0.002, k));
    return out;
}

struct ContactReference {
    std::array<double, kDepths> force_N{};
    double uncertainty_percent = 0.0;
};

ContactReference contact_reference(bool quick) {
    const int n = quick ? 16 : 24;
    const double fine_m = quick ? 0.4e-3 : 0.25e-3;
    ContactReference out{quarter_forces_N(n, fine_m), 0.0};
    ErrorSum moved;
    const std::array<double, kDepths> coarser = quarter_forces_N(2 * n / 3, 1.5 * fine_m);
    for (std::size_t k = 0; k < kDepths; ++k) add_error(coarser[k] / out.force_N[k] - 1.0, moved);
    out.uncertainty_percent = 100.0 * std::sqrt(moved.squares / moved.count);
    return out;
}

void time_path(const Compliance& c, double x_m, double y_m, const Effort& effort, AccuracyRow& row) {
    ContactWork work = make_contact_work(c, 200);
    Contact contact;
    set_steps(time_calls(1000, 20000, 0.3 * effort.steps_s,
                         [&](int i) {
                             const Tool tool = tool_on_path(i, x_m, y_m);
                             press_to_depth(c, {&tool, 1}, {}, work, contact);
                         }),
              row);
}

AccuracyRow contact_row(const ContactMesh& mesh, const ContactReference& reference, const Effort& effort) {
    const Problem problem = block(graded_slab(mesh.cells, mesh.finest_m), mesh.element, kBenchTissue);
    AccuracyRow row{.group = "contact mesh", .series = name_of(mesh.element)};
    const double spacings = hertz_contact_radius_m(kBenchBall.radius_m, 0.002) / mesh.finest_m;
    row.choice = std::string(name_of(mesh.element)) + " spacing " + files::short_number(1e3 * mesh.finest_m) + " mm";
    row.reference = "normal force on the finest mesh (B-bar quarter)";
    row.reference_error_percent = reference.uncertainty_percent;
    row.note = "contact radius / spacing " + files::short_number(spacings);
    const Compliance c = prepare(problem, {0.0415, 0.0585, 0.0415, 0.0585}, effort, row);
    ErrorSum sum;
    for (int k = 0; k < kDepths; ++k) {
        for (const double share : {0.0, 0.25, 0.5}) {  // where the ball stands between two nodes
            const double at_m = 0.05 + share * mesh.finest_m;
            add_error(force_N(c, at_m, at_m, depth_m(0.002, k)) / reference.force_N[static_cast<std::size_t>(k)] - 1.0,
                      sum);
        }
    }
    set_error(sum, row);
    time_path(c, 0.05, 0.05, effort, row);
    return row;
}

// Measures a ball on a block so large that Hertz's half-space is a good reference.
AccuracyRow hertz_row(double fine_m, int n, const Effort& effort) {
    const Problem problem =
        quarter_block(quarter_mesh(kHertzBlock_m, kHertzBlock_m, n, fine_m), Element::hex8_bbar, kBenchTissue);
    constexpr double kDepth_m = 0.001;
    const double spacings = hertz_contact_radius_m(kBenchBall.radius_m, kDepth_m) / fine_m;
    AccuracyRow row{.group = "contact Hertz", .series = "hex8-bbar against Hertz"};
    row.choice = "hex8-bbar spacing " + files::short_number(1e3 * fine_m) + " mm";
    row.reference = "Hertz on a half-space";
    const double layer_N = dimitriadis_force_N(1.0, kBenchBall.radius_m, kDepth_m, kHertzBlock_m);
    row.reference_error_percent =
        100.0 * (layer_N / hertz_force_N(plane_strain_modulus_Pa(1.0, 0.5), kBenchBall.radius_m, kDepth_m) - 1.0);
    row.note = "block 250 mm deep; a quarter by symmetry; contact radius / spacing " + files::short_number(spacings);
    const Compliance c = prepare(problem, {0.0, 0.008, 0.0, 0.008}, effort, row);
    ErrorSum sum;
    for (int k = 0; k < kDepths; ++k) {
        const double hertz_N = hertz_force_N(plane_strain_modulus_Pa(kBenchTissue.young_Pa, kBenchTissue.poisson),
                                             kBenchBall.radius_m, depth_m(kDepth_m, k));
        add_error(4.0 * force_N(c, 0.0, 0.0, depth_m(kDepth_m, k)) / hertz_N - 1.0, sum);
    }
    set_error(sum, row);
    ContactWork work = make_contact_work(c, 200);
    Contact contact;
    set_steps(time_calls(1000, 20000, 0.3 * effort.steps_s,
                         [&](int i) {
                             const double depth = kDepth_m * (1.0 + 0.1 * std::sin(7e-3 * i));
                             const Tool tool{kBenchBall, {0.0, 0.0, depth}};
                             press_to_depth(c, {&tool, 1}, {}, work, contact);
                         }),
              row);
    return row;
}

}  // namespace

std::vector<Measurement> contact_measurements(const Effort& effort) {
    std::vector<ContactMesh> meshes;
    for (const Element element : {Element::tet4, Element::hex8, Element::hex8_bbar}) {
        meshes.push_back({element, {16, 16, 9}, 2.0e-3});
        if (effort.quick) continue;
        meshes.push_back({element, {24, 24, 13}, 1.333e-3});
        meshes.push_back({element, {32, 32, 17}, 1.0e-3});
    }
    if (effort.quick) meshes.push_back({Element::hex8_bbar, {20, 20, 8}, 1.333e-3});
    const auto reference = std::make_shared<ContactReference>();
    const bool quick = effort.quick;
    std::vector<Measurement> list{
        {"finest mesh under the ball", quick ? 1.5 : 8.0, [=](auto&) { *reference = contact_reference(quick); }}};
    for (const ContactMesh& mesh : meshes) {
        const double nodes = (mesh.cells[0] + 1.0) * (mesh.cells[1] + 1.0) * (mesh.cells[2] + 1.0);
        list.push_back({std::string("contact, ") + name_of(mesh.element) + ", " + files::short_number(nodes) + " nodes",
                        0.4 + 5e-6 * std::pow(nodes, 1.4), [=](std::vector<AccuracyRow>& rows) {
                            rows.push_back(contact_row(mesh, *reference, effort));
                        }});
    }
    std::vector<std::pair<double, int>> spacings{{1.4e-3, 12}, {0.9e-3, 15}};
    if (!quick) spacings.insert(spacings.end(), {{0.55e-3, 20}, {0.35e-3, 24}});
    for (const auto& [fine_m, n] : spacings) {
        list.push_back({"contact against Hertz, spacing " + files::short_number(1e3 * fine_m) + " mm",
                        quick ? 0.5 : 3.0, [fine = fine_m, cells = n, effort](std::vector<AccuracyRow>& rows) {
                            rows.push_back(hertz_row(fine, cells, effort));
                        }});
    }
    return list;
}

}  // namespace palpa::accuracy
