// `palpa fem solve` as a person calls it.

#include <cmath>
#include <doctest/doctest.h>

#include "files/json.h"
#include "files/text.h"
#include "tests/app/palpa_with.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/fem/fem_cases.h"
#include "tests/files/vtu_reader.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::fem;
using namespace palpa::test;

namespace {

// four cells across the contact's radius
const std::string kFine =
    R"({"box": {"size_mm": [100, 100, 50], "elements": [12, 12, 7], "grading": {"centre_mm": [50, 50], "finest_mm": 1}}})";
const std::string kIndented =
    case_text(kFine, "hex8-bbar", kClamped,
              R"([{"indenter": {"shape": "sphere", "radius_mm": 20, "centre_mm": [50, 50], "depth_mm": 0.85}}])");

}  // namespace

TEST_CASE("fem solve: help, a table for people, JSON with every key that design and docs promise") {
    CHECK(contains(palpa_with("fem --help").out, "solve"));
    CHECK(contains(palpa_with("fem solve --help").out, "--output"));
    const TemporaryFolder folder;
    write_text_atomically(folder / "c.json", kIndented);
    const std::string file = (folder / "c.json").string();
    const Called table = palpa_with("fem solve " + file);
    CHECK_MESSAGE(table.status == 0, table.err);
    for (const char* word :
         {"1352 nodes", "reaction zmin", "contact force", "linear range", "backward error", "converged"})
        CHECK(contains(table.out, word));
    CHECK(table.err.empty());

    const Called called = palpa_with("fem solve " + file + " --json");
    CHECK(called.status == 0);
    const Json json = parse_json(called.out, "stdout");
    for (const char* key :
         {"nodes", "elements", "dofs", "max_displacement_mm", "centre_displacement_mm", "d_skel_mm", "reaction_N",
          "contact", "energy_J", "residual", "backward_error", "converged", "time_s", "max_strain", "linear_range"}) {
        CAPTURE(key);
        CHECK(json.contains(key));
    }
    for (const char* key : {"force_N", "area_mm2", "nodes"}) CHECK(json["contact"].contains(key));
    for (const char* key : {"assemble", "factor", "solve"}) CHECK(json["time_s"].contains(key));
    CHECK(json["nodes"] == 1352);
    CHECK(json["elements"] == 1008);
    CHECK(json["dofs"] == 3 * (1352 - 169));
    CHECK(json["converged"] == true);
    CHECK(json["linear_range"]["gauge"] == "green");
    CHECK(json["centre_displacement_mm"].get<double>() == close_to(0.85).epsilon(1e-9));
    CHECK(json["reaction_N"][0]["support"] == "zmin");
    CHECK(json["reaction_N"][0]["force_N"][2].get<double>() ==
          close_to(-json["contact"]["force_N"][2].get<double>()).epsilon(1e-9));
}

TEST_CASE("fem solve: every result names law and element; large strains report how equilibrium was found") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "c.json", case_text(R"({"box": {"size_mm": [20, 20, 20], "elements": [2, 2, 2]}})",
                                                       "hex8", kClamped, R"([{"traction_Pa": 2000, "face": "zmax"}])"));
    const Json linear = parse_json(palpa_with("fem solve " + (folder / "c.json").string() + " --json").out, "stdout");
    CHECK(linear["law"] == "linear");
    CHECK(linear["element"] == "hex8");
    CHECK_FALSE(linear.contains("newton"));
    const std::string block = PALPA_SOURCE_DIR "/assets/cases/block-press.json";
    const Called called = palpa_with("fem solve " + block + " --json");
    CHECK_MESSAGE(called.status == 0, called.err);
    const Json json = parse_json(called.out, "stdout");
    CHECK(json["law"] == "neo-hookean-split");
    CHECK(json["element"] == "hex8-bbar");
    CHECK(json["reaction_N"][2]["force_N"][2].get<double>() == close_to(-27.17305).epsilon(2e-7));
    CHECK(json["newton"]["load_share"] == 1.0);
    CHECK(json["newton"]["stable"] == true);
    CHECK(json["linear_range"].is_null());
    CHECK(contains(palpa_with("fem solve " + block).out, "neo-hookean-split, hex8-bbar"));
}

