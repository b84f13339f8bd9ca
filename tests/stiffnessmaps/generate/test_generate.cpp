// `palpa maps generate` as it is called: jobs, parts, a kill in the middle, damaged pieces, bad input.

#include <array>
#include <doctest/doctest.h>
#include <filesystem>
#include <set>
#include <sys/wait.h>

#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/generate/generate.h"
#include "stiffnessmaps/generate/pieces.h"
#include "stiffnessmaps/map_file.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

const std::string kPhantom = R"({
  "size_mm": [40, 40, 12], "tissue": {"young_Pa": 40000, "poisson": 0.45, "assumed": true},
  "nodules": [{"id": "A", "centre_mm": [20, 18, 6], "diameter_mm": 6, "young_Pa": 2e6, "poisson": 0.45}],
  "indenter": {"shape": "sphere", "radius_mm": 3, "contact": "rolling"},
  "depths_mm": [1, 2], "grid": {"origin_mm": [0, 2], "spacing_mm": [2, 4], "count": [21, 10]}
})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

struct Called {
    int status = 0;
    std::string err;
};

class Bench : public TemporaryFolder {
  public:
    Bench() { write_text_atomically(*this / "p.json", kPhantom); }
    std::string call(const std::string& map, const std::string& options) const {
        const char* coarse = contains(options, "analytic") ? "" : " --coarseness 4";
        return " " PALPA_PROGRAM " maps generate " + (*this / "p.json").string() + coarse + " -o " +
               (*this / map).string() + " " + options;
    }
    Called shell(const std::string& command) const {
        const int status = std::system(
            (command + " >" + (*this / "out").string() + " 2>" + (*this / "err").string() + " </dev/null").c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(*this / "err")};
    }
    Called generate(const std::string& map, const std::string& options) const {
        return shell("timeout 120" + call(map, options));
    }
    // All bytes of a map but its name, which is the phantom's.
    std::string bytes(const std::string& map) const {
        std::string all;
        for (const char* file : {"map.json", "normal_N.npy", "tangential_x_N.npy", "tangential_y_N.npy"})
            all += read_text(*this / map / file);
        return all;
    }
};

}  // namespace

TEST_CASE("generate: one process, two, parts that are joined, all give the same bytes") {
    const Bench bench;
    CHECK(bench.generate("one.map", "--jobs 1").status == 0);
    CHECK(bench.generate("two.map", "--jobs 2").status == 0);
    CHECK(bench.bytes("one.map") == bench.bytes("two.map"));
    CHECK_FALSE(fs::exists(bench / "one.map.lines"));

    CHECK(bench.generate("parts.map", "--part 2/2").status == 0);
    const Called early = bench.generate("parts.map", "--merge");
    CHECK(early.status == 1);
    CHECK(contains(early.err, "5 of 10 lines are not there yet (first: line 0)"));
    CHECK(bench
              .shell("SLURM_ARRAY_TASK_ID=3 SLURM_ARRAY_TASK_MIN=3 SLURM_ARRAY_TASK_COUNT=2 timeout 120" +
                     bench.call("parts.map", ""))
              .status == 0);
    CHECK(bench.generate("parts.map", "--merge").status == 0);
    CHECK(bench.bytes("parts.map") == bench.bytes("one.map"));

    const Map map = read_map(bench / "one.map");
    CHECK(map.source.kind == SourceKind::simulated);
    CHECK(contains(map.source.how, "Young's modulus, 40000 Pa, is ASSUMED"));
    CHECK(contains(map.source.how, "red, above 25 %, from 0.75 mm"));
    CHECK(contains(map.source.how, "Estimated error of the meshes: "));
    CHECK(contains(map.source.how, "times coarser"));
    CHECK(contains(map.source.how, "up to three times over stiff nodules"));
    CHECK_FALSE(fs::exists(bench / "one.map.estimate"));
    const auto at = [&](const std::vector<float>& array, std::size_t i) {
        return array[map.n_cells() + 4 * map.n_x + i];
    };
    CHECK(at(map.normal_N, 10) > 1.1f * at(map.normal_N, 3));  // over the nodule
    CHECK(at(map.tangential_x_N, 8) > 0.01f);                  // before it
    CHECK(at(map.tangential_x_N, 12) < -0.01f);                // behind it

    // a check speaks of this phantom alone
    for (const auto& [from, to] : {std::array{"40000, \"poisson\": 0.45", "40000, \"poisson\": 0.4"},
                                   std::array{"2e6", "1e6"}, std::array{"40, 12]", "40, 13]"}}) {
        write_text_atomically(bench / "p.json", replaced(kPhantom, from, to));
        const Called called = bench.generate("one.map", "--check");
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, "a map of another tissue"));
    }
}

