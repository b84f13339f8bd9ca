// Making a table: filling, comparing with live answers, refining.

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "tactile/table.h"
#include "tactile/table_cache.h"

namespace palpa::tactile {
namespace {

using Eigen::Vector2d;
using mechanics::Progress;

constexpr int kFewestPlaces = 4;  // along an axis, which the cubic convolution needs
constexpr int kFirstForces = 6;   // of an answer that is not linear
constexpr int kMostForces = 96;
constexpr int kBlock = 64;        // presses between two looks at `cancel`
constexpr int kMostChecks = 900;  // presses that a level is compared at
constexpr double kLeastSpacing_m = 2e-4;

// Where a table can answer: the whole width of the finger, and all that is observed, is on the surface.
struct Area {
    Vector2d first_m;
    Vector2d size_m;
};
Area area_of(const Renderer& r) {
    const mechanics::SurfaceGrid grid = mechanics::surface_grid(*r.compliance);
    Vector2d margin_m = Vector2d::Constant(0.5 * r.finger.diameter_m);
    if (r.observed.points_m.cols() > 0)
        margin_m = margin_m.cwiseMax(r.observed.points_m.cwiseAbs().rowwise().maxCoeff());
    const Vector2d first_m(grid.x.at_m(0), grid.y.at_m(0));
    const Vector2d last_m(grid.x.at_m(grid.x.at_m.size() - 1), grid.y.at_m(grid.y.at_m.size() - 1));
    return {first_m + margin_m, last_m - first_m - 2.0 * margin_m};
}

std::size_t entries(const Table& t) {
    return static_cast<std::size_t>(t.count[0]) * static_cast<std::size_t>(t.count[1]) * t.force_N.size();
}

double size_MB(const Table& t) { return 4e-6 * static_cast<double>(entries(t)) * (t.observed + 2); }

int observed_values(const Observation& o) {
    return static_cast<int>(o.map.size() > 0 ? o.map.rows() : o.points_m.cols());
}

void set_places(const Area& area, double spacing_m, Table& t) {
    for (int axis = 0; axis < 2; ++axis) {
        const double cells = std::ceil(area.size_m(axis) / spacing_m - 1e-9);
        t.count[axis] = std::max(kFewestPlaces, static_cast<int>(cells) + 1);
        t.first_m[axis] = area.first_m(axis);
        t.spacing_m[axis] = area.size_m(axis) / (t.count[axis] - 1);
    }
}

void set_forces(int count, double limit_N, Table& t) {
    t.force_N.clear();
    for (int k = 1; k <= count; ++k) t.force_N.push_back(limit_N * k * k / (count * count));
}

Vector2d place_m(const Table& t, double x, double y) {
    return {t.first_m[0] + x * t.spacing_m[0], t.first_m[1] + y * t.spacing_m[1]};
}

void stop_if_asked(const Progress& progress) {
    if (progress.cancel && progress.cancel->load()) throw mechanics::Cancelled("table: cancelled");
}

// Solves every entry live. Returns the least force at which the depth limit was reached before the force, or infinity.
double fill(const Renderer& r, const Progress& progress, RendererWork& w, Table& t) {
    t.depth_m.resize(entries(t));
    t.linearity.resize(entries(t));
    t.value_m.resize(entries(t) * static_cast<std::size_t>(t.observed));
    Eigen::VectorXd value_m(t.observed);
    double capped_N = std::numeric_limits<double>::infinity();
    const int places = t.count[0] * t.count[1];
    for (int place = 0; place < places; ++place) {
        if (place % kBlock == 0) {
            stop_if_asked(progress);
            if (progress.report) progress.report(place, places);
        }
        const Vector2d at_m = place_m(t, place % t.count[0], place / t.count[0]);
        for (std::size_t k = 0; k < t.force_N.size(); ++k) {
            const Press press = press_with_force(r, at_m, t.force_N[k] * r.stiffness_scale, w);
            // a linear answer is scaled up from what the depth limit allows; others end there
            const double up = t.linear && press.force_N > 0.0 ? t.force_N[k] * r.stiffness_scale / press.force_N : 1.0;
            if (!t.linear && press.capped) capped_N = std::min(capped_N, press.force_N / r.stiffness_scale);
            const std::size_t entry = k * static_cast<std::size_t>(places) + static_cast<std::size_t>(place);
            t.depth_m[entry] = static_cast<float>(up * press.depth_m);
            t.linearity[entry] = static_cast<float>(up * press.linearity);
            shape_m(r, w, value_m);
            Eigen::Map<Eigen::VectorXf>(t.value_m.data() + entry * static_cast<std::size_t>(t.observed), t.observed) =
                (up * value_m).cast<float>();
        }
    }
    return capped_N;
}

struct Errors {
    double force = 0.0;  // as a share of the limit
    double shape_m = 0.0;
    int checked = 0;
};

// Compares the table with one live press.
void compare(const Renderer& r, const Table& t, const Vector2d& at_m, double force_N, RendererWork& live,
             RendererWork& by_table, Errors& errors) {
    const Press truth = press_with_force(r, at_m, force_N * r.stiffness_scale, live);
    Eigen::VectorXd live_m(t.observed);
    Eigen::VectorXd table_m(t.observed);
    shape_m(r, live, live_m);
    adopt(&t, by_table);
    const Press guess = press_to_depth(r, at_m, truth.depth_m, by_table);
    ++errors.checked;
    errors.force = std::max(errors.force, std::abs(guess.force_N - truth.force_N) / r.force_limit_N);
    shape_m(r, by_table, table_m);
    if (t.observed > 0) errors.shape_m = std::max(errors.shape_m, (table_m - live_m).cwiseAbs().maxCoeff());
}

// A spread of whole numbers below n, the same every time: multiples of the golden section.
int spread(int k, int n) {
    const double share = 0.6180339887498949 * (k + 1);
    return std::min(n - 1, static_cast<int>(n * (share - std::floor(share))));
}

// In the middle of the cells, at the table's forces.
Errors errors_between_places(const Renderer& r, const Table& t, const Progress& progress, RendererWork& live,
                             RendererWork& by_table) {
    Errors errors;
    const int n_x = t.count[0] - 1;
    const int cells = n_x * (t.count[1] - 1);
    const int checks = std::min(cells, kMostChecks);
    for (int k = 0; k < checks; ++k) {
        if (k % kBlock == 0) stop_if_asked(progress);
        const int cell = checks == cells ? k : spread(k, cells);
        const int force = static_cast<int>(t.force_N.size()) - 1 - k % 3 * static_cast<int>(t.force_N.size()) / 3;
        compare(r, t, place_m(t, cell % n_x + 0.5, cell / n_x + 0.5), t.force_N[static_cast<std::size_t>(force)], live,
                by_table, errors);
    }
    return errors;
}

// At the table's places, between its forces.
Errors errors_between_forces(const Renderer& r, const Table& t, const Progress& progress, RendererWork& live,
                             RendererWork& by_table) {
    Errors errors;
    if (t.linear) return errors;
    for (int k = 0; k < kMostChecks / 4; ++k) {
        if (k % kBlock == 0) stop_if_asked(progress);
        const auto force = static_cast<std::size_t>(spread(3 * k, static_cast<int>(t.force_N.size())));
        const double below_N = force > 0 ? t.force_N[force - 1] : 0.0;
        const int place = spread(k, t.count[0] * t.count[1]);
        compare(r, t, place_m(t, place % t.count[0], place / t.count[0]), 0.5 * (below_N + t.force_N[force]), live,
                by_table, errors);
    }
    return errors;
}

// How many times too large the errors are.
double excess(const Errors& e, const TableOptions& o) {
    return std::max(e.force / o.error, e.shape_m / o.shape_error_m);
}

// Whether halving the spacing until the error is as asked for would take more memory than is allowed, if the error goes
// on falling as it did from the last level to this one. An answer that jumps, as that of a sphere does when a node
// joins the contact, falls too slowly for any table.
bool is_hopeless(double last, double now, double MB, const TableOptions& options) {
    constexpr double kLeastFall = 1.15;
    if (now <= 1.0) return false;
    if (last / now < kLeastFall) return true;
    const double levels = std::log(now) / std::log(last / now);
    return MB * std::pow(4.0, levels) > options.most_MB;
}

std::string not_good(const Table& t, const TableOptions& options) {
    const auto number = [](double value) { return std::to_string(value); };
    return "the table's error stays at " + number(100.0 * t.error) + " % of the force limit and " +
           number(1e3 * t.shape_error_m) + " mm of the shape (wanted " + number(100.0 * options.error) + " % and " +
           number(1e3 * options.shape_error_m) + " mm) within the memory allowed: the answer stays live";
}

// Fills and refines. The table is good, or says why it is not.
void refine(const Renderer& r, const TableOptions& options, const Progress& progress, const Area& area, Table& t) {
    RendererWork live = make_work(r);
    RendererWork by_table = make_work(r);
    double spacing_m = options.spacing_m;
    double limit_N = r.force_limit_N / r.stiffness_scale;
    int forces = t.linear ? 1 : kFirstForces;
    constexpr int kFewestLevels = 3;  // before it can give up
    double last = std::numeric_limits<double>::infinity();
    for (int level = 1;; ++level) {
        set_places(area, spacing_m, t);
        set_forces(forces, limit_N, t);
        if (size_MB(t) > options.most_MB || spacing_m < kLeastSpacing_m || forces > kMostForces) {
            t.note = not_good(t, options);
            return;
        }
        const double capped_N = fill(r, progress, live, t);
        if (capped_N < limit_N) {
            // the depth limit comes first somewhere: beyond this force the renderer answers live
            limit_N = capped_N * (1.0 - 1e-6);
            continue;
        }
        const Errors places = errors_between_places(r, t, progress, live, by_table);
        const Errors between = errors_between_forces(r, t, progress, live, by_table);
        t.error = std::max(places.force, between.force);
        t.shape_error_m = std::max(places.shape_m, between.shape_m);
        t.checked = places.checked + between.checked;
        const double now = excess(places, options);
        t.good = now <= 1.0 && excess(between, options) <= 1.0;
        if (t.good) return;
        if (level >= kFewestLevels && is_hopeless(last, now, size_MB(t), options)) {
            t.note = not_good(t, options);
            return;
        }
        last = now;
        if (now > 1.0) spacing_m *= 0.5;
        if (excess(between, options) > 1.0) forces *= 2;
    }
}

}  // namespace

Table make_table(const Renderer& renderer, const TableOptions& options, const std::filesystem::path& cache,
                 const Progress& progress) {
    Table table;
    table.linear = renderer.finger.contact == mechanics::FingerContact::parabola;
    if (!renderer.compliance) {
        table.note = "a force curve needs no table";
        return table;
    }
    const Area area = area_of(renderer);
    if (!(area.size_m.minCoeff() > 0.0)) {
        table.note = "the finger is wider than the block: the answer stays live";
        return table;
    }
    table.observed = observed_values(renderer.observed);
    const std::uint64_t number = table_fingerprint(renderer, options);
    if (restore_table(cache, number, table)) return table;
    refine(renderer, options, progress, area, table);
    if (table.good) table.note = store_table(cache, number, table);
    return table;
}

TableInProgress::TableInProgress(const Renderer& renderer, const TableOptions& options, std::filesystem::path cache) {
    worker_ = std::thread([this, renderer, options, cache = std::move(cache)] {
        Progress progress;
        progress.cancel = &cancel_;
        progress.report = [this](int done, int total) {
            done_.store(static_cast<double>(done) / std::max(total, 1), std::memory_order_relaxed);
        };
        try {
            table_ = std::make_unique<Table>(make_table(renderer, options, cache, progress));
            note_ = table_->note;
            if (table_->good) ready_.store(table_.get(), std::memory_order_release);
        } catch (const mechanics::Cancelled&) {
            note_ = "cancelled";
        } catch (const std::exception& error) {
            note_ = error.what();
        }
        finished_.store(true, std::memory_order_release);
    });
}

TableInProgress::~TableInProgress() {
    cancel_.store(true);
    if (worker_.joinable()) worker_.join();
}

}  // namespace palpa::tactile
