// The cost of one step of a live tissue: contact algorithms, friction, sparse solvers, and what is precomputed.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "accuracy/mechanics.h"
#include "accuracy/mechanics_blocks.h"
#include "files/text.h"
#include "mechanics/friction.h"

namespace palpa::accuracy {

using namespace mechanics;

namespace {

constexpr double kMiddle_m = 0.05;
constexpr std::array<double, 4> kTouch_m{0.042, 0.058, 0.042, 0.058};

// One slab for all rows, with the compliance that friction needs as well.
struct Bench {
    Problem problem;
    Compliance compliance;
    double offline_s = 0.0;
};

Bench make_bench(bool quick) {
    Bench out;
    out.problem = quick ? block(graded_slab({24, 24, 5}, 1.2e-3), Element::hex8_bbar, kBenchTissue)
                        : block(graded_slab({38, 38, 6}, 1.0e-3), Element::hex8_bbar, kBenchTissue);
    SurfaceRequest request = request_rectangle(out.problem.mesh, boundary_faces(out.problem.mesh), kTouch_m);
    request.tangential = true;
    Timing timing;
    time_call(timing, [&] {
        out.compliance = surface_compliance(out.problem.mesh, factorise(out.problem, best_solver()), request);
    });
    out.offline_s = 1e-6 * timing.us[0];
    return out;
}

AccuracyRow bench_row(const Bench& bench, std::string group, std::string choice) {
    AccuracyRow row{.group = std::move(group), .series = choice, .choice = choice};
    row.nodes = static_cast<int>(bench.problem.mesh.nodes_m.cols());
    row.dofs = 3 * row.nodes - static_cast<int>(bench.problem.supports.dof.size());
    row.offline_s = bench.offline_s;
    row.offline_repetitions = 1;
    row.memory_MB = 8e-6 * static_cast<double>(bench.compliance.normal_m_per_N.size());
    return row;
}

// Returns the pressing forces of all touch nodes, N.
Eigen::VectorXd pressed_N(const Compliance& c, const Contact& contact) {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(c.n_touch);
    for (std::size_t k = 0; k < contact.touch.size(); ++k) p(contact.touch[k]) = contact.force_N[k];
    return p;
}

struct ContactChoice {
    std::string name;
    ContactOptions options;
    bool warm = true;
};

AccuracyRow contact_choice_row(const Bench& bench, const ContactChoice& choice, const Effort& effort) {
    AccuracyRow row = bench_row(bench, "contact solver", choice.name);
    const bool sweeps = choice.options.max_changes == 0;
    row.reference = sweeps ? "pressing forces by the active set" : "its own condition: penetration left / depth";
    row.reference_error_percent = sweeps ? 1e-8 : 0.0;
    ContactWork work = make_contact_work(bench.compliance, 200);
    ContactWork exact_work = make_contact_work(bench.compliance, 200);
    Contact contact, exact;
    Timing timing;
    ErrorSum sum;
    int unsettled = 0;
    const int steps = effort.quick ? 2000 : 8000;
    for (int i = 0; i < steps; ++i) {
        const Tool tool = tool_on_path(i, kMiddle_m, kMiddle_m);
        if (!choice.warm) work = make_contact_work(bench.compliance, 200);
        time_call(timing, [&] { press_to_depth(bench.compliance, {&tool, 1}, choice.options, work, contact); });
        unsettled += contact.flags.not_settled ? 1 : 0;
        if (sweeps) {
            press_to_depth(bench.compliance, {&tool, 1}, {}, exact_work, exact);
            const Eigen::VectorXd p = pressed_N(bench.compliance, exact);
            add_error((pressed_N(bench.compliance, contact) - p).norm() / p.norm(), sum);
        } else {
            add_error(contact.violation_m / tool.pose.depth_m, sum);
        }
    }
    set_error(sum, row);
    set_steps(timing, row);
    row.note = "not settled in " + files::short_number(100.0 * unsettled / steps) + " % of the steps";
    if (sweeps) row.note += "; where settled, a direct solve on the nodes left pressing ends the sweeps";
    return row;
}

Eigen::Vector3d tool_force_N(const Contact& contact) {
    return {contact.tool[0].normal_N, contact.tool[0].tangential_x_N, contact.tool[0].tangential_y_N};
}

// Returns the forces along one slide, whose steps are at most 0.1 mm.
std::vector<Eigen::Vector3d> slide(const Bench& bench, const FrictionOptions& options, int steps, Timing& timing,
                                   int& unsettled) {
    FrictionWork work;
    FrictionState state;
    Contact contact;
    std::vector<Eigen::Vector3d> out;
    for (int i = 0; i < steps; ++i) {
        const Tool tool = tool_on_path(10 * i, kMiddle_m, kMiddle_m);
        time_call(timing, [&] { slide_to(bench.compliance, tool, options, work, state, contact); });
        unsettled += contact.flags.not_settled ? 1 : 0;
        out.push_back(tool_force_N(contact));
    }
    return out;
}

std::vector<Eigen::Vector3d> slide_without_friction(const Bench& bench, int steps, Timing& timing) {
    ContactWork work = make_contact_work(bench.compliance, 200);
    Contact contact;
    std::vector<Eigen::Vector3d> out;
    for (int i = 0; i < steps; ++i) {
        const Tool tool = tool_on_path(10 * i, kMiddle_m, kMiddle_m);
        time_call(timing, [&] { press_to_depth(bench.compliance, {&tool, 1}, {}, work, contact); });
        out.push_back(tool_force_N(contact));
    }
    return out;
}

void compare_forces(const std::vector<Eigen::Vector3d>& found, const std::vector<Eigen::Vector3d>& reference,
                    AccuracyRow& row) {
    ErrorSum sum;
    for (std::size_t i = 0; i < found.size(); ++i)
        add_error((found[i] - reference[i]).norm() / reference[i].norm(), sum);
    set_error(sum, row);
}

void friction_rows(const Bench& bench, const Effort& effort, std::vector<AccuracyRow>& rows) {
    const int steps = effort.quick ? 100 : 400;
    Timing ignored, without;
    int unsettled = 0;
    const auto exact = slide(bench, {0.3, 20000, 1e-12}, steps, ignored, unsettled);
    const auto frictionless = slide_without_friction(bench, steps, without);

    AccuracyRow off = bench_row(bench, "friction", "off (active set)");
    compare_forces(frictionless, exact, off);
    set_steps(without, off);
    off.reference = "force on the tool with coefficient 0.3; swept to 1e-12";
    off.note = "the difference of the models: what is lost by leaving friction out";
    rows.push_back(off);
    for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7}) {
        AccuracyRow row = bench_row(bench, "friction", "0.3 to " + files::short_number(tolerance));
        Timing timing;
        int late = 0;
        compare_forces(slide(bench, {0.3, 400, tolerance}, steps, timing, late), exact, row);
        set_steps(timing, row);
        row.reference = off.reference;
        row.reference_error_percent = 1e-9;
        row.memory_MB = compliance_MB(bench.compliance);
        row.note = "not settled in " + files::short_number(100.0 * late / steps) + " % of the steps";
        rows.push_back(row);
    }
    AccuracyRow zero = bench_row(bench, "friction", "0 by the friction solver");
    Timing timing;
    compare_forces(slide(bench, {0.0, 400, 1e-7}, steps, timing, unsettled), frictionless, zero);
    set_steps(timing, zero);
    zero.reference = "force on the tool by the active set";
    zero.memory_MB = compliance_MB(bench.compliance);
    rows.push_back(zero);
}

