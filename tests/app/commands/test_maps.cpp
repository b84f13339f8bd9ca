// palpa maps detect, plot, export and compare as a person calls them.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <limits>

#include "files/json.h"
#include "files/mat.h"
#include "files/npy.h"
#include "files/table.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/shell.h"
#include "tests/study/python.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

const std::string kSilicone = PALPA_SOURCE_DIR "/assets/maps/silicone.map";

Called maps(const std::string& arguments, const std::string& before = "") {
    return shell(before + " timeout 120 " PALPA_PROGRAM " maps " + arguments);
}

void refused(const std::string& arguments, const std::string& word, int status = 2, const std::string& before = "") {
    const Called called = maps(arguments, before);
    CAPTURE(arguments);
    CAPTURE(called.err);
    CHECK(called.status == status);
    CHECK(contains(called.err, word));
}

// 10 x 8 cells, two depths, both tangential forces, some of it not measured.
Map small(const TemporaryFolder& folder) {
    Map map;
    map.name = "it's \"small\"";
    map.n_x = 10;
    map.n_y = 8;
    map.depths_m = {1e-3, 2.5e-3};
    map.tangential = TangentialKind::recorded;
    for (std::size_t at = 0; at < 2 * map.n_cells(); ++at) {
        const auto value = static_cast<float>(std::sin(0.7 * static_cast<double>(at)) / 3.0);
        map.normal_N.push_back(1.0f + value + static_cast<float>(at / map.n_cells()));
        map.tangential_x_N.push_back(value);
        map.tangential_y_N.push_back(-0.1f * value);
    }
    map.normal_N[13] = map.tangential_x_N[13] = std::numeric_limits<float>::quiet_NaN();
    write_map(map, folder / "small.map");
    return map;
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("command maps detect: text, JSON and what is kept in map.json") {
    const TemporaryFolder folder;
    std::filesystem::copy(kSilicone, folder / "s.map");
    const std::string map = (folder / "s.map").string();
    const Called said = maps("detect " + map + " --write");
    CHECK(said.status == 0);
    CHECK(said.err == "");
    CHECK(contains(said.out, "3 stiff regions\n"));
    CHECK(contains(said.out, "placed nodule C"));
    const Json kept = read_json(folder / "s.map/map.json");
    REQUIRE(kept["nodules"].size() == 6);
    CHECK(kept["nodules"][0]["origin"] == "placed");
    CHECK(kept["nodules"][5]["origin"] == "detected");
    const Called json = maps("detect " + map + " --json --write");
    const Json found = parse_json(json.out, "stdout");
    CHECK(found["sure"] == 3);
    CHECK(found["regions"][0]["placed"] == "A");
    CHECK(read_json(folder / "s.map/map.json") == kept);  // again: the same, not twice
    // only the tops of A and B are left above 1.1 times the background
    CHECK(parse_json(maps("detect " + map + " --json --threshold 1.1").out, "stdout")["regions"].size() == 2);
    refused("detect " + map + " --threshold 0.5", "--threshold");
    refused("detect " + map + " --threshold 1", "--threshold: found 1, expected a ratio above 1");
    refused("detect " + map + " --deepest-mm 1", "no cell with a force down to 1 mm");
    refused("detect " + (folder / "no.map").string(), "expected a map folder");
}

TEST_CASE("command maps detect: what the map's noise does not allow is warned about, and not kept") {
    const auto liver = std::filesystem::path(PALPA_RECORDINGS) / "probing/pig_liver_20150826_region1.csv";
    if (!std::filesystem::exists(liver)) {
        MESSAGE("not checked: the recording is not beside the checkout: ", liver.string());
        return;
    }
    const TemporaryFolder folder;
    const std::string map = (folder / "l.map").string();
    REQUIRE(maps("import " + liver.string() + " -o " + map).status == 0);
    const Called said = maps("detect " + map + " --json --write");
    CHECK(said.status == 0);
    const Json found = parse_json(said.out, "stdout");
    CHECK(found["sure"] == 0);
    CHECK(found["warnings"].size() == found["regions"].size());
    if (!found["regions"].empty()) CHECK(contains(said.err, "warning"));
    CHECK(read_json(folder / "l.map/map.json")["nodules"].empty());
}

TEST_CASE("command maps export: every format gives back the same floats") {
    const TemporaryFolder folder;
    const Map map = small(folder);
    const std::string name = (folder / "small.map").string();
    const auto file = [&](const char* leaf) { return (folder / leaf).string(); };
    REQUIRE(maps("export " + name + " -o " + file("n.npy")).status == 0);
    CHECK(same(read_npy(folder / "n.npy").values, map.normal_N));
    CHECK(read_npy(folder / "n.npy").shape == std::vector<std::size_t>{2, 8, 10});
    REQUIRE(maps("export " + name + " --array tangential_y_N -o " + file("t.npy")).status == 0);
    CHECK(same(read_npy(folder / "t.npy").values, map.tangential_y_N));
    REQUIRE(maps("export " + name + " -o " + file("arrays")).status == 0);
    CHECK(same(read_npy(folder / "arrays/tangential_x_N.npy").values, map.tangential_x_N));
    CHECK(read_npy(folder / "arrays/depths_mm.npy").values == std::vector<float>{1.0f, 2.5f});
    REQUIRE(maps("export " + name + " -o " + file("m.mat")).status == 0);
    CHECK(same(read_mat("normal_N", folder / "m.mat").values, map.normal_N));
    CHECK(same(read_mat("tangential_x_N", folder / "m.mat").values, map.tangential_x_N));
    REQUIRE(maps("export " + name + " -o " + file("m.csv")).status == 0);
    Table table = read_csv(folder / "m.csv");
    std::vector<float> normal, along_x;
    while (table.next()) {
        const std::size_t cell = normal.size() % map.n_cells();
        CHECK(table.number(table.column("x_mm")) == close_to(1e3 * map.x_of(cell % map.n_x)));
        CHECK(table.number(table.column("y_mm")) == close_to(1e3 * map.y_of(cell / map.n_x)));
        normal.push_back(static_cast<float>(table.number(table.column("normal_N"))));
        along_x.push_back(static_cast<float>(table.number(table.column("tangential_x_N"))));
    }
    CHECK(same(normal, map.normal_N));
    CHECK(same(along_x, map.tangential_x_N));
    const std::string python = python_with("scipy");
    if (python.empty()) {
        MESSAGE("not checked: no Python with scipy");
    } else {
        CHECK(run_python(python, folder,
                         "import numpy, scipy.io\nm = scipy.io.loadmat('m.mat')\nn = numpy.load('n.npy')\n"
                         "assert m['normal_N'].dtype == numpy.float32 and n.shape == (2, 8, 10)\n"
                         "assert numpy.array_equal(m['normal_N'], n, equal_nan=True)\n"
                         "assert numpy.isnan(n[0, 1, 3]) and m['depths_mm'].tolist() == [[1.0, 2.5]]\n"));
    }
    refused("export " + name + " -o " + file("m.xls"), "expected .npy, .csv, .mat");
    refused("export " + name + " --array normal_N -o " + file("m.csv"), "--array: found with");
    refused("export " + name + " -o " + file(".csv"), "found an ending alone, expected a name before it");
    refused("export " + name + " -o " + file("arrays"), "nothing is overwritten");
    refused("export " + name + " -o " + file("no/such/m.csv"), "no/such/m.csv", 2);
    refused("export " + name + " -o " + file("no/such/m.mat"), "found no folder", 2);
    refused("export " + name + " -o " + file("no/such/arrays"), "cannot be written", 1);
    Map plain = map;
    plain.tangential = TangentialKind::none;
    plain.tangential_x_N.clear();
    plain.tangential_y_N.clear();
    write_map(plain, folder / "plain.map");
    refused("export " + file("plain.map") + " --array tangential_x_N -o " + file("x.npy"), "expected one of normal_N");
}

TEST_CASE("command maps: a map without a measured cell is refused by name") {
    const TemporaryFolder folder;
    Map map = small(folder);
    std::string bytes = read_text(folder / "small.map/normal_N.npy");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t at = bytes.size() - 4 * map.normal_N.size(); at < bytes.size(); at += 4)
        std::memcpy(&bytes[at], &nan, 4);
    write_text_atomically(folder / "small.map/normal_N.npy", bytes);
    const std::string name = (folder / "small.map").string();
    for (const std::string& command : {"detect " + name, "plot " + name + " -o x.png", "export " + name + " -o x.csv",
                                       "compare " + name + " " + kSilicone}) {
        refused(command, "no force that was measured");
    }
}