TEST_CASE(
    "generate: killed in the middle, it goes on from what is finished; damaged and foreign pieces are made again") {
    const Bench bench;
    CHECK(bench.generate("whole.map", "--jobs 2").status == 0);
    const std::string pieces = (bench / "k.map.lines").string();
    bench.shell("(" + bench.call("k.map", "--jobs 1") + " & p=$!; while [ ! -e " + pieces +
                "/window-1 ]; do sleep 0.02; done; kill -9 $p )");
    CHECK_FALSE(fs::exists(bench / "k.map"));
    CHECK(fs::exists(bench / "k.map.lines/window-0"));
    const auto made = fs::last_write_time(bench / "k.map.lines/window-0");
    CHECK(bench.generate("k.map", "--part 1/2").status == 0);
    CHECK(fs::last_write_time(bench / "k.map.lines/window-0") == made);

    write_text_atomically(bench / "k.map.lines/line-0", "half a li");
    fs::copy_file(bench / "k.map.lines/line-2", bench / "k.map.lines/line-4", fs::copy_options::overwrite_existing);
    const Called again = bench.generate("k.map", "--jobs 2");
    CHECK(again.status == 0);
    CHECK(contains(again.err, "line-0: damaged, taken as missing"));
    CHECK(contains(again.err, "line-4: damaged, taken as missing"));
    CHECK(bench.bytes("k.map") == bench.bytes("whole.map"));

    CHECK(bench.generate("f.map", "--part 1/1").status == 0);
    write_text_atomically(bench / "p.json", replaced(kPhantom, "40000", "41000"));
    const Called foreign = bench.generate("f.map", "--jobs 2");
    CHECK(foreign.status == 0);
    CHECK(contains(foreign.err, "window-0: of another phantom or mesh, taken as missing"));
    CHECK(bench.bytes("f.map") != bench.bytes("whole.map"));
}

