#include "fem/locking.h"

#include <algorithm>
#include <array>
#include <span>

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

}  // namespace

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
