// Gmsh meshes, as text and binary.

#include "files/msh.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;

PALPA_FUZZ_ENTRY(msh)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const Msh msh = parse_msh(fuzz::text_of(data, size), "a.msh");
        const auto n = static_cast<int>(msh.n_nodes());
        for (std::size_t kind = 0; kind < kMshKinds; ++kind) {
            const MshCells& cells = msh.cells[kind];
            if (cells.nodes.size() != cells.number.size() * static_cast<std::size_t>(kMshCorners[kind]))
                fuzz::finding("corners that are too many or too few");
            for (const int node : cells.nodes) {
                if (node < 0 || node >= n) fuzz::finding("a corner that is no node");
            }
            for (const MshGroup& group : msh.groups) {
                for (const int cell : group.cells[kind]) {
                    if (cell < 0 || static_cast<std::size_t>(cell) >= cells.number.size())
                        fuzz::finding("a group of cells that are not there");
                }
            }
        }
    });
}