TEST_CASE("fem solve: the VTU holds the field that the JSON sums up") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "c.json", kIndented);
    const Called called =
        palpa_with("fem solve " + (folder / "c.json").string() + " --json -o " + (folder / "o.vtu").string());
    CHECK_MESSAGE(called.status == 0, called.err);
    const Json json = parse_json(called.out, "stdout");
    const VtuRead vtu = read_vtu_text(read_text(folder / "o.vtu"));
    CHECK(vtu.points == 1352);
    CHECK(vtu.cells == 1008);
    const auto u_mm = vtu.doubles("displacement_mm");
    const auto reaction = vtu.doubles("reaction_N");
    double largest = 0.0;
    double sum_N = 0.0;
    for (std::size_t i = 0; i < vtu.points; ++i) {
        largest = std::max(largest, std::hypot(u_mm[3 * i], u_mm[3 * i + 1], u_mm[3 * i + 2]));
        sum_N += reaction[3 * i + 2];
    }
    CHECK(largest == close_to(json["max_displacement_mm"].get<double>()).epsilon(1e-12));
    CHECK(sum_N == close_to(json["reaction_N"][0]["force_N"][2].get<double>()).epsilon(1e-12));
    CHECK(vtu.doubles("Points")[3 * 1351] == 100.0);  // mm
    CHECK(vtu.components("strain") == 6);
    CHECK(vtu.components("stress_Pa") == 6);
    const auto strain = vtu.doubles("strain");
    const auto stress = vtu.doubles("stress_Pa");
    CHECK(stress[3] == close_to(2.0 * 2500.0 / 2.9 * strain[3]).epsilon(1e-9));  // tensor shear: sigma = 2 mu eps
    double von_mises = 0.0;
    for (const double value : vtu.doubles("von_mises_Pa")) von_mises = std::max(von_mises, value);
    CHECK(von_mises == close_to(json["max_von_mises_Pa"].get<double>()).epsilon(1e-12));
    CHECK(vtu.doubles("material") == std::vector<double>(1008, 0.0));
}

TEST_CASE("fem solve: a bar that bends far is not green, though its strains are small") {
    const TemporaryFolder folder;
    // E 10 kPa, 10 x 10 x 100 mm, clamped below; the elastica says 34.9 mm for 1 mN, where small displacements say 40
    const auto solved = [&](double traction_Pa) {
        write_text_atomically(
            folder / "c.json",
            R"({"mesh": {"box": {"size_mm": [10, 10, 100], "elements": [2, 2, 20]}}, "element": "hex8i",
                "materials": {"gel": {"young_Pa": 10000, "poisson": 0.3}},
                "supports": [{"face": "zmin", "fix": "xyz"}], "loads": [{"face": "zmax", "traction_Pa": [)" +
                number_text(traction_Pa) + ", 0, 0]}]}");
        const Called called = palpa_with("fem solve " + (folder / "c.json").string() + " --json");
        CAPTURE(called.err);
        CHECK(called.status == 0);
        return parse_json(called.out, "stdout");
    };
    CHECK(solved(2.0)["linear_range"]["gauge"] == "green");
    const Json bent = solved(10.0);
    CHECK(bent["linear_range"]["gauge"] == "amber");
    CHECK(bent["max_strain"].get<double>() < 0.1);
    CHECK(bent["max_rotation_deg"].get<double>() == close_to(34.4).epsilon(0.05));  // F L^2 / (2 E I)
    CHECK(solved(20.0)["linear_range"]["gauge"] == "red");
}

TEST_CASE("fem solve: leaving the linear range and a load beside the body are said, and the answer given") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "c.json", case_text(kSlab, "tet4", kClamped, press_at(0, 50, 16, 2.5)));
    const Called called = palpa_with("fem solve " + (folder / "c.json").string() + " --json");
    CHECK(called.status == 0);
    CHECK(contains(called.err, "the linear range is left"));
    CHECK(contains(called.err, "part of the pressure is beside the body: 1.25 N"));
    const Json json = parse_json(called.out, "stdout");
    CHECK(json["linear_range"]["gauge"] == "red");
    CHECK(json["warnings"].size() == 2);
}

