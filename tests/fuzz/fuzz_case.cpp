// Cases of finite elements with a small box for a mesh.

#include "fem/case.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::fem;

namespace {

// A large mesh is no finding, it only takes its time; files of meshes are another target's.
bool is_small(const Json& json) {
    if (!json.is_object() || !json.contains("mesh") || !json["mesh"].is_object()) return true;
    const Json& mesh = json["mesh"];
    if (mesh.contains("file")) return false;
    if (!mesh.contains("box") || !mesh["box"].is_object() || !mesh["box"].contains("elements")) return true;
    double n = 1.0;
    for (const Json& count : mesh["box"]["elements"]) n *= count.is_number() ? count.get<double>() : 1.0;
    constexpr double kMost = 300.0;
    return n <= kMost;
}

}  // namespace

PALPA_FUZZ_ENTRY(case)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        const Json json = parse_json(fuzz::text_of(data, size), "case.json");
        if (!is_small(json)) return;
        parse_case(json, "case.json", "nowhere");
    });
}
