// STL files, text and binary, and whether they are closed.

#include <cmath>

#include "mechanics/error.h"
#include "parts/stl_file.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;

PALPA_FUZZ_ENTRY(stl)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        auto triangles = parts::parse_stl(fuzz::text_of(data, size), "a.stl", 1e-3);
        if (triangles.empty()) fuzz::finding("an STL file without triangles");
        try {
            const mechanics::TriangleSolid solid = mechanics::make_solid(std::move(triangles));
            const mechanics::SolidCheck check = check_solid(solid, 12);
            if (!(check.open_share >= 0.0 && check.open_share <= 1.0)) fuzz::finding("a share of lines beyond 0 to 1");
            if (std::isnan(check.volume_m3)) fuzz::finding("a volume that is no number");
        } catch (const mechanics::MeshError& error) {
            fuzz::check_message(error.what());
        }
    });
}