TEST_CASE("fem solve: a contact that the mesh cannot resolve is said, whatever colour the gauge has") {
    const TemporaryFolder folder;
    write_text_atomically(
        folder / "c.json",
        case_text(R"({"box": {"size_mm": [56, 56, 24], "elements": [14, 14, 6]}})", "hex8-bbar", kClamped,
                  R"([{"indenter": {"shape": "sphere", "radius_mm": 0.5, "centre_mm": [28, 28], "depth_mm": 0.1}}])"));
    const Called called = palpa_with("fem solve " + (folder / "c.json").string() + " --json");
    CHECK(called.status == 0);
    CHECK(contains(called.err, "the contact's radius spans 0.0559 cells: below 4"));
    const Json json = parse_json(called.out, "stdout");
    REQUIRE(json["warnings"].size() >= 1);
    CHECK(contains(json["warnings"].dump(), "the contact's radius spans"));
    CHECK(json["contact"]["cells_across_radius"].get<double>() == close_to(0.0559).epsilon(0.01));
    CHECK(json["contact"]["area_mm2"].get<double>() < 0.3);  // the node's whole share is 16
}

TEST_CASE("fem solve: a force with friction is met where nodes join at once and the force rises steeply") {
    const TemporaryFolder folder;
    write_text_atomically(
        folder / "c.json",
        case_text(
            R"({"box": {"size_mm": [60, 60, 25], "elements": [6, 6, 4]}})", "hex8-bbar", kClamped,
            R"([{"indenter": {"shape": "sphere", "radius_mm": 20, "centre_mm": [30, 30], "friction": 0.3, "force_N": 0.05}}])"));
    const Called met = palpa_with("fem solve " + (folder / "c.json").string() + " --json");
    CHECK_MESSAGE(met.status == 0, met.err);
    const Json json = parse_json(met.out, "stdout");
    CHECK(json["converged"] == true);
    CHECK(json["contact"]["force_N"][2].get<double>() == close_to(-0.05).epsilon(1e-4));
    CHECK(json["contact"]["depth_mm"].get<double>() > 2.15);
    CHECK(json["contact"]["depth_mm"].get<double>() < 3.0);
}

TEST_CASE("fem solve: without memory it ends with a message and status 1, and does not wait for ever") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE(
        "not tried: AddressSanitizer needs the address space that the test takes away; run it in the preset release");
    return;
#endif
    const TemporaryFolder folder;
    // so small that nothing lacks memory before OpenBLAS does
    write_text_atomically(folder / "small.json", R"({
        "mesh": {"box": {"size_mm": [30, 30, 10], "elements": [6, 6, 2]}},
        "materials": {"gel": {"young_Pa": 2500, "poisson": 0.45}}, "supports": [{"face": "zmin", "fix": "xyz"}],
        "loads": [{"indenter": {"shape": "sphere", "centre_mm": [15, 15], "radius_mm": 20, "depth_mm": 1}}]})");
    const std::string hertz = PALPA_SOURCE_DIR "/assets/cases/hertz.json";
    for (const std::string& file : {hertz, (folder / "small.json").string()}) {
        for (const char* limit_kB : {"200000", "250000", "260000", "350000"}) {
            CAPTURE(file);
            CAPTURE(limit_kB);
            const Called called = palpa_with("fem solve " + file, std::string("ulimit -v ") + limit_kB + ";");
            CAPTURE(called.err);
            CHECK(called.status == 1);
            CHECK(contains(called.err, "not enough memory"));
        }
    }
    // what needs no matrix ends as always
    for (const char* limit_kB : {"200000", "250000"}) {
        const Called called = palpa_with("--version", std::string("ulimit -v ") + limit_kB + ";");
        CAPTURE(limit_kB);
        CHECK(called.status == 0);
    }
}

