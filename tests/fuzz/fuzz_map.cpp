// Map folders: map.json and normal_N.npy, which begins where the input says so.

#include <algorithm>

#include "stiffnessmaps/map_file.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;

namespace {

struct MapFolder {
    MapFolder() {
        folder.add("map.json", json);
        folder.add("normal_N.npy", normal);
    }
    fuzz::MemoryFile json{"map.json"};
    fuzz::MemoryFile normal{"normal_N.npy"};
    fuzz::MemoryFolder folder;
};

}  // namespace

PALPA_FUZZ_ENTRY(map)(const std::uint8_t* data, std::size_t size) {
    static MapFolder folder;
    const std::string_view bytes = fuzz::text_of(data, size);
    const auto array = std::min(bytes.find("\x93NUMPY"), bytes.size());
    folder.json.with(bytes.substr(0, array));
    folder.normal.with(bytes.substr(array));
    return fuzz::read_or_refuse([&] { check_map(read_map(folder.folder.path()), "a.map"); });
}
