#include <algorithm>
#include <cstdlib>
#include <doctest/doctest.h>

#include "app/assets.h"
#include "app/scene_choices.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/study/python.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::app;
using namespace palpa::test;
namespace fs = std::filesystem;

TEST_CASE("assets: found beside the program, installed or in a build folder, wherever the tree was moved") {
    const TemporaryFolder folder;
    const fs::path root = folder / "opt/somewhere";
    fs::create_directories(root / "share/palpa/assets/scenes");
    fs::create_directories(root / "bin");
    CHECK(assets_beside(root / "bin/palpa") == root / "share/palpa/assets");

    const fs::path source = folder / "source";
    fs::create_directories(source / "assets/scenes");
    for (const char* program : {"build/release/palpa", "build/dev/tests/app/test_app"}) {
        CHECK(assets_beside(source / program) == source / "assets");
    }
    fs::create_directories(source / "share/palpa/assets/scenes");  // installed into the sources: that one
    CHECK(assets_beside(source / "bin/palpa") == source / "share/palpa/assets");
}

TEST_CASE(
    "assets: a folder of that name without scenes is another program's; without any the message names the places") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "x/assets");
    const std::string message = message_of([&] { assets_beside(folder / "x/bin/palpa"); });
    CHECK(contains(message, (folder / "x/assets").string()));
    CHECK(contains(message, (folder / "x/bin/share/palpa/assets").string()));
    CHECK(contains(message, "PALPA_ASSETS"));
}

TEST_CASE("scenes: a name alone is looked for here, then among those that ship; a path is only that path") {
    CHECK(load_scene("toothbrush").file == assets_folder() / "scenes/toothbrush.json");
    CHECK(load_scene("toothbrush.json").file == assets_folder() / "scenes/toothbrush.json");
    const fs::path map = *fs::directory_iterator(assets_folder() / "maps");
    CHECK(std::get<scene::MapOptions>(load_scene(map.stem().string()).tissue).folder == map);
    const std::string message = message_of([] { load_scene("toothbrus"); });
    CHECK(contains(message, "toothbrus: found nothing"));
    CHECK(contains(message, assets_folder().string()));
    CHECK(contains(message_of([] { load_scene("scenes/toothbrush.json"); }), "found nothing"));
}

TEST_CASE("scenes: a folder of a shipped scene's name that is no map does not hide the scene") {
    const TemporaryFolder folder;
    const fs::path before = fs::current_path();
    fs::create_directories(folder / "toothbrush");
    fs::create_directories(folder / "other");
    fs::current_path(folder.path());
    const fs::path found = load_scene("toothbrush").file;
    const fs::path other = std::get<scene::MapOptions>(load_scene("other").tissue).folder;
    fs::current_path(before);
    CHECK(found == assets_folder() / "scenes/toothbrush.json");
    CHECK(other == "other");  // what it lacks is said where the map is read
}

TEST_CASE("scenes: a scene and a map of a person's own that cannot be read are listed by their files' names") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "palpa/scenes");
    fs::create_directories(folder / "palpa/maps/liver.map");
    write_text_atomically(folder / "palpa/scenes/lump.json", "{\"name\": \"Lump\",,}");
    write_text_atomically(folder / "palpa/maps/liver.map/map.json", "{");
    ::setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    const std::vector<Choice> scenes = scene_choices(), maps = map_choices();
    ::unsetenv("XDG_DATA_HOME");
    const auto listed = [](const std::vector<Choice>& choices, const std::string& name) {
        return std::any_of(choices.begin(), choices.end(), [&](const Choice& one) { return one.name == name; });
    };
    CHECK(listed(scenes, "lump"));
    CHECK(listed(maps, "liver"));
}

TEST_CASE("scenes: an edited copy of a shipped scene that has kept its name is told apart from it") {
    const TemporaryFolder folder;
    fs::create_directories(folder / "palpa/scenes");
    const fs::path shipped = assets_folder() / "scenes/default.json";
    fs::copy_file(shipped, folder / "palpa/scenes/mine.json");
    ::setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    const std::vector<Choice> scenes = scene_choices();
    ::unsetenv("XDG_DATA_HOME");
    std::string shipped_name, own_name;
    for (const Choice& one : scenes) {
        if (fs::path(one.file) == shipped) shipped_name = one.name;
        if (fs::path(one.file) == folder / "palpa/scenes/mine.json") own_name = one.name;
    }
    REQUIRE_FALSE(shipped_name.empty());
    CHECK(own_name == shipped_name + " (own, mine)");
}

// Python's jsonschema is the independent judge: the readers of Palpa do not look at the schemas.
TEST_CASE("assets: every shipped file is valid by the schema of its kind") {
    const std::string python = python_with("jsonschema");
    if (python.empty()) {
        MESSAGE("left out: no Python with jsonschema here");
        return;
    }
    const TemporaryFolder folder;
    const bool valid = run_python(python, folder, R"(
import glob, json, os, re, sys
from jsonschema import Draft202012Validator
assets = ')" PALPA_SOURCE_DIR R"(/assets'

def read(path):  # comments stand outside of texts
    text = open(path, encoding='utf-8').read()
    return json.loads(re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*', lambda found: found.group(1) or '', text))

kinds = {'cases': 'case', 'devices': 'device', 'fingers': 'finger', 'parts': 'part', 'phantoms': 'phantom',
         'plants': 'plant', 'profiles': 'profile', 'protocols': 'protocol', 'scenes': 'scene'}
own = {'arm.json': 'arm', 'pins-6x6.json': 'pins'}
files = [(file, own.get(os.path.basename(file), kind))
         for folder, kind in kinds.items() for file in glob.glob(assets + '/' + folder + '/*.json')]
files += [(file, 'map') for file in glob.glob(assets + '/maps/*.map/map.json')]
assert len(files) > 50, len(files)
for file, kind in files:
    schema = read(assets + '/schemas/' + kind + '.schema.json')
    for error in Draft202012Validator(schema).iter_errors(read(file)):
        sys.exit(file + ': ' + '/'.join(map(str, error.path)) + ': ' + error.message)
)");
    CHECK_MESSAGE(valid, read_text(folder / "said.txt"));
}