TEST_CASE(
    "generate: a cylinder that slides with friction, in one process or two, checked, looked up in both directions") {
    const Bench bench;
    const std::string sliding = replaced(replaced(kPhantom, "rolling\"", "sliding\", \"friction\": 0.3"), "\"sphere\"",
                                         "\"cylinder\", \"length_mm\": 6");
    write_text_atomically(bench / "p.json", sliding);
    CHECK(bench.generate("one.map", "--jobs 1").status == 0);
    CHECK(bench.generate("two.map", "--jobs 2").status == 0);
    CHECK(bench.bytes("one.map") == bench.bytes("two.map"));
    const Map map = read_map(bench / "one.map");
    CHECK(map.tangential == TangentialKind::recorded);
    CHECK(map.indenter == IndenterShape::cylinder);
    for (const char* words : {"cylinder 6 mm long", "slides steadily with a friction coefficient of 0.3",
                              "for motion along -x and -y friction has the other sign"}) {
        CHECK(contains(map.source.how, words));
    }
    const auto at = [&](const std::vector<float>& array, std::size_t i) {
        return array[map.n_cells() + 4 * map.n_x + i];
    };
    const auto share = [&](std::size_t i) { return at(map.tangential_x_N, i) / at(map.normal_N, i); };
    CHECK(share(8) > 0.3f);   // friction, and uphill before the nodule
    CHECK(share(12) < 0.3f);  // and downhill behind it
    CHECK(share(12) > 0.1f);
    CHECK(at(map.tangential_y_N, 10) > 0.2f * at(map.normal_N, 10));

    // the avatar's rule takes friction as even: it opposes motion along -x as well
    const Field field = make_field(map, {});
    const Place place = place_at(field, {map.x_of(10), map.y_of(4)});
    const double forth_N = tangential_force_N(field, place, {1.0, 0.0}, 0.002);
    const double back_N = tangential_force_N(field, place, {-1.0, 0.0}, 0.002);
    CHECK(forth_N > 0.2 * normal_force_N(field, place, 0.002));
    CHECK(back_N > 0.2 * normal_force_N(field, place, 0.002));
    // the arrays as they stand are right along + only
    const Field raw = make_field(map, {TangentialForce::recorded});
    CHECK(tangential_force_N(raw, place, {1.0, 0.0}, 0.002) > 0.0);
    CHECK(tangential_force_N(raw, place, {-1.0, 0.0}, 0.002) < 0.0);

    CHECK(bench.generate("one.map", "--check").status == 0);
    CHECK(contains(read_map(bench / "one.map").source.how, "tangential force "));
    CHECK(contains(read_text(bench / "one.map" / "convergence.json"), "max_tangential_difference"));
    CHECK(bench.shell("timeout 60 " PALPA_PROGRAM " maps info " + (bench / "one.map").string()).status == 0);
    write_text_atomically(bench / "s.json", R"({"name": "s", "tissue": {"map": "one.map"}})");
    CHECK(bench.shell("timeout 60 " PALPA_PROGRAM " explain " + (bench / "s.json").string()).status == 0);
    CHECK(contains(read_text(bench / "out"), "friction of the simulated slide along +x"));
}

TEST_CASE("generate: bad input ends with status 2 and says what was expected") {
    const Bench bench;
    const auto refused = [&](const std::string& from, const std::string& to, const std::string& options,
                             const char* words) {
        write_text_atomically(bench / "p.json", replaced(kPhantom, from, to));
        const Called called = bench.generate("n.map", options);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, words));
        CHECK_FALSE(fs::exists(bench / "n.map"));
        CHECK_FALSE(fs::exists(bench / "n.map.lines"));  // nothing was computed
    };
    refused("rolling\"", "sliding\", \"friction\": -0.3", "", "indenter.friction: found -0.3");
    refused("rolling\"", "sliding\", \"friction\": 0.3", "--method analytic",
            "indenter.friction: found 0.3, expected 0 with --method analytic");
    refused("\"sphere\"", "\"cylinder\", \"length_mm\": 5", "--method analytic",
            "indenter.shape: found cylinder, expected sphere with --method analytic");
    refused("\"sphere\"", "\"cylinder\"", "", "length_mm");
    refused("\"sphere\"", "\"cylinder\", \"length_mm\": 0.01", "", "a quarter of the nodes' spacing");
    refused("[1, 2]", "[1, 12]", "", "depths less than the thickness, 12 mm");
    refused("[0, 2]", "[-2, 2]", "", "expected an indenter on the tissue, 0 to 40 mm");
    refused("[0, 2]", "[-2, 2]", "--method analytic", "expected an indenter on the tissue, 0 to 40 mm");
    refused("0.45, \"assumed\"", "0.5, \"assumed\"", "", "poisson");
    refused("40000", "-1", "", "young_Pa");
    refused("[21, 10]", "[9, 10]", "", "p.json: nodules A: found x 20, y 18 mm, expected a place on the map");
    refused(
        "}],",
        "}, {\"id\": \"B\", \"centre_mm\": [22, 18, 6], \"diameter_mm\": 6, \"young_Pa\": 2e6, \"poisson\": 0.45}],",
        "", "overlap");
    // out of reach: told before a mesh is made
    refused("[1, 2]", "[1e-6]", "", "depths_mm: found 1e-06, which needs");
    refused("[2, 4], \"count\": [21, 10]", "[0.004, 0.003], \"count\": [10000, 10000]", "",
            "grid.count: found 2e+08 forces");
    const auto out_of_reach = [&](const std::string& from, const std::string& to, const char* words) {
        write_text_atomically(bench / "p.json", replaced(kPhantom, from, to));
        const Called called = bench.shell("timeout 60 " PALPA_PROGRAM " maps generate " + (bench / "p.json").string() +
                                          " -o " + (bench / "n.map").string());
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, words));
        CHECK(contains(called.err, "expected at least 0."));
        CHECK_FALSE(fs::exists(bench / "n.map.lines"));
    };
    out_of_reach("\"diameter_mm\": 6", "\"diameter_mm\": 0.01",
                 "p.json: nodules[0].diameter_mm: found 0.01, which needs a mesh of");
    out_of_reach("\"radius_mm\": 3", "\"radius_mm\": 0.001", "indenter.radius_mm: found 0.001, which needs");
    refused("40000", "40000", "--part 3/2", "i/n with 1 <= i <= n");
    refused("40000", "40000", "--part 1/2 --check", "--check: found with a part");
    const Called array_task =
        bench.shell("SLURM_ARRAY_TASK_ID=1 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=2 timeout 60" +
                    bench.call("n.map", "--check"));
    CHECK(array_task.status == 2);
    CHECK(contains(array_task.err, "--check: found with a part (of --part, SLURM_ARRAY_TASK_ID"));
    CHECK(message_of([] { parse_part("2"); }) != "");
    CHECK(parse_part("2/8").count == 8);
}

