#include "fem/reach.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/face_point.h"

namespace palpa::fem {
namespace {

using namespace mechanics;
using Eigen::Index;
using Eigen::Vector3d;

// Returns the height z of the tool's lower side over a place (m); infinity beside the tool.
double tool_m(const CaseIndenter& tool, double tip_z_m, double x_m, double y_m) {
    const double dx = x_m - tool.centre_m[0];
    const double dy = y_m - tool.centre_m[1];
    const double R = tool.indenter.radius_m;
    const bool cylinder = tool.indenter.shape == IndenterShape::cylinder;
    const double away_m = cylinder ? std::abs(dx) : std::hypot(dx, dy);
    if (away_m >= R || (cylinder && 2.0 * std::abs(dy) > tool.indenter.length_m))
        return std::numeric_limits<double>::infinity();
    return tip_z_m + R - std::sqrt(R * R - away_m * away_m);
}

bool looks_up(const Eigen::Matrix3Xd& x) {
    const Vector3d n = x.cols() == 4 ? (x.col(2) - x.col(0)).cross(x.col(3) - x.col(1))
                                     : (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0));
    return n.z() > 1e-6 * n.norm();  // beyond rounding, with which the sides of a box are upright
}

}  // namespace

void check_reach(const FemCase& model, double depth_m) {
    const Mesh& mesh = model.problem.mesh;
    const double top_m = mesh.nodes_m.row(2).maxCoeff();
    const double tolerance_m =
        1e-9 * (mesh.nodes_m.rowwise().maxCoeff() - mesh.nodes_m.rowwise().minCoeff()).maxCoeff();
    for (Index f = 0; f < model.outer.cell.size(); ++f) {
        const Eigen::Matrix3Xd x = corners_of_face_m(mesh, model.outer, f);
        if (!looks_up(x)) continue;
        Eigen::Matrix3Xd places(3, x.cols() + 1);
        places << x, x.rowwise().mean();
        for (Index k = 0; k < places.cols(); ++k) {
            const Vector3d at = places.col(k);
            if (at.z() > top_m - tolerance_m) continue;
            if (at.z() <= tool_m(*model.indenter, top_m - depth_m, at.x(), at.y())) continue;
            throw files::bad_input(
                model.file, "loads.indenter",
                "a tool, " + files::short_number(1e3 * depth_m) +
                    " mm deep, that reaches a lower part of the surface at " + files::short_number(1e3 * at.x()) +
                    ", " + files::short_number(1e3 * at.y()) + ", " + files::short_number(1e3 * at.z()) +
                    " mm (element " + std::to_string(number_of_cell(mesh, model.outer.cell(f))) + ")",
                "a flat surface at zmax, " + files::short_number(1e3 * top_m) + " mm, wherever the tool reaches");
        }
    }
}

}  // namespace palpa::fem