TEST_CASE("fem solve: bad input ends with status 2, a disk that takes nothing with 1, and no file is left") {
    const TemporaryFolder folder;
    const std::string bad = PALPA_SOURCE_DIR "/tests/fem/bad_cases/";
    const auto refused = [](const std::string& arguments, const char* word) {
        const Called called = palpa_with(arguments);
        CAPTURE(arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(called.out.empty());
        CHECK(contains(called.err, word));
    };
    refused("fem solve " + bad + "floating.json --json -o " + (folder / "o.vtu").string(), "is not held");
    refused("fem solve " + bad + "indenter-off.json", "expected a place on the tissue");
    refused("fem solve " + bad + "incompressible.json", "found 0.5");
    refused("fem solve " + bad + "mesh-file-damaged.json", "announced");
    refused("fem solve none.json", "none.json: cannot be read");
    refused("fem solve " + folder.path().string(), "found a folder");
    write_text_atomically(folder / "c.json", kIndented);
    refused("fem solve " + (folder / "c.json").string() + " -o " + (folder / "no" / "o.vtu").string(),
            "expected a folder that is there");
    CHECK(palpa_with("fem").status == 2);
    CHECK(palpa_with("fem solve").status == 2);
    CHECK(palpa_with("fem solve a.json --nonsense").status == 2);

    const Called full = palpa_with("fem solve " + (folder / "c.json").string() + " -o " + (folder / "o.vtu").string(),
                                   "ulimit -f 64; trap '' XFSZ;");
    CHECK(full.status == 1);
    CHECK(contains(full.err, "o.vtu"));
    CHECK(contains(full.err, "cannot be written"));
    int left = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++left;
    CHECK(left == 1);
}

TEST_CASE("fem solve: warnings of the element stand in the JSON and on stderr") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "c.json",
                          case_text(kSlab, "tet4", kClamped, press_at(50, 50, 16), gel(2500, 0.499)));
    const Called called = palpa_with("fem solve " + (folder / "c.json").string() + " --json");
    CHECK(called.status == 0);
    CHECK(contains(called.err, "c.json: tet4 locks at poisson 0.499"));
    CHECK(contains(parse_json(called.out, "stdout")["warnings"][0].get<std::string>(), "hex8-bbar does not lock"));
}

TEST_CASE("fem solve: a case whose name is not UTF-8 is solved, and the JSON is valid") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "c\xff.json", kIndented);
    const Called called = palpa_with("fem solve '" + (folder / "c\xff.json").string() + "' --json");
    CHECK_MESSAGE(called.status == 0, called.err);
    CHECK(parse_json(called.out, "stdout")["converged"] == true);
}

TEST_CASE(
    "fem solve: a cylinder that is short against the cells along it gets a warning and no larger area than its own") {
    const TemporaryFolder folder;
    const auto pressed = [&](const std::string& length) {
        const std::string file = (folder / "c.json").string();
        write_text_atomically(
            file, case_text(kFine, "hex8-bbar", kClamped,
                            R"([{"indenter": {"shape": "cylinder", "radius_mm": 20, "centre_mm": [50, 50], )" + length +
                                R"("depth_mm": 0.85}}])"));
        const Called called = palpa_with("fem solve " + file + " --json");
        CAPTURE(called.err);
        REQUIRE(called.status == 0);
        return parse_json(called.out, "stdout");
    };
    const Json short_one = pressed(R"("length_mm": 0.1, )");
    CHECK(short_one["contact"]["cells_along_length"].get<double>() < 1.0);
    CHECK(contains(short_one["warnings"].dump(), "the tool's length spans"));
    CHECK(short_one["contact"]["area_mm2"].get<double>() <= 0.1 * 2.0 * std::sqrt(0.85 * (40.0 - 0.85)) + 1e-9);
    const Json long_one = pressed(R"("length_mm": 30, )");
    CHECK(long_one["contact"]["cells_along_length"].get<double>() > 4.0);
    CHECK_FALSE(contains(long_one["warnings"].dump(), "length"));
    CHECK_FALSE(pressed("")["contact"].contains("cells_along_length"));
}
