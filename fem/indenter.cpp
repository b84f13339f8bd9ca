#include "fem/indenter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>

#include "fem/reach.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/compliance.h"
#include "mechanics/contact_area.h"
#include "mechanics/error.h"
#include "mechanics/friction.h"
#include "mechanics/layer.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;

constexpr double kMostCompliance_bytes = 6e8;
// 0.004 % from the force with 64 steps: assets/cases/hertz.json on 24 x 24 x 10 cells, friction 0.3, 2026-11
constexpr int kFrictionSteps = 16;
constexpr int kFrictionSweeps = 4000;
constexpr double kForceTolerance = 1e-6;  // with friction, whose sweeps leave an error of 1e-7 of the largest force
constexpr int kMostPresses = 40;
constexpr double kNarrowest = 1e-10;         // of the depth: if the bracket is narrower, the force jumps within it
constexpr double kFewestCells = 4.0 - 1e-9;  // across the contact's radius, as docs/fem.md asks for
constexpr double kCellsWithEnds = 20.0;      // along a cylinder whose ends lie on nodes

struct Pressed {
    Contact contact;
    std::vector<int> touch;       // touch nodes under load
    std::vector<double> force_N;  // three per node: pressing, x, y
    std::string unsettled;        // why the contact did not settle; empty if it did
};

Tool tool_at(const CaseIndenter& indenter, double depth_m) {
    return {indenter.indenter, {indenter.centre_m[0], indenter.centre_m[1], depth_m}};
}

std::string mm_text(double metres) { return files::short_number(1e3 * metres) + " mm"; }

std::string overlap_text(const Contact& contact) {
    return "at " + mm_text(contact.tool[0].depth_m) + " the surface still reaches " + mm_text(contact.violation_m) +
           " into the tool";
}

Pressed press_smooth(const Compliance& c, const CaseIndenter& indenter, const FemCase& model) {
    Pressed out;
    ContactWork work;
    if (indenter.depth_m) {
        const Tool tool = tool_at(indenter, *indenter.depth_m);
        press_to_depth(c, {&tool, 1}, {}, work, out.contact);
    } else {
        press_with_force(c, tool_at(indenter, 0.0), indenter.force_N, {}, work, out.contact);
        if (out.contact.flags.capped) {
            throw files::bad_input(model.file, "loads.indenter.force_N", files::short_number(indenter.force_N),
                                   "at most " + files::short_number(out.contact.tool[0].normal_N) +
                                       ", which presses the tool through the whole tissue, " +
                                       files::short_number(1e3 * c.thickness_m) + " mm");
        }
    }
    const ContactFlags& flags = out.contact.flags;
    if (flags.not_settled) {
        out.unsettled = "the nodes in contact keep changing: " + overlap_text(out.contact);
    } else if (flags.force_missed) {
        out.unsettled = "the force comes no nearer than " + files::short_number(out.contact.tool[0].normal_N) +
                        " N to " + files::short_number(indenter.force_N) + " N";
    }
    out.touch = out.contact.touch;
    for (const double p : out.contact.force_N) out.force_N.insert(out.force_N.end(), {p, 0.0, 0.0});
    return out;
}

Pressed press_rough_to(const Compliance& c, const CaseIndenter& indenter, double depth_m) {
    FrictionOptions options;
    options.coefficient = indenter.friction;
    options.sweeps = kFrictionSweeps;
    FrictionWork work;
    FrictionState state;
    Pressed out;
    for (int k = 1; k <= kFrictionSteps; ++k) {
        slide_to(c, tool_at(indenter, depth_m * k / kFrictionSteps), options, work, state, out.contact);
        if (!out.contact.flags.not_settled) continue;
        out.unsettled = "friction: after " + std::to_string(kFrictionSweeps) + " sweeps " + overlap_text(out.contact);
        break;
    }
    out.touch = state.touch;
    out.force_N = state.force_N;
    return out;
}

// One end of the bracket: a depth, and by how much its force misses the wanted one.
struct Bound {
    double depth_m = 0.0;
    double miss = 0.0;  // log(force / wanted); infinite before the depth was pressed, or without contact
};