TEST_CASE("generate: a check is refused for a map of another phantom, which it would say something untrue about") {
    const Bench bench;
    const auto refused = [&](const char* words) {
        const Called called = bench.generate("a.map", "--check");
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, words));
        CHECK_FALSE(fs::exists(bench / "a.map.check"));
        CHECK_FALSE(contains(read_map(bench / "a.map").source.how, "Checked"));
    };
    REQUIRE(bench.generate("a.map", "--method analytic").status == 0);
    refused("not by finite elements, expected a map made from ");
    for (const auto& [from, to, words] : {std::array{"[20, 18, 6]", "[24, 18, 6]", "found other nodules"},
                                          std::array{"\"radius_mm\": 3", "\"radius_mm\": 4", "found another indenter"},
                                          std::array{"[2, 4]", "[2, 3.5]", "found another grid"}}) {
        write_text_atomically(bench / "p.json", replaced(kPhantom, from, to));
        refused(words);
    }
}

TEST_CASE("generate: the 50 points of the check lie on the grid, over the nodules and at the edges") {
    const Phantom phantom = read_phantom(PALPA_SOURCE_DIR "/assets/phantoms/silicone.json");
    const std::vector<Cell> cells = probe_cells(phantom, 50);
    CHECK(cells.size() == 50);
    int at_edge = 0;
    for (const Cell& cell : cells) {
        CHECK(cell.i < phantom.n_x);
        CHECK(cell.j < phantom.n_y);
        at_edge += cell.i == 0 || cell.i + 1 == phantom.n_x || cell.j == 0 || cell.j + 1 == phantom.n_y;
    }
    CHECK(at_edge >= 2);
    Phantom small = phantom;  // 4 x 3 places
    small.n_x = 4;
    small.n_y = 3;
    std::set<std::pair<std::size_t, std::size_t>> places;
    const std::vector<Cell> few = probe_cells(small, 50);
    for (const Cell& cell : few) places.insert({cell.i, cell.j});
    CHECK(few.size() <= 12);
    CHECK(places.size() == few.size());
}
