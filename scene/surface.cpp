#include "scene/surface.h"

#include <algorithm>

namespace palpa::scene {
namespace {

// A place along one axis: the node before it, and how far it is on the way to the next one, 0 ... 1.
struct Between {
    Eigen::Index node = 0;
    double share = 0.0;
};

Between between(double x_m, double spacing_m, Eigen::Index n) {
    const double x = std::clamp(x_m / spacing_m, 0.0, static_cast<double>(n - 1));
    const Eigen::Index node = std::min(static_cast<Eigen::Index>(x), n - 2);
    return {node, x - static_cast<double>(node)};
}

}  // namespace

double sink_at_m(const SurfaceShape& shape, const Eigen::Vector2d& p_m) {
    if (shape.curve) return avatar::sink_at_m(*shape.curve, (p_m - shape.centre_m).norm());
    if (shape.n_x < 2 || shape.n_y < 2) return 0.0;
    const Between x = between(p_m.x(), shape.spacing_m.x(), shape.n_x);
    const Between y = between(p_m.y(), shape.spacing_m.y(), shape.n_y);
    const auto along_x = [&](Eigen::Index row) {
        const Eigen::Index first = row * shape.n_x + x.node;
        return (1.0 - x.share) * shape.sink_m[first] + x.share * shape.sink_m[first + 1];
    };
    return (1.0 - y.share) * along_x(y.node) + y.share * along_x(y.node + 1);
}

}  // namespace palpa::scene