// Returns the next depth inside the bracket. The force rises with a power of the depth, so it interpolates between the
// logarithms of both; before both ends are known it takes Hertz's power, 3/2.
double next_depth_m(const Bound& low, const Bound& high) {
    const bool open = !std::isfinite(high.miss);
    if (!(low.depth_m > 0.0) && open) return 0.5 * high.depth_m;
    if (!std::isfinite(low.miss))
        return open ? std::min(2.0 * low.depth_m, high.depth_m) : 0.5 * (low.depth_m + high.depth_m);
    if (open) return std::min(low.depth_m * std::exp(-low.miss / 1.5), high.depth_m);
    if (!(low.depth_m > 0.0)) return high.depth_m * std::exp(-high.miss / 1.5);
    const double share = low.miss / (low.miss - high.miss);
    return low.depth_m * std::pow(high.depth_m / low.depth_m, share);
}

// Presses to the indenter's depth, or searches for the depth of its force. The force has kinks and jumps where nodes
// join the contact, so the search keeps a bracket (regula falsi by the Illinois rule, which halves the miss of an end
// that stays).
Pressed press_rough(const Compliance& c, const CaseIndenter& indenter, const FemCase& model) {
    if (indenter.depth_m) return press_rough_to(c, indenter, *indenter.depth_m);
    Pressed out = press_smooth(c, indenter, model);
    if (!out.unsettled.empty()) return out;
    double depth_m = out.contact.tool[0].depth_m;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    Bound low;
    Bound high{c.thickness_m, kUnknown};
    int side = 0;  // of the last press
    for (int i = 0; i < kMostPresses && high.depth_m - low.depth_m > kNarrowest * high.depth_m; ++i) {
        out = press_rough_to(c, indenter, depth_m);
        if (!out.unsettled.empty()) return out;
        const double miss = std::log(out.contact.tool[0].normal_N / indenter.force_N);  // -infinity without contact
        if (std::abs(miss) <= kForceTolerance) return out;
        const int now = miss < 0.0 ? -1 : 1;
        (now < 0 ? low : high) = {depth_m, miss};
        if (now == side) (now < 0 ? high : low).miss *= 0.5;
        side = now;
        depth_m = next_depth_m(low, high);
    }
    out.unsettled = "friction: the force jumps past " + files::short_number(indenter.force_N) + " N at " +
                    mm_text(depth_m) + " (" + files::short_number(out.contact.tool[0].normal_N) + " N)";
    return out;
}

// Returns Hertz's depth for the wanted force, on the material under the tool's lowest point: a first guess.
double hertz_depth_m(const CaseIndenter& indenter, const FemCase& model) {
    const Faces top = faces_on(model.problem.mesh, model.outer, Side::zmax);
    double nearest = std::numeric_limits<double>::infinity();
    int cell = 0;
    for (Index f = 0; f < top.cell.size(); ++f) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (Index k = 0; k < top.corners.rows(); ++k) middle += model.problem.mesh.nodes_m.col(top.corners(k, f));
        middle /= static_cast<double>(top.corners.rows());
        const double away = std::hypot(middle.x() - indenter.centre_m[0], middle.y() - indenter.centre_m[1]);
        if (away >= nearest) continue;
        nearest = away;
        cell = top.cell(f);
    }
    const Material& m = model.problem.materials[static_cast<std::size_t>(cell)];
    const double E = plane_strain_modulus_Pa(m.young_Pa, m.poisson);
    return std::pow(0.75 * indenter.force_N / (E * std::sqrt(indenter.indenter.radius_m)), 2.0 / 3.0);
}

struct Rectangle {
    SurfaceRequest request;
    std::array<double, 4> box_m{};  // of the touch nodes
    bool whole = false;             // it holds the whole surface
    std::vector<int> held;          // nodes in it that a support holds along z
};

Rectangle rectangle_around(const FemCase& model, const CaseIndenter& indenter, double half_x_m, double half_y_m) {
    const auto [x, y] = indenter.centre_m;
    Rectangle out;
    out.request =
        request_rectangle(model.problem.mesh, model.outer, {x - half_x_m, x + half_x_m, y - half_y_m, y + half_y_m});
    out.whole = out.request.other_nodes.empty();
    out.request.other_nodes.clear();  // a solution with the contact's forces gives the full field afterwards
    out.request.tangential = indenter.friction > 0.0;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    out.box_m = {kFar, -kFar, kFar, -kFar};
    for (const int node : out.request.touch_nodes) {
        for (Index axis = 0; axis < 2; ++axis) {
            const double at = model.problem.mesh.nodes_m(axis, node);
            double* const range = out.box_m.data() + 2 * axis;
            range[0] = std::min(range[0], at);
            range[1] = std::max(range[1], at);
        }
    }
    return out;
}

