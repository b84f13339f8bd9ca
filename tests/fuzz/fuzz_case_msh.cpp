// Gmsh meshes as the body of a case.

#include "fem/case.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::fem;

PALPA_FUZZ_ENTRY(case_msh)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("msh");
    file.with(fuzz::text_of(data, size));
    return fuzz::read_or_refuse([&] {
        Json json{{"mesh", {{"file", file.path().string()}}},
                  {"materials", {{"gel", {{"young_Pa", 2500.0}, {"poisson", 0.45}}}}},
                  {"supports", {{{"face", "zmin"}, {"fix", "xyz"}}}}};
        for (const char* element : {"tet4", "hex8"}) {
            json["element"] = element;
            fuzz::read_or_refuse([&] { parse_case(json, "case.json", "nowhere"); });
        }
    });
}