TEST_CASE("command maps plot: every figure in every format, whatever the map is called") {
    const TemporaryFolder folder;
    small(folder);
    const std::string name = (folder / "small.map").string();
    refused("plot " + name + " -o x.gif", "expected .png, .svg or .pdf");
    refused("plot " + name + " -o x.png --at here", "X,Y in mm");
    refused("plot " + name + " -o x.png --what stiffness --at 1,1",
            "--at: found with --what stiffness, expected curves");
    refused("plot " + name + " -o x.png --what curves --force-N 1",
            "--force-N: found with --what curves, expected slice");
    refused("plot " + name + " -o x.png --what slice --force-N 500", "the map's greatest force");
    if (!has_gnuplot()) {
        MESSAGE("not checked: gnuplot is not installed");
        return;
    }
    for (const std::string what : {"all", "matrices", "stiffness", "slice", "curves", "nodules"}) {
        CAPTURE(what);
        const Called called = maps("plot " + name + " --what " + what + " -o " + (folder / (what + ".png")).string());
        CHECK(called.status == 0);
        CHECK(called.err == "");
        CHECK(read_text(folder / (what + ".png")).substr(1, 3) == "PNG");
    }
    CHECK(maps("plot " + name + " -o " + (folder / "a.svg").string()).status == 0);
    CHECK(contains(read_text(folder / "a.svg"), "it's"));
    CHECK(maps("plot " + name + " --what curves --at 1,2 --at 4,4 -o " + (folder / "a.pdf").string()).status == 0);
    CHECK(read_text(folder / "a.pdf").substr(0, 4) == "%PDF");
    refused("plot " + name + " --what curves --at 99,2 -o " + (folder / "b.png").string(),
            "expected a place on the map");
    refused("plot " + name + " -o " + (folder / "no/such/x.png").string(), "no/such/x.png", 2);
    CHECK_FALSE(std::filesystem::exists(folder / "b.png"));
}

