#include "fem/locking.h"

#include <algorithm>
#include <array>

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
    double tet4;
    double hex8;
};
constexpr std::array<Locking, 6> kMeasured{{{0.47, 1.21, 1.07},
                                            {0.48, 1.28, 1.10},
                                            {0.49, 1.44, 1.17},
                                            {0.495, 1.71, 1.28},
                                            {0.499, 3.39, 1.87},
                                            {0.4999, 18.3, 5.69}}};

}  // namespace

std::string locking_warning(const Problem& problem) {
    const bool locks = problem.element == Element::hex8 || problem.element == Element::tet4;
    if (!locks || problem.materials.empty()) return "";
    double poisson = -1.0;
    for (const Material& m : problem.materials) poisson = std::max(poisson, m.poisson);
    if (!(poisson >= kMeasured.front().poisson)) return "";
    const Locking* row = &kMeasured.front();
    for (const Locking& next : kMeasured) {
        if (next.poisson <= poisson) row = &next;
    }
    const bool tets = problem.element == Element::tet4;
    return std::string(tets ? "tet4" : "hex8") + " locks at poisson " + files::number_text(poisson) +
           ": on the slab of docs/fem.md it is " + files::short_number(tets ? row->tet4 : row->hex8) +
           " times too stiff at " + files::short_number(row->poisson) + "; hex8-bbar does not lock" +
           (tets ? " (it needs hexahedra)" : "");
}

}  // namespace palpa::fem
