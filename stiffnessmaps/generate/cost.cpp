#include "stiffnessmaps/generate/cost.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"
#include "mechanics/rolling_cost.h"

namespace palpa::stiffnessmaps {
namespace {

using mechanics::RollingCost;
using mechanics::RollingMesh;
using mechanics::RollingModel;

constexpr double kMostForces = 1e8;  // in a map: 1.2 GB of arrays

std::string cost_text(const RollingCost& cost) {
    if (!std::isfinite(cost.unknowns)) return "a mesh of more than 10 000 million unknowns";
    return "a mesh of " + files::short_number(cost.unknowns) + " unknowns, about " +
           files::short_number(1e-9 * cost.memory_bytes) + " GB and " + files::short_number(cost.time_s / 3600.0) +
           " h";
}

std::string limit_text() {
    return " (at most " + files::short_number(1e-9 * mechanics::kMostTableMemory_bytes) + " GB and " +
           files::short_number(mechanics::kMostTableTime_s / 3600.0) +
           " h for one mesh; a larger --coarseness makes coarser ones)";
}

// A model that cannot be computed at all is no alternative to suggest.
bool possible(const std::function<RollingCost()>& cost) {
    try {
        return mechanics::affordable(cost());
    } catch (const mechanics::MechanicsError&) {
        return false;
    }
}

// Returns the smallest value from `from` to `most` that `affordable` accepts, rounded up to two digits; NaN if there is
// none.
double smallest(double from, double most, const std::function<bool(double)>& affordable) {
    double low = from;
    double high = from;
    while (!affordable(high)) {
        if (high >= most) return std::numeric_limits<double>::quiet_NaN();
        low = high;
        high = std::min(1.5 * high, most);
    }
    for (int i = 0; i < 12; ++i) {
        const double middle = std::sqrt(low * high);
        (affordable(middle) ? high : low) = middle;
    }
    const double digit = std::pow(10.0, std::floor(std::log10(high)) - 1.0);
    return std::min(most, std::ceil(high / digit - 1e-9) * digit);
}

std::string at_least_mm(double size_m) {
    return "at least " + files::short_number(1e3 * size_m) + " mm" + limit_text();
}

[[noreturn]] void refuse_tool(const MapTask& task, double coarseness, const std::string& file,
                              const RollingCost& cost) {
    const auto affordable_with = [&](const auto& change, double value) {
        RollingModel model = task.model;
        change(model, value);
        return possible(
            [&] { return mechanics::contact_cost(model, mechanics::choose_rolling_mesh(model, coarseness)); });
    };
    const auto depth = [](RollingModel& model, double value) {
        model.least_depth_m = value;
        model.greatest_depth_m = std::max(model.greatest_depth_m, value);
    };
    const auto radius = [](RollingModel& model, double value) { model.radius_m = value; };
    const double least_depth_m =
        smallest(task.model.least_depth_m, std::min(task.model.radius_m, 0.9 * task.model.size_m[2]),
                 [&](double value) { return affordable_with(depth, value); });
    if (std::isfinite(least_depth_m)) {
        throw files::bad_input(file, "depths_mm",
                               files::short_number(1e3 * task.model.least_depth_m) + ", which needs " + cost_text(cost),
                               at_least_mm(least_depth_m));
    }
    const double least_radius_m = smallest(task.model.radius_m, task.model.size_m[2],
                                           [&](double value) { return affordable_with(radius, value); });
    throw files::bad_input(
        file, "indenter.radius_mm", files::short_number(1e3 * task.model.radius_m) + ", which needs " + cost_text(cost),
        std::isfinite(least_radius_m) ? at_least_mm(least_radius_m) : "a larger tool and deeper depths" + limit_text());
}

[[noreturn]] void refuse_group(const MapTask& task, const std::vector<int>& group, const std::string& file,
                               const RollingCost& cost) {
    const auto radius_of = [&](int i) { return task.model.inclusions[static_cast<std::size_t>(i)].sphere.radius_m; };
    const int thinnest =
        *std::min_element(group.begin(), group.end(), [&](int a, int b) { return radius_of(a) < radius_of(b); });
    const auto index = static_cast<std::size_t>(thinnest);
    const std::string key = "nodules[" + std::to_string(thinnest) + "].diameter_mm";
    RollingModel model = task.model;
    const double least_m = smallest(2.0 * radius_of(thinnest), task.model.size_m[2], [&](double diameter_m) {
        model.inclusions[index].sphere.radius_m = 0.5 * diameter_m;
        return possible([&] { return mechanics::inclusion_cost(model, task.mesh, group); });
    });
    std::string found = files::short_number(2e3 * radius_of(thinnest)) + ", which needs " + cost_text(cost);
    if (group.size() > 1) found += " together with the nodules near it, " + std::to_string(group.size()) + " in all";
    throw files::bad_input(
        file, key, found,
        std::isfinite(least_m) ? at_least_mm(least_m) : "fewer or larger nodules near each other" + limit_text());
}

}  // namespace

void check_cost(const MapTask& task, double coarseness, const std::string& file) {
    const Phantom& p = task.phantom;
    const double forces =
        static_cast<double>(p.n_x) * static_cast<double>(p.n_y) * static_cast<double>(p.depths_m.size());
    if (forces > kMostForces) {
        throw files::bad_input(file, "grid.count",
                               files::short_number(forces) + " forces, those of all depths together",
                               "at most " + files::short_number(kMostForces));
    }
    const RollingCost tool = mechanics::contact_cost(task.model, task.mesh);
    if (!mechanics::affordable(tool)) refuse_tool(task, coarseness, file, tool);
    const RollingCost sides = mechanics::side_cost(task.model, task.mesh);
    if (!mechanics::affordable(sides)) {
        throw files::bad_input(file, "size_mm", "a block whose sides need " + cost_text(sides),
                               "a block less wide, or a tool less large, against its thickness" + limit_text());
    }
    for (const std::vector<int>& group : task.groups) {
        const RollingCost cost = mechanics::inclusion_cost(task.model, task.mesh, group);
        if (!mechanics::affordable(cost)) refuse_group(task, group, file, cost);
    }
}

}  // namespace palpa::stiffnessmaps