// Returns b - A x, with products and sums in extended precision.
Eigen::VectorXd residual(const LowerMatrix& A, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
    std::vector<long double> r(b.begin(), b.end());
    const auto entry = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
        for (LowerMatrix::InnerIterator it(A, j); it; ++it) {
            r[entry(it.row())] -= static_cast<long double>(it.value()) * x(j);
            if (it.row() != j) r[entry(j)] -= static_cast<long double>(it.value()) * x(it.row());
        }
    }
    Eigen::VectorXd out(b.size());
    for (Eigen::Index i = 0; i < b.size(); ++i) out(i) = static_cast<double>(r[entry(i)]);
    return out;
}

// Returns the solution of A x = b to almost the last bit: iterative refinement, five times.
Eigen::VectorXd refined(const Factored& factored, const Eigen::VectorXd& b) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
    for (int i = 0; i < 5; ++i) {
        Eigen::MatrixXd correction = residual(factored.A_N_per_m, x, b);
        factored.cholesky.solve(correction);
        x += correction.col(0);
    }
    return x;
}

void sparse_solver_rows(const Bench& bench, const Effort& effort, std::vector<AccuracyRow>& rows) {
    Eigen::VectorXd b;
    Eigen::VectorXd exact;
    for (const SolverKind kind : {SolverKind::mumps, SolverKind::eigen}) {
        AccuracyRow row = bench_row(bench, "sparse solver", kind == SolverKind::mumps ? "MUMPS" : "Eigen LDLT");
        if (kind == SolverKind::mumps && !mumps_built_in()) {
            row.note = "not built in";
            rows.push_back(row);
            continue;
        }
        std::optional<Factored> factored;
        double before_MB = 0.0;
        set_offline(time_calls(1, 5, effort.offline_s,
                               [&](int) {
                                   factored.reset();
                                   before_MB = heap_MB();
                                   factored.emplace(factorise(bench.problem, kind));
                               }),
                    row);
        row.memory_MB = heap_MB() - before_MB;
        if (exact.size() == 0) {
            // pressed on one node in the middle
            b = Eigen::VectorXd::Zero(factored->reduction.equations);
            const int node = bench.compliance.node[static_cast<std::size_t>(bench.compliance.n_touch / 2)];
            add_force(factored->reduction, 3 * node + 2, -0.025, b);
            exact = refined(*factored, b);
        }
        Eigen::MatrixXd q;
        set_steps(time_calls(20, 1000, effort.steps_s,
                             [&](int) {
                                 q = b;
                                 factored->cholesky.solve(q);
                             }),
                  row);
        row.error_percent = 100.0 * (q.col(0) - exact).lpNorm<Eigen::Infinity>() / exact.lpNorm<Eigen::Infinity>();
        row.worst_error_percent = row.error_percent;
        row.reference = "all displacements; refined with residuals in extended precision";
        row.reference_error_percent = 1e-14;
        row.note = "a step is one right-hand side";
        rows.push_back(row);
    }
}

