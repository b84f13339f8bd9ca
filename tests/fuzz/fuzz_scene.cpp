// Scenes.

#include "scene/scene.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::scene;

PALPA_FUZZ_ENTRY(scene)(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file("scene");
    return fuzz::read_or_refuse([&] { path_of(read_scene(file.with(fuzz::text_of(data, size)), "assets")); });
}
