// Runs of voxels as NumPy files.

#include "parts/runs_file.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;

PALPA_FUZZ_ENTRY(runs)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        mechanics::Voxels voxels = mechanics::empty_voxels({64, 16, 16}, {});
        const auto rows = files::parse_npy_integers(fuzz::text_of(data, size), "r.npy");
        const auto runs = parts::runs_of(rows, "r.npy", voxels, 3);
        mechanics::EditHistory history;
        std::int64_t wanted = 0;
        for (const auto& placed : runs) wanted += placed.run.x1 - placed.run.x0;
        if (mechanics::overlay(runs, voxels, history) != wanted)
            fuzz::finding("runs that are not laid as they are read");
    });
}