TEST_CASE("command maps plot: pictures of fewer than four places are refused, curves are drawn") {
    const TemporaryFolder folder;
    Map map;
    map.name = "tiny";
    map.n_x = 3;
    map.n_y = 1;
    map.depths_m = {1e-3, 2e-3};
    map.normal_N = {1.0f, 1.1f, 1.2f, 2.0f, 2.2f, 2.4f};
    write_map(map, folder / "tiny.map");
    const std::string name = (folder / "tiny.map").string(), figure = (folder / "f.png").string();
    if (!has_gnuplot()) return;
    refused("plot " + name + " -o " + figure, "found 3 x 1 places, expected at least 4");
    refused("compare " + name + " " + name + " -o " + figure, "found 3 x 1 places, expected at least 4");
    CHECK_FALSE(std::filesystem::exists(figure));
    CHECK(maps("plot " + name + " --what curves -o " + figure).status == 0);
    map.n_x = 4;
    map.normal_N = {1.0f, 1.1f, 1.2f, 1.3f, 2.0f, 2.2f, 2.4f, 2.6f};
    write_map(map, folder / "row.map");
    const Called called = maps("plot " + (folder / "row.map").string() + " -o " + figure);
    CHECK(called.status == 0);
    CHECK(called.err == "");
}

TEST_CASE("command maps plot: without gnuplot a message says what is missing") {
    const TemporaryFolder folder;
    small(folder);
    const TemporaryFolder empty;
    std::filesystem::create_symlink("/usr/bin/timeout", empty / "timeout");
    refused("plot " + (folder / "small.map").string() + " -o " + (folder / "x.png").string(),
            "gnuplot cannot be started (is it installed? package gnuplot-nox)", 1, "PATH=" + empty.path().string());
}

TEST_CASE("command maps compare: figures of difference, as text, JSON and picture") {
    const TemporaryFolder folder;
    Map map = small(folder);
    for (float& force : map.normal_N) force += 0.5f;
    write_map(map, folder / "more.map");
    const std::string pair = (folder / "small.map").string() + " " + (folder / "more.map").string();
    const Called text = maps("compare " + pair);
    CHECK(text.status == 0);
    CHECK(
        contains(text.out, "  bias 0.49"));  // one force was missing: interpolated over depth, where the rise is shared
    const Json json = parse_json(maps("compare " + pair + " --json").out, "stdout");
    CHECK(json["all"]["rms_N"].get<double>() == close_to(0.5).epsilon(0.01));
    CHECK(json["grid_of"] == "a");
    CHECK(json["depths"].size() == 2);
    refused("compare " + pair + " -o x.gif", "expected .png, .svg or .pdf");
    map.origin_m[0] += 1.0;
    write_map(map, folder / "away.map");
    refused("compare " + (folder / "small.map").string() + " " + (folder / "away.map").string(),
            "expected one that overlaps");
    if (!has_gnuplot()) return;
    CHECK(maps("compare " + pair + " -o " + (folder / "d.png").string()).status == 0);
    CHECK(read_text(folder / "d.png").substr(1, 3) == "PNG");
}

TEST_CASE("command maps: help exists for every command") {
    for (const char* command : {"detect", "plot", "export", "compare"}) {
        const Called help = maps(std::string(command) + " --help");
        CAPTURE(command);
        CHECK(help.status == 0);
        CHECK(help.out.size() > 200);
    }
}

TEST_CASE("maps: forces that are never above 0 have no stiff regions, and no ratio is printed as a number") {
    const TemporaryFolder folder;
    for (const double factor : {0.0, -1.0}) {
        CAPTURE(factor);
        Map map = read_map(kSilicone);
        for (float& force_N : map.normal_N) force_N *= static_cast<float>(factor);
        const std::string name = (folder / (factor < 0.0 ? "reversed.map" : "zero.map")).string();
        write_map(map, name);
        refused("detect " + name + " --write", "no cell that resists");
        CHECK(contains(maps("info " + name).err, "found no force above zero, expected pressing to be positive"));
        const Called compared = maps("compare " + name + " " + name);
        CHECK(compared.status == 0);
        CHECK_FALSE(contains(compared.out, "nan"));
    }
}
