#include "mechanics/bellows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// One layer of quads in a plane: node numbers of the layer, counter-clockwise seen from above.
using Quads = std::vector<std::array<int, 4>>;

// Radius and height of a place in the wall. along: 0..1 up the wall, across: -1 inside .. 1 outside.
Vector2d wall_point(const Bellows& b, double along, double across) {
    const double wave = 2.0 * std::numbers::pi * b.waves;
    const double slope = b.amplitude_m * wave / b.height_m * std::sin(wave * along);  // dr/dz
    const Vector2d normal = Vector2d(1.0, -slope) / std::hypot(1.0, slope);
    const Vector2d middle(b.radius_m - b.amplitude_m * std::cos(wave * along), along * b.height_m);
    return middle + 0.5 * b.wall_m * across * normal;
}

void check(const Bellows& b) {
    const double wave = 2.0 * std::numbers::pi * b.waves / b.height_m;
    const double sharpest_m = b.amplitude_m > 0.0 ? 1.0 / (b.amplitude_m * wave * wave) : 1e300;
    std::string wrong;
    if (b.sectors < 8 || b.sectors % 4 != 0) wrong = text("sectors: ", b.sectors, "; wanted a multiple of 4 from 8");
    if (b.along < 1 || b.through < 1 || b.plate_cells < 1 || b.rings < 0)
        wrong = "along, through, plate_cells: each at least 1; rings: at least 0";
    if (!(b.wall_m < 2.0 * sharpest_m))
        wrong = text("wall: its waves are bent more sharply than ", b.wall_m / 2.0, " m");
    if (!(b.radius_m - std::abs(b.amplitude_m) > b.wall_m)) wrong = "radius: the wall reaches the axis";
    for (const double size : {b.radius_m, b.height_m, b.wall_m, b.plate_m}) {
        if (!(std::isfinite(size) && size > 0.0)) wrong = text("a size of ", size, " m; wanted sizes > 0");
    }
    if (!wrong.empty()) throw MeshError(text("bellows: ", wrong), {});
}

// Nodes of a ring: `through` + 1 circles from the inside out.
int ring_node(const Bellows& b, int circle, int sector) { return circle * b.sectors + sector % b.sectors; }

Quads ring_quads(const Bellows& b, int circles) {
    Quads out;
    for (int c = 0; c + 1 < circles; ++c) {
        for (int s = 0; s < b.sectors; ++s) {
            out.push_back(
                {ring_node(b, c, s), ring_node(b, c + 1, s), ring_node(b, c + 1, s + 1), ring_node(b, c, s + 1)});
        }
    }
    return out;
}