bool at_rim(const Compliance& c, const Pressed& pressed, const Rectangle& rectangle) {
    return std::any_of(pressed.touch.begin(), pressed.touch.end(), [&](int touch) {
        const double x = c.position_m(0, touch);
        const double y = c.position_m(1, touch);
        const auto& box = rectangle.box_m;
        return x <= box[0] || x >= box[1] || y <= box[2] || y >= box[3];
    });
}

void check_size(const Rectangle& rectangle, const FemCase& model) {
    const double rows =
        static_cast<double>(rectangle.request.touch_nodes.size()) * (rectangle.request.tangential ? 3.0 : 1.0);
    if (8.0 * rows * rows <= kMostCompliance_bytes) return;
    throw files::bad_input(
        model.file, "loads.indenter",
        "a tool over " + std::to_string(rectangle.request.touch_nodes.size()) + " nodes of the surface",
        "at most " +
            files::short_number(std::sqrt(kMostCompliance_bytes / 8.0) / (rectangle.request.tangential ? 3.0 : 1.0)) +
            " (a smaller radius or depth, or a coarser mesh)");
}

double at_mm(const FemCase& model, int node, Index axis) { return 1e3 * model.problem.mesh.nodes_m(axis, node); }

[[noreturn]] void refuse_support(const FemCase& model, int node, const std::string& expected) {
    throw files::bad_input(model.file, "loads.indenter.centre_mm",
                           "a support under the tool, at x " + files::short_number(at_mm(model, node, 0)) + ", y " +
                               files::short_number(at_mm(model, node, 1)) + " mm",
                           expected);
}

// Takes the nodes that a support holds out of the touch nodes, since they have no compliance. Throws InputError if no
// touch node is left, or if friction cannot move one.
void set_held_aside(const FemCase& model, const Factored& factored, Rectangle& rectangle) {
    const auto prescribed = [&](int node, int axis) {
        return factored.reduction.equation[static_cast<std::size_t>(3 * node + axis)] == kPrescribed;
    };
    auto& touch = rectangle.request.touch_nodes;
    assert(!touch.empty());  // read_indenter refuses a body without a face in its highest plane
    std::copy_if(touch.begin(), touch.end(), std::back_inserter(rectangle.held),
                 [&](int node) { return prescribed(node, 2); });
    std::erase_if(touch, [&](int node) { return prescribed(node, 2); });
    if (touch.empty()) refuse_support(model, rectangle.held.front(), "a free surface");
    for (const int node : touch) {
        if (model.indenter->friction > 0.0 && prescribed(node, 0) && prescribed(node, 1)) {
            refuse_support(model, node, "a surface that is free to move along x or y, or friction 0");
        }
    }
}

// Throws InputError if the tool reaches a node that a support holds, since no contact is computed there.
void check_held(const FemCase& model, const Rectangle& rectangle, double depth_m) {
    const Indenter& tool = model.indenter->indenter;
    const double d = std::min(depth_m, tool.radius_m);
    const double reach_m = std::sqrt(d * (2.0 * tool.radius_m - d));
    for (const int node : rectangle.held) {
        const double dx = model.problem.mesh.nodes_m(0, node) - model.indenter->centre_m[0];
        const double dy = model.problem.mesh.nodes_m(1, node) - model.indenter->centre_m[1];
        const bool cylinder = tool.shape == IndenterShape::cylinder;
        const double away_m = cylinder ? std::abs(dx) : std::hypot(dx, dy);
        if (away_m >= reach_m || (cylinder && 2.0 * std::abs(dy) > tool.length_m)) continue;
        refuse_support(model, node, "a free surface wherever the tool reaches");
    }
}

double reach_m(const Indenter& tool, double depth_m) {
    return std::sqrt(tool.radius_m * std::min(depth_m, tool.radius_m));
}

