// What the tissue mechanics costs: offline (assemble, factor, compliance) and per frame (contact, surface).
// Per-frame figures are medians and 99th percentiles over single calls, in microseconds; one late frame is
// felt.

#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>

#include "files/clock.h"
#include "files/quantile.h"
#include "mechanics/contact.h"
#include "mechanics/friction.h"

namespace {

using namespace palpa::mechanics;

constexpr Indenter kBall{IndenterShape::sphere, 0.008};

// 100 x 100 x 50 mm, clamped bottom, a ball 1000 times stiffer inside; B-bar.
Problem slab(std::array<int, 3> cells, double finest_m) {
    Box box{{0.1, 0.1, 0.05}, cells, std::nullopt};
    if (finest_m > 0.0) box.grading = Grading{{0.05, 0.05}, finest_m};
    Problem problem;
    problem.mesh = hex_box(box);
    assign_sphere({{0.05, 0.05, 0.03}, 0.008}, 1, problem.mesh);
    const Material list[2] = {{2500.0, 0.45}, {2.5e6, 0.45}};
    problem.materials = materials_of_cells(problem.mesh.region, list);
    fix(nodes_of(faces_on(problem.mesh, boundary_faces(problem.mesh), Side::zmin)), "xyz", 0.0, problem.supports);
    return problem;
}

// 39 x 39 x 7 = 10,647 nodes, 1,521 on the surface.
Problem graded_slab() { return slab({38, 38, 6}, 0.001); }

const Compliance& graded_compliance() {
    static const Compliance made = [] {
        const Problem problem = graded_slab();
        return surface_compliance(problem.mesh, factorise(problem, best_solver()),
                                  request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.0, 0.1, 0.0, 0.1}));
    }();
    return made;
}

class Percentiles {
  public:
    template <class Call>
    void time(Call&& call) {
        const std::int64_t began_ns = palpa::files::steady_ns();
        call();
        us_.push_back(1e-3 * static_cast<double>(palpa::files::steady_ns() - began_ns));
    }
    void report(benchmark::State& state) {
        std::sort(us_.begin(), us_.end());
        const auto at = [&](double share) {
            return palpa::files::sorted_quantile(us_, share, palpa::files::QuantileType::lower);
        };
        state.counters["median_us"] = at(0.5);
        state.counters["p99_us"] = at(0.99);
        state.counters["max_us"] = us_.back();
    }

  private:
    std::vector<double> us_;
};

// A path that wanders over the middle at hand speed, sampled at 1 kHz.
Tool tool_at(int i, double depth_m) {
    const double t = 1e-3 * i;
    return {kBall,
            {0.05 + 0.005 * std::sin(3.0 * t), 0.05 + 0.005 * std::sin(4.1 * t),
             depth_m * (1.0 + 0.1 * std::sin(7.0 * t))}};
}

void assemble_and_factor(benchmark::State& state, const Problem& problem, SolverKind solver) {
    double assemble_s = 0.0;
    double factor_s = 0.0;
    for (auto _ : state) {
        const Factored factored = factorise(problem, solver);
        assemble_s = factored.assemble_s;
        factor_s = factored.factor_s;
    }
    state.counters["nodes"] = static_cast<double>(problem.mesh.nodes_m.cols());
    state.counters["assemble_s"] = assemble_s;
    state.counters["factor_s"] = factor_s;
}

void factor_regular(benchmark::State& state) { assemble_and_factor(state, slab({25, 25, 14}, 0.0), best_solver()); }
void factor_graded(benchmark::State& state) { assemble_and_factor(state, graded_slab(), best_solver()); }
void factor_graded_eigen(benchmark::State& state) { assemble_and_factor(state, graded_slab(), SolverKind::eigen); }

void compliance(benchmark::State& state) {
    const Problem problem = graded_slab();
    const Factored factored = factorise(problem, best_solver());
    SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.0, 0.1, 0.0, 0.1});
    request.block = static_cast<int>(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(surface_compliance(problem.mesh, factored, request).asymmetry);
    state.counters["columns"] = static_cast<double>(request.touch_nodes.size());
}

void contact_at_depth(benchmark::State& state) {
    ContactWork work = make_contact_work(graded_compliance(), 200);
    Contact contact;
    Percentiles times;
    double candidates = 0.0;
    int i = 0;
    for (auto _ : state) {
        const Tool tool = tool_at(i++, 1e-3 * static_cast<double>(state.range(0)));
        times.time([&] { press_to_depth(graded_compliance(), {&tool, 1}, {}, work, contact); });
        candidates += static_cast<double>(work.candidate.size());
    }
    times.report(state);
    state.counters["candidates"] = candidates / i;
}