Vector2d round(double radius, int sector, int sectors) {
    const double angle = 2.0 * std::numbers::pi * sector / sectors;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// The middle of the plate: a square of m x m quads, m = sectors / 4, bulged so that its edge nearly is a circle. Its
// corners stand at the sectors m/2, 3 m/2, ... or halfway between two of them.
struct Middle {
    std::vector<Vector2d> nodes;  // (m + 1)^2, x fastest
    std::vector<int> edge;        // counter-clockwise from the corner below right, `sectors` of them
    Quads quads;
};

Middle middle_of(const Bellows& b, double radius_m) {
    const int m = b.sectors / 4;
    Middle out;
    const auto node = [m](int i, int j) { return j * (m + 1) + i; };
    for (int j = 0; j <= m; ++j) {
        for (int i = 0; i <= m; ++i) {
            const double x = 2.0 * i / m - 1.0;
            const double y = 2.0 * j / m - 1.0;
            // from the square to the disc, ring by ring of the square
            const double size = std::max(std::abs(x), std::abs(y));
            double angle = 0.0;
            if (size > 0.0) {
                angle = std::abs(x) >= std::abs(y) ? std::numbers::pi / 4.0 * y / x
                                                   : std::numbers::pi / 2.0 - std::numbers::pi / 4.0 * x / y;
                if (std::abs(x) >= std::abs(y) ? x < 0.0 : y < 0.0) angle += std::numbers::pi;
            }
            const Vector2d disc(size * std::cos(angle), size * std::sin(angle));
            out.nodes.push_back(radius_m * (0.5 * disc + 0.5 * Vector2d(x, y) / std::sqrt(2.0)));
        }
    }
    for (int k = 0; k < m; ++k) out.edge.push_back(node(m, k));
    for (int k = 0; k < m; ++k) out.edge.push_back(node(m - k, m));
    for (int k = 0; k < m; ++k) out.edge.push_back(node(0, m - k));
    for (int k = 0; k < m; ++k) out.edge.push_back(node(k, 0));
    for (int j = 0; j < m; ++j) {
        for (int i = 0; i < m; ++i)
            out.quads.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
    return out;
}

struct Builder {
    std::vector<Vector3d> nodes;
    std::vector<std::array<int, 8>> cells;
    std::vector<int> inside;

    void add_layer(const Quads& quads, const std::vector<int>& below, const std::vector<int>& above) {
        for (const auto& q : quads) {
            std::array<int, 8> cell{};
            for (std::size_t k = 0; k < 4; ++k) {
                cell[k] = below[at(q[k])];
                cell[k + 4] = above[at(q[k])];
            }
            cells.push_back(cell);
        }
    }
};

// Adds the wall; returns the nodes of its top ring.
std::vector<int> add_wall(const Bellows& b, Builder& out) {
    const int circles = b.through + 1;
    const Quads quads = ring_quads(b, circles);
    std::vector<int> below;
    for (int layer = 0; layer <= b.along; ++layer) {
        std::vector<int> above;
        for (int c = 0; c < circles; ++c) {
            const Vector2d rz = wall_point(b, static_cast<double>(layer) / b.along, 2.0 * c / b.through - 1.0);
            for (int s = 0; s < b.sectors; ++s) {
                const Vector2d xy = round(rz(0), s, b.sectors);
                above.push_back(static_cast<int>(out.nodes.size()));
                if (c == 0) out.inside.push_back(above.back());
                out.nodes.emplace_back(xy.x(), xy.y(), rz(1));
            }
        }
        if (layer > 0) {
            out.add_layer(quads, below, above);
        }
        below = above;
    }
    return below;
}

// The plane of the plate: nodes of the wall's ring first, then those within.
struct Plane {
    std::vector<Vector2d> nodes;
    Quads quads;
};

Plane plane_of(const Bellows& b) {
    Plane out;
    const int circles = b.through + 1;
    for (int c = 0; c < circles; ++c) {
        const double r = wall_point(b, 1.0, 2.0 * c / b.through - 1.0)(0);
        for (int s = 0; s < b.sectors; ++s) out.nodes.push_back(round(r, s, b.sectors));
    }
    out.quads = ring_quads(b, circles);
    const double inner_m = wall_point(b, 1.0, -1.0)(0);
    const Middle middle = middle_of(b, b.rings == 0 ? inner_m : 0.55 * inner_m);
    // turned so that the square's first edge node, its corner below right, stands at sector 0
    const double turn = std::numbers::pi / 4.0;
    // without rings the edge of the middle is the wall's inner circle itself
    std::vector<int> node_of(middle.nodes.size(), -1);
    for (std::size_t s = 0; b.rings == 0 && s < middle.edge.size(); ++s)
        node_of[at(middle.edge[s])] = ring_node(b, 0, static_cast<int>(s));
    for (std::size_t i = 0; i < middle.nodes.size(); ++i) {
        if (node_of[i] >= 0) continue;
        const Vector2d& p = middle.nodes[i];
        node_of[i] = static_cast<int>(out.nodes.size());
        out.nodes.emplace_back(std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                               std::sin(turn) * p.x() + std::cos(turn) * p.y());
    }
    for (const auto& q : middle.quads)
        out.quads.push_back({node_of[at(q[0])], node_of[at(q[1])], node_of[at(q[2])], node_of[at(q[3])]});
    std::vector<int> inner;
    for (const int node : middle.edge) inner.push_back(node_of[at(node)]);
    for (int ring = 1; ring <= b.rings; ++ring) {
        std::vector<int> outer;
        for (int s = 0; s < b.sectors; ++s) {
            if (ring == b.rings) {
                outer.push_back(ring_node(b, 0, s));
                continue;
            }
            const Vector2d from = out.nodes[at(inner[at(s)])];
            const double share = 1.0 / (b.rings - ring + 1);
            outer.push_back(static_cast<int>(out.nodes.size()));
            out.nodes.push_back((1.0 - share) * from + share * round(inner_m, s, b.sectors));
        }
        for (int s = 0; s < b.sectors; ++s) {
            const auto next = at((s + 1) % b.sectors);
            out.quads.push_back({inner[at(s)], outer[at(s)], outer[next], inner[next]});
        }
        inner = outer;
    }
    return out;
}

void add_plate(const Bellows& b, const std::vector<int>& top_ring, Builder& out) {
    const Plane plane = plane_of(b);
    std::vector<int> below;
    for (int layer = 0; layer <= b.plate_cells; ++layer) {
        std::vector<int> above;
        for (std::size_t i = 0; i < plane.nodes.size(); ++i) {
            if (layer == 0 && i < top_ring.size()) {
                above.push_back(top_ring[i]);
                continue;
            }
            above.push_back(static_cast<int>(out.nodes.size()));
            if (layer == 0) out.inside.push_back(above.back());
            const double z = b.height_m + b.plate_m * layer / b.plate_cells;
            out.nodes.emplace_back(plane.nodes[i].x(), plane.nodes[i].y(), z);
        }
        if (layer > 0) out.add_layer(plane.quads, below, above);
        below = above;
    }
}

}  // namespace

BellowsMesh bellows(const Bellows& shape) {
    check(shape);
    Builder built;
    const std::vector<int> top_ring = add_wall(shape, built);
    add_plate(shape, top_ring, built);
    BellowsMesh out;
    out.mesh.nodes_m.resize(3, static_cast<Index>(built.nodes.size()));
    for (std::size_t i = 0; i < built.nodes.size(); ++i) out.mesh.nodes_m.col(static_cast<Index>(i)) = built.nodes[i];
    out.mesh.cells.resize(8, static_cast<Index>(built.cells.size()));
    for (std::size_t i = 0; i < built.cells.size(); ++i) {
        for (Index k = 0; k < 8; ++k) out.mesh.cells(k, static_cast<Index>(i)) = built.cells[i][at(k)];
    }
    out.mesh.region = Eigen::VectorXi::Zero(out.mesh.cells.cols());
    out.inside = std::move(built.inside);  // in the order in which the nodes were made
    return out;
}

Mesh split_columns_to_tets(const Mesh& hexes) {
    // a prism (0 1 2 below, 3 4 5 above) turned so that its lowest node is corner 0
    constexpr std::array<std::array<int, 6>, 6> kTurns{{{0, 1, 2, 3, 4, 5},
                                                        {1, 2, 0, 4, 5, 3},
                                                        {2, 0, 1, 5, 3, 4},
                                                        {3, 5, 4, 0, 2, 1},
                                                        {4, 3, 5, 1, 0, 2},
                                                        {5, 4, 3, 2, 1, 0}}};
    constexpr std::array<std::array<std::size_t, 6>, 2> kPrisms{{{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}}};
    Mesh out;
    out.nodes_m = hexes.nodes_m;
    out.node_number = hexes.node_number;
    out.cells.resize(4, 6 * hexes.cells.cols());
    out.region.resize(out.cells.cols());
    Index next = 0;
    for (Index cell = 0; cell < hexes.cells.cols(); ++cell) {
        for (const auto& corners : kPrisms) {
            std::array<int, 6> prism{};
            for (std::size_t k = 0; k < 6; ++k) prism[k] = hexes.cells(static_cast<Index>(corners[k]), cell);
            const auto lowest = std::min_element(prism.begin(), prism.end()) - prism.begin();
            std::array<int, 6> v{};
            for (std::size_t k = 0; k < 6; ++k) v[k] = prism[at(kTurns[at(lowest)][k])];
            const bool from_1 = std::min(v[1], v[5]) < std::min(v[2], v[4]);  // diagonal of the face without corner 0
            const auto add = [&](int a, int b, int c, int d) {
                out.cells.col(next) << a, b, c, d;
                out.region(next++) = hexes.region(cell);
            };
            if (from_1) {
                add(v[0], v[1], v[2], v[5]);
                add(v[0], v[1], v[5], v[4]);
            } else {
                add(v[0], v[1], v[2], v[4]);
                add(v[0], v[4], v[2], v[5]);
            }
            add(v[0], v[4], v[5], v[3]);
        }
    }
    return out;
}

}  // namespace palpa::mechanics