// Returns the least distance between a node in contact and another touch node that lies within 45 degrees of an axis (0 x, 1 y)
// from there: a mesh may be finer in one direction than in the other.
double spacing_m(const Compliance& c, const Pressed& pressed, int axis) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const int i : pressed.touch) {
        for (int j = 0; j < c.n_touch; ++j) {
            const double along_m = std::abs(c.position_m(axis, i) - c.position_m(axis, j));
            const double across_m = std::abs(c.position_m(1 - axis, i) - c.position_m(1 - axis, j));
            const double away_m = std::hypot(along_m, across_m);
            if (along_m >= across_m && away_m > 1e-9 * c.thickness_m) least_m = std::min(least_m, away_m);
        }
    }
    return least_m;
}

// Returns the least height of the cells that hold a node in contact.
double height_m(const Mesh& mesh, const std::vector<int>& nodes) {
    std::vector<char> pressed(static_cast<std::size_t>(mesh.nodes_m.cols()), 0);
    for (const int node : nodes) pressed[static_cast<std::size_t>(node)] = 1;
    double least_m = std::numeric_limits<double>::infinity();
    for (Eigen::Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        bool in_contact = false;
        double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
        for (const int node : mesh.cells.col(cell)) {
            in_contact = in_contact || pressed[static_cast<std::size_t>(node)] != 0;
            low_m = std::min(low_m, mesh.nodes_m(2, node));
            high_m = std::max(high_m, mesh.nodes_m(2, node));
        }
        if (in_contact) least_m = std::min(least_m, high_m - low_m);
    }
    return least_m;
}

// Sets area and cells across the tool. No area is larger than the tool's whole section; where the mesh is too coarse to tell
// the area, it is limited to the section of the tool at the surface.
void set_area(const Compliance& c, const Pressed& pressed, const FemCase& model, IndenterContact& out) {
    const Indenter& tool = model.indenter->indenter;
    std::vector<int> nodes;
    std::vector<double> pressing_N;
    for (std::size_t i = 0; i < pressed.touch.size(); ++i) {
        nodes.push_back(c.node[static_cast<std::size_t>(pressed.touch[i])]);
        pressing_N.push_back(pressed.force_N[3 * i]);
    }
    const Faces top = faces_on(model.problem.mesh, model.outer, Side::zmax);
    out.area_m2 = contact_area_m2(top, tributary_area_m2(model.problem.mesh, top), nodes, pressing_N);
    const bool along_y = tool.shape == IndenterShape::cylinder;
    const double spacing_x_m = spacing_m(c, pressed, 0), spacing_y_m = spacing_m(c, pressed, 1);
    out.cells_across_radius = reach_m(tool, out.depth_m) / (along_y ? spacing_x_m : std::max(spacing_x_m, spacing_y_m));
    out.cells_under_radius = reach_m(tool, out.depth_m) / height_m(model.problem.mesh, nodes);
    if (along_y && std::isfinite(tool.length_m)) {
        out.cells_along_length = tool.length_m / spacing_y_m;
        for (const int node : nodes) {
            const double off_m = std::abs(model.problem.mesh.nodes_m(1, node) - model.indenter->centre_m[1]);
            out.ends_on_nodes |= std::abs(2.0 * off_m - tool.length_m) < 1e-6 * tool.length_m;
        }
    }
    const bool fine =
        out.cells_across_radius >= kFewestCells && out.cells_along_length.value_or(kFewestCells) >= kFewestCells;
    const double d = fine ? tool.radius_m : std::min(out.depth_m, tool.radius_m);
    const double half_m2 = d * (2.0 * tool.radius_m - d);
    out.area_m2 =
        std::min(out.area_m2, along_y ? 2.0 * std::sqrt(half_m2) * tool.length_m : std::numbers::pi * half_m2);
}

