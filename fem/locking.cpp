#include "fem/locking.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "files/text.h"

namespace palpa::fem {
namespace {

using namespace mechanics;

// Stiffness under the load relative to that of hex8-bbar on the same nodes, for the slab of docs/fem.md on 20 x 20 x 10
// bricks, 2026-11. The list begins where locking clearly exceeds the error of the mesh. At Poisson's ratio 0.30 tet4 is
// 1.09 and hex8 1.02 times too stiff, at 0.45 (the default tissue) 1.16 and 1.05 times. At 0.47 the excess is more than
// twice that at 0.30 for tet4 and more than three times for hex8; from there on it grows with lambda / mu.
struct Locking {
    double poisson;
    double factor;
};
constexpr std::array<Locking, 6> kTet4{
    {{0.47, 1.21}, {0.48, 1.28}, {0.49, 1.44}, {0.495, 1.71}, {0.499, 3.39}, {0.4999, 18.3}}};
constexpr std::array<Locking, 6> kHex8{
    {{0.47, 1.07}, {0.48, 1.10}, {0.49, 1.17}, {0.495, 1.28}, {0.499, 1.87}, {0.4999, 5.69}}};
// on bricks that are not cubes; 1.01 times at 0.49
constexpr std::array<Locking, 3> kHex8i{{{0.499, 1.03}, {0.4999, 1.13}, {0.49999, 1.47}}};

std::span<const Locking> measured(Element element) {
    if (element == Element::tet4) return kTet4;
    if (element == Element::hex8) return kHex8;
    if (element == Element::hex8i) return kHex8i;
    return {};
}

// Displacement of the tip of a bar of 10 x 1 x 1 over that of Euler and Bernoulli, with 1, 2 and 3 cells across; Poisson's ratio
// 0.3. Measured; docs/fem.md has the table.
constexpr int kFewAcross = 3;
struct Bending {
    std::array<double, kFewAcross> cubes;
    std::array<double, kFewAcross> long_cells;  // twice as long as thick; 0: not measured
};
constexpr Bending kBbarBends{{1.21, 0.98, 0.99}, {0.50, 0.77, 0.88}};
constexpr Bending kHex8Bends{{0.65, 0.88, 0.94}, {}};
constexpr Bending kTet4Bends{{0.22, 0.51, 0.69}, {}};

// The planes of nodes of a box along an axis; empty if the nodes are no box's.
std::array<std::vector<double>, 3> planes_of(const Eigen::Matrix3Xd& nodes_m) {
    std::array<std::vector<double>, 3> planes;
    std::size_t nodes = 1;
    for (Eigen::Index c = 0; c < 3; ++c) {
        std::vector<double>& at = planes[static_cast<std::size_t>(c)];
        for (Eigen::Index i = 0; i < nodes_m.cols(); ++i) at.push_back(nodes_m(c, i));
        std::sort(at.begin(), at.end());
        at.erase(std::unique(at.begin(), at.end()), at.end());
        nodes *= at.size();
    }
    if (nodes != static_cast<std::size_t>(nodes_m.cols())) return {};
    return planes;
}

}  // namespace

std::string bending_warning(const FemCase& model) {
    if (!model.mesh_file.empty() || model.problem.element == Element::hex8i) return "";
    const auto planes = planes_of(model.problem.mesh.nodes_m);
    if (planes[0].empty()) return "";
    const auto size_m = [&](std::size_t c) { return planes[c].back() - planes[c].front(); };
    const double longest_m = std::max({size_m(0), size_m(1), size_m(2)});
    const auto across = [&](std::size_t c) { return static_cast<int>(planes[c].size()) - 1; };
    std::optional<std::size_t> worst;  // the axis with fewest cells
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string axis(1, "xyz"[c]);
        const auto holds = [&](const CaseSupport& one) { return one.name == axis + "min" || one.name == axis + "max"; };
        if (across(c) > kFewAcross || size_m(c) > 0.25 * longest_m) continue;
        if (std::any_of(model.supports.begin(), model.supports.end(), holds)) continue;
        if (!worst || across(c) < across(*worst)) worst = c;
    }
    if (!worst) return "";
    const Element element = model.problem.element;
    const Bending& bends = element == Element::tet4 ? kTet4Bends : element == Element::hex8 ? kHex8Bends : kBbarBends;
    const auto k = static_cast<std::size_t>(across(*worst) - 1);
    const std::string on_long_cells =
        bends.long_cells[k] > 0.0 ? ", " + files::short_number(bends.long_cells[k]) + " on cells twice as long" : "";
    return files::counted(across(*worst), "cell") + " across the body along " + std::string(1, "xyz"[*worst]) +
           ": bent that way, the bar of docs/fem.md has with " + name_of(element) + " " +
           files::short_number(bends.cubes[k]) + " of its displacement on cubes" + on_long_cells +
           ", and on flat cells more; hex8i bends right";
}

std::string locking_warning(const Problem& problem) {
    const std::span<const Locking> rows = measured(problem.element);
    double poisson = -1.0;
    for (const Material& m : problem.materials) poisson = std::max(poisson, m.poisson);
    if (rows.empty() || !(poisson >= rows.front().poisson)) return "";
    const Locking* row = &rows.front();
    for (const Locking& next : rows) {
        if (next.poisson <= poisson) row = &next;
    }
    return std::string(name_of(problem.element)) + " locks at poisson " + files::number_text(poisson) +
           ": on the slab of docs/fem.md it is " + files::short_number(row->factor) + " times too stiff at " +
           files::number_text(row->poisson) + (poisson > rows.back().poisson ? ", and more here" : "") +
           "; hex8-bbar does not lock" + (problem.element == Element::tet4 ? " (it needs hexahedra)" : "");
}

}  // namespace palpa::fem