// Requests touch nodes where the tool can reach now, and the rest of the surface as rows only.
SurfaceRequest request_under(const Mesh& mesh, const Faces& outer, const Tool& tool) {
    const double reach_m = std::sqrt(2.0 * tool.indenter.radius_m * 1.3 * tool.pose.depth_m);
    return request_rectangle(
        mesh, outer,
        {tool.pose.x_m - reach_m, tool.pose.x_m + reach_m, tool.pose.y_m - reach_m, tool.pose.y_m + reach_m});
}

// Returns the depression of the surface nodes under the contact's forces by one full solve, the reference of all three
// rows.
Eigen::VectorXd full_depression_m(const Bench& bench, const Factored& factored, const Compliance& c,
                                  const Contact& contact) {
    Eigen::Matrix3Xd load_N = Eigen::Matrix3Xd::Zero(3, bench.problem.mesh.nodes_m.cols());
    for (std::size_t k = 0; k < contact.touch.size(); ++k)
        load_N(2, c.node[static_cast<std::size_t>(contact.touch[k])]) = -contact.force_N[k];
    const Eigen::Matrix3Xd u_m = solve(factored, load_N).u_m;
    Eigen::VectorXd out(static_cast<Eigen::Index>(c.node.size()));
    for (std::size_t k = 0; k < c.node.size(); ++k) out(static_cast<Eigen::Index>(k)) = -u_m(2, c.node[k]);
    return out;
}

enum class Kept { compliance, factor, nothing };

const char* name_of(Kept kept) {
    switch (kept) {
        case Kept::compliance:
            return "compliance kept";
        case Kept::factor:
            return "factor kept; columns in each step";
        case Kept::nothing:
            return "nothing kept; all in each step";
    }
    return "";
}