IndenterContact result_of(const Compliance& c, const Pressed& pressed, const FemCase& model) {
    const ToolForce& tool = pressed.contact.tool[0];
    IndenterContact out;
    out.force_N = Eigen::Matrix3Xd::Zero(3, model.problem.mesh.nodes_m.cols());
    for (std::size_t i = 0; i < pressed.touch.size(); ++i) {
        const double* const f = &pressed.force_N[3 * i];
        out.force_N.col(c.node[static_cast<std::size_t>(pressed.touch[i])]) << f[1], f[2], -f[0];
    }
    out.normal_N = tool.normal_N;
    out.depth_m = tool.depth_m;
    out.lateral_N[0] = tool.tangential_x_N;
    out.lateral_N[1] = tool.tangential_y_N;
    out.nodes = static_cast<int>(pressed.touch.size());
    out.settled = pressed.unsettled.empty();
    out.why_not_settled = pressed.unsettled;
    set_area(c, pressed, model, out);
    out.over_edge = pressed.contact.flags.over_edge;
    return out;
}

}  // namespace

std::vector<std::string> contact_warnings(const IndenterContact& contact) {
    std::vector<std::string> out;
    if (!contact.settled) out.push_back("the contact did not settle: " + contact.why_not_settled);
    if (contact.cells_across_radius < kFewestCells) {
        out.push_back(
            "the contact's radius spans " + files::short_number(contact.cells_across_radius) +
            " cells: below 4 its force can be far off, whatever the other figures say; refine the mesh around "
            "the tool");
    }
    if (contact.nodes > 0 && contact.cells_under_radius < 1.0) {
        out.push_back("the cells under the contact are " + files::short_number(1.0 / contact.cells_under_radius) +
                      " times as high as its radius: from 1 on its force is more than 3 % too large; refine the mesh "
                      "along z");
    }
    if (contact.cells_along_length && *contact.cells_along_length < kFewestCells) {
        out.push_back("the tool's length spans " + files::short_number(*contact.cells_along_length) +
                      " cells: below 4 its force can be far off, whatever the other figures say; refine the mesh "
                      "along y");
    } else if (contact.ends_on_nodes && *contact.cells_along_length < kCellsWithEnds) {
        out.push_back("nodes lie on the tool's ends, where they count whole: with " +
                      files::short_number(*contact.cells_along_length) +
                      " cells along its length its force is 4 to 8 % too large; let the ends lie midway between nodes");
    }
    return out;
}

IndenterContact press_indenter(const FemCase& model, const Factored& factored, const Eigen::Matrix3Xd& before_m,
                               const FemProgress& progress) {
    const double began_s = files::steady_s();
    const CaseIndenter& indenter = *model.indenter;
    const double R = indenter.indenter.radius_m;
    const double depth_m = std::min(indenter.depth_m ? *indenter.depth_m : hertz_depth_m(indenter, model), R);
    const bool along_y = indenter.indenter.shape == IndenterShape::cylinder;
    double half_x_m = 1.2 * std::sqrt(depth_m * (2.0 * R - depth_m));
    double half_y_m = along_y ? 0.55 * indenter.indenter.length_m : half_x_m;
    Progress columns;
    columns.report = [&](int done, int total) { progress("compliance", done, total); };
    for (;; half_x_m *= 1.5, half_y_m *= 1.5) {
        Rectangle rectangle = rectangle_around(model, indenter, half_x_m, half_y_m);
        if (rectangle.request.touch_nodes.size() < 16 && !rectangle.whole) continue;
        check_size(rectangle, model);
        set_held_aside(model, factored, rectangle);
        Compliance c = surface_compliance(model.problem.mesh, factored, rectangle.request, columns);
        for (int touch = 0; touch < c.n_touch; ++touch) {  // moves the surface to where the tool meets it
            c.position_m(2, touch) += before_m(2, c.node[static_cast<std::size_t>(touch)]);
        }
        const Pressed pressed =
            indenter.friction > 0.0 ? press_rough(c, indenter, model) : press_smooth(c, indenter, model);
        const bool inside = !at_rim(c, pressed, rectangle) && !pressed.contact.flags.over_edge;
        if (!inside && !rectangle.whole) continue;
        check_held(model, rectangle, pressed.contact.tool[0].depth_m);
        check_reach(model, pressed.contact.tool[0].depth_m);
        if (pressed.touch.empty()) {
            throw files::bad_input(model.file, "loads.indenter", "a tool that touches no node at this depth",
                                   "a deeper or larger tool, or a finer mesh around it");
        }
        IndenterContact out = result_of(c, pressed, model);
        out.columns = c.n_touch;
        out.seconds = files::steady_s() - began_s;
        return out;
    }
}

}  // namespace palpa::fem
