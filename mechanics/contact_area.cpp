#include "mechanics/contact_area.h"

#include <algorithm>
#include <vector>

namespace palpa::mechanics {
namespace {

using Eigen::Index;

constexpr double kLeast = 1.0 / 3.0;  // fitted to Hertz on hexahedra, 3 to 5 spacings across the radius, 2026-11

struct RimNode {
    bool at_rim = false;
    double greatest_Pa = 0.0;  // among the neighbours in contact
};

double share_inside(double pressure_Pa, const RimNode& node) {
    if (!node.at_rim || pressure_Pa >= node.greatest_Pa) return 1.0;
    const double q2 = pressure_Pa * pressure_Pa;
    return std::min(1.0, kLeast + q2 / (node.greatest_Pa * node.greatest_Pa - q2));
}

}  // namespace

double contact_area_m2(const Faces& surface, const Eigen::VectorXd& node_area_m2, std::span<const int> nodes,
                       std::span<const double> pressing_N) {
    std::vector<int> position(static_cast<std::size_t>(node_area_m2.size()), -1);
    std::vector<double> pressure_Pa(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        position[static_cast<std::size_t>(nodes[i])] = static_cast<int>(i);
        pressure_Pa[i] = pressing_N[i] / node_area_m2(nodes[i]);
    }
    std::vector<RimNode> rim(nodes.size());
    const auto look = [&](int from, int to) {
        const int here = position[static_cast<std::size_t>(from)];
        const int there = position[static_cast<std::size_t>(to)];
        if (here < 0) return;
        RimNode& node = rim[static_cast<std::size_t>(here)];
        node.at_rim = node.at_rim || there < 0;
        if (there >= 0) node.greatest_Pa = std::max(node.greatest_Pa, pressure_Pa[static_cast<std::size_t>(there)]);
    };
    const Index corners = surface.corners.rows();
    for (Index face = 0; face < surface.corners.cols(); ++face) {
        for (Index k = 0; k < corners; ++k) {
            const int a = surface.corners(k, face);
            const int b = surface.corners((k + 1) % corners, face);
            look(a, b);
            look(b, a);
        }
    }
    double area_m2 = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        area_m2 += node_area_m2(nodes[i]) * share_inside(pressure_Pa[i], rim[i]);
    return area_m2;
}

}  // namespace palpa::mechanics