// Measures one step: contact at a depth and the depression of the whole surface, with what is kept from before.
AccuracyRow live_row(const Bench& bench, Kept kept, const Effort& effort) {
    AccuracyRow row = bench_row(bench, "live step", name_of(kept));
    const Faces outer = boundary_faces(bench.problem.mesh);
    std::optional<Factored> factored;
    std::optional<Compliance> c;
    Timing offline;
    const double before_MB = heap_MB();
    time_call(offline, [&] {
        factored.emplace(factorise(bench.problem, best_solver()));
        if (kept == Kept::compliance)
            c.emplace(surface_compliance(bench.problem.mesh, *factored,
                                         request_rectangle(bench.problem.mesh, outer, kTouch_m)));
    });
    row.memory_MB = kept == Kept::compliance ? compliance_MB(*c) : kept == Kept::factor ? heap_MB() - before_MB : 0.0;
    set_offline(offline, row);
    if (kept == Kept::nothing) row.offline_s = row.offline_repetitions = 0;

    ContactWork work;
    Contact contact;
    Eigen::VectorXd surface_m;
    ErrorSum sum;
    const auto step = [&](int i) {
        const Tool tool = tool_on_path(kept == Kept::compliance ? i : 50 * i, kMiddle_m, kMiddle_m);
        if (kept == Kept::nothing) factored.emplace(factorise(bench.problem, best_solver()));
        if (kept != Kept::compliance)
            c.emplace(
                surface_compliance(bench.problem.mesh, *factored, request_under(bench.problem.mesh, outer, tool)));
        press_to_depth(*c, {&tool, 1}, {}, work, contact);
        surface_depression_m(*c, contact, surface_m);
    };
    const int steps = kept == Kept::compliance ? 8000 : kept == Kept::factor ? 30 : 8;
    Timing timing;
    for (int i = 0; i < (effort.quick ? std::max(steps / 4, 5) : steps); ++i) {
        time_call(timing, [&] { step(i); });
        if (kept == Kept::compliance && i % 400 != 0) continue;
        const Eigen::VectorXd full_m = full_depression_m(bench, *factored, *c, contact);
        add_error((surface_m - full_m).lpNorm<Eigen::Infinity>() / full_m.lpNorm<Eigen::Infinity>(), sum);
    }
    set_error(sum, row);
    set_steps(timing, row);
    row.reference = "the whole surface; one refined solve under the contact's forces";
    row.reference_error_percent = 1e-12;
    return row;
}

}  // namespace

std::vector<Measurement> step_measurements(const Effort& effort) {
    const auto bench = std::make_shared<Bench>();
    const bool quick = effort.quick;
    std::vector<Measurement> list{
        {"compliance for the steps", quick ? 0.8 : 5.0, [=](auto&) { *bench = make_bench(quick); }}};
    std::vector<ContactChoice> choices{{"active set; warm", {}, true}, {"active set; cold", {}, false}};
    for (const int sweeps : {2, 5, 10, 20, 50}) {
        ContactOptions options;
        options.max_changes = 0;
        options.sweeps = sweeps;
        choices.push_back({"Gauss-Seidel " + std::to_string(sweeps) + " sweeps", options, true});
    }
    for (const ContactChoice& choice : choices) {
        list.push_back({choice.name, quick ? 0.2 : 1.0, [=](std::vector<AccuracyRow>& rows) {
                            rows.push_back(contact_choice_row(*bench, choice, effort));
                        }});
    }
    list.push_back(
        {"friction", quick ? 1.0 : 6.0, [=](std::vector<AccuracyRow>& rows) { friction_rows(*bench, effort, rows); }});
    list.push_back({"sparse solvers", quick ? 2.0 : 16.0,
                    [=](std::vector<AccuracyRow>& rows) { sparse_solver_rows(*bench, effort, rows); }});
    for (const Kept kept : {Kept::compliance, Kept::factor, Kept::nothing}) {
        list.push_back({std::string("live step, ") + name_of(kept), quick ? 1.0 : 8.0,
                        [=](std::vector<AccuracyRow>& rows) { rows.push_back(live_row(*bench, kept, effort)); }});
    }
    return list;
}

}  // namespace palpa::accuracy