void contact_cold(benchmark::State& state) {
    Contact contact;
    Percentiles times;
    int i = 0;
    for (auto _ : state) {
        ContactWork work = make_contact_work(graded_compliance(), 200);
        const Tool tool = tool_at(97 * i++, 0.003);
        times.time([&] { press_to_depth(graded_compliance(), {&tool, 1}, {}, work, contact); });
    }
    times.report(state);
}

void contact_with_force(benchmark::State& state) {
    ContactWork work = make_contact_work(graded_compliance(), 200);
    Contact contact;
    Percentiles times;
    int i = 0;
    for (auto _ : state) {
        Tool tool = tool_at(i++, 0.0);
        tool.pose.depth_m = contact.tool.empty() ? 0.0 : contact.tool[0].depth_m;
        times.time([&] {
            press_with_force(graded_compliance(), tool, 0.08 * (1.0 + 0.2 * std::sin(7e-3 * i)), {}, work, contact);
        });
    }
    times.report(state);
}

void contact_by_sweeps(benchmark::State& state) {
    ContactWork work = make_contact_work(graded_compliance(), 200);
    Contact contact;
    ContactOptions options;
    options.max_changes = 0;
    Percentiles times;
    int i = 0;
    for (auto _ : state) {
        const Tool tool = tool_at(i++, 0.003);
        times.time([&] { press_to_depth(graded_compliance(), {&tool, 1}, options, work, contact); });
    }
    times.report(state);
}

void full_surface(benchmark::State& state) {
    ContactWork work = make_contact_work(graded_compliance(), 200);
    Contact contact;
    Eigen::VectorXd u;
    Percentiles times;
    int i = 0;
    for (auto _ : state) {
        const Tool tool = tool_at(i++, 0.004);
        press_to_depth(graded_compliance(), {&tool, 1}, {}, work, contact);
        times.time([&] { surface_depression_m(graded_compliance(), contact, u); });
        benchmark::DoNotOptimize(u.data());
    }
    times.report(state);
    state.counters["pressing"] = static_cast<double>(contact.touch.size());
    state.counters["nodes"] = static_cast<double>(u.size());
}

void live_step(benchmark::State& state) {
    ContactWork work = make_contact_work(graded_compliance(), 200);
    Contact contact;
    Eigen::VectorXd u;
    Percentiles times;
    int i = 0;
    for (auto _ : state) {
        Tool tool = tool_at(i++, 0.0);
        tool.pose.depth_m = contact.tool.empty() ? 0.0 : contact.tool[0].depth_m;
        times.time([&] {
            press_with_force(graded_compliance(), tool, 0.08 * (1.0 + 0.2 * std::sin(7e-3 * i)), {}, work, contact);
            surface_depression_m(graded_compliance(), contact, u);
        });
    }
    times.report(state);
}

void friction_step(benchmark::State& state) {
    const Problem problem = graded_slab();
    SurfaceRequest request =
        request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.034, 0.066, 0.034, 0.066});
    request.tangential = true;
    const Compliance c = surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
    FrictionWork work;
    FrictionState slide;
    Contact contact;
    Percentiles times;
    int i = 0;
    for (auto _ : state) {
        const Tool tool = tool_at(10 * i++, 0.003);
        times.time([&] { slide_to(c, tool, {}, work, slide, contact); });
    }
    times.report(state);
}

BENCHMARK(factor_regular)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(factor_graded)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(factor_graded_eigen)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(compliance)->Arg(16)->Arg(64)->Arg(256)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(contact_at_depth)->Arg(1)->Arg(2)->Arg(3)->Arg(4)->Arg(6)->Unit(benchmark::kMicrosecond)->Iterations(8000);
BENCHMARK(contact_cold)->Unit(benchmark::kMicrosecond)->Iterations(1000);
BENCHMARK(contact_with_force)->Unit(benchmark::kMicrosecond)->Iterations(8000);
BENCHMARK(contact_by_sweeps)->Unit(benchmark::kMicrosecond)->Iterations(2000);
BENCHMARK(full_surface)->Unit(benchmark::kMicrosecond)->Iterations(4000);
BENCHMARK(live_step)->Unit(benchmark::kMicrosecond)->Iterations(8000);
BENCHMARK(friction_step)->Unit(benchmark::kMicrosecond)->Iterations(500);

}  // namespace

BENCHMARK_MAIN();
