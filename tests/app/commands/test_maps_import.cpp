// `palpa maps import` as a person calls it: options, choices, JSON, refusals.

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <set>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "files/json.h"
#include "files/npy.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

Called import(const TemporaryFolder& folder, const std::string& arguments) {
    return shell("cd " + folder.path().string() + " && timeout 60 " PALPA_PROGRAM " maps import " + arguments);
}

// 4 x 3 places, 0.5 N/mm, with columns that nobody could guess.
std::string odd_table() {
    std::string text = "where,across,along,how_deep_mm,push_mN\n";
    for (int p = 0; p < 12; ++p) {
        for (int k = 0; k < 5; ++k) {
            text += std::to_string(p) + "," + std::to_string(3 * (p % 4)) + "," + std::to_string(2 * (p / 4)) + "," +
                    std::to_string(k) + "," + std::to_string(500 * k) + "\n";
        }
    }
    return text;
}

// The most memory (bytes) that any process of an import held, as the system counted it. Sanitizers multiply it.
[[maybe_unused]] double memory_of_import(const TemporaryFolder& folder, const std::string& arguments) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(import(folder, arguments).status);
    int status = 0;
    rusage used{};
    ::wait4(child, &status, 0, &used);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
    return 1024.0 * static_cast<double>(used.ru_maxrss);
}

const std::string kColumns =
    "--column point=where --column x=across --column y=along --column depth=how_deep_mm --column fn=push_mN ";

}  // namespace

TEST_CASE(
    "maps import: columns by name; what was chosen is printed, is in the map, and each with the option that "
    "changes it") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "r.csv", odd_table());
    CHECK(contains(import(folder, "r.csv -o x.map").err,
                   "expected probing (x, y, depth or z, fn or fz, ...) or sliding"));
    const Called called = import(folder, "r.csv " + kColumns + "-o x.map --explain");
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    CHECK(contains(called.out, "12 points become 4 x 3 cells of 3.00 x 2.00 mm, 4 depths to 4.00 mm"));
    CHECK(contains(called.out, "map against recording: "));
    CHECK(called.err == "");
    const Map map = read_map(folder / "x.map");
    CHECK(map.normal_N.back() == close_to(2.0f));
    CHECK(map.noise_N.has_value());
    const std::string help = import(folder, "--help").out;
    CHECK(map.source.choices.size() > 8);
    for (const SourceChoice& choice : map.source.choices) {
        CAPTURE(choice.key);
        CHECK(contains(called.out, choice.key));
        CHECK((!choice.how.empty() || !choice.option.empty()));
        // every option that it names exists
        for (std::size_t at = choice.option.find("--"); at != std::string::npos;
             at = choice.option.find("--", at + 2)) {
            const std::string option = choice.option.substr(at, choice.option.find_first_of(" ,", at) - at);
            CHECK(contains(help, option));
        }
    }
    // without an output nothing is written
    CHECK(import(folder, "r.csv " + kColumns + "--explain").status == 0);
    CHECK(contains(import(folder, "r.csv " + kColumns).err, "expected -o NAME.map"));
    CHECK(contains(import(folder, "r.csv " + kColumns + "-o x.map").err, "nothing is overwritten"));
}

TEST_CASE("maps import: the JSON has the map, the residual and its shares") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "r.csv", odd_table());
    const Called called =
        import(folder, "r.csv " + kColumns + "--depths-mm 1,2.5 --name block --licence CC0 -o x.map --json");
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    const Json json = parse_json(called.out, "stdout");
    CHECK(json["shape"] == Json({2, 3, 4}));
    CHECK(json["depths_mm"] == Json({1.0, 2.5}));
    CHECK(json["name"] == "block");
    CHECK(json["source"]["licence"] == "CC0");
    CHECK(json["import"]["form"] == "probing");
    CHECK(json["import"]["residual_points"] == 24);
    CHECK(json["import"]["median_residual_share"].get<double>() < 1e-6);
    CHECK(json["import"]["greatest_force_N"].get<double>() == close_to(1.25));
    std::set<std::string> keys;
    for (const Json& choice : json["source"]["choices"]) keys.insert(choice["key"].get<std::string>());
    for (const char* key : {"form", "columns", "grid", "pitch_mm", "depths_mm", "contact", "outliers_deviations",
                            "tangential", "filled", "noise_N"}) {
        CAPTURE(key);
        CHECK(keys.count(key) == 1);
    }
}

TEST_CASE("maps import: matrices, one file per depth") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "normal_2mm.csv", "0.2,0.3\n0.4,\n");
    write_text_atomically(folder / "normal_4mm.csv", "0.5,0.6\n0.9,1.2\n");
    const Called called = import(
        folder, "normal_4mm.csv normal_2mm.csv --spacing-mm 0.76,2 --origin-mm 5,6 -o m.map --tangential energy");
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    const Map map = read_map(folder / "m.map");
    CHECK(map.depths_m.size() == 2);
    CHECK(std::isnan(map.normal_N[3]));
    CHECK(map.filled_normal_N[3] == close_to(0.6f));
    CHECK(map.tangential == TangentialKind::energy);
    CHECK(map.spacing_m[1] == close_to(2e-3));
    CHECK(std::filesystem::exists(folder / "m.map/filled_normal_N.npy"));
    CHECK(import(folder, "normal_4mm.csv normal_2mm.csv --spacing-mm 1 --no-fill -o n.map").status == 0);
    CHECK_FALSE(std::filesystem::exists(folder / "n.map/filled_normal_N.npy"));
}

TEST_CASE("maps import: the number that stands for not measured is found as a float has it, or missed with a warning") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "a_2mm.csv", "0.2,-999.9\n0.4,0.5\n");
    const Called called = import(folder, "a_2mm.csv --spacing-mm 1 --missing -999.9 -o m.map");
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    CHECK_FALSE(contains(called.err, "warning"));
    CHECK(std::isnan(read_map(folder / "m.map").normal_N[1]));
    CHECK(contains(import(folder, "m.map/normal_N.npy --depths-mm 2 --spacing-mm 1 --missing -1 -o n.map").err,
                   "warning: no number is -1"));
}

TEST_CASE("maps import: forces that fall with depth are taken with a warning about the depths' order") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "light.txt", "0.1 0.2\n0.1 0.2\n");
    write_text_atomically(folder / "deep.txt", "0.2 0.4\n0.2 0.4\n");
    const auto told = [&](const std::string& files, const char* name) {
        const Called called = import(folder, files + " --depths-mm 1,2 --spacing-mm 2,2 -o " + name);
        CAPTURE(called.err);
        CHECK(called.status == 0);
        return contains(called.err, "in 4 of 4 cells, and look-up makes such forces constant");
    };
    CHECK_FALSE(told("light.txt deep.txt", "a.map"));
    CHECK(told("deep.txt light.txt", "b.map"));
}

TEST_CASE("maps import: what cannot be ends with status 2, says what, and leaves nothing behind") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "r.csv", odd_table());
    write_text_atomically(folder / "mN.csv",
                          "x,y,depth,fn\n0,0,0,0\n0,0,1,900\n0,0,2,2100\n5,0,0,0\n5,0,1,900\n5,0,2,2100\n");
    const auto refused = [&](const std::string& arguments, const char* word) {
        const Called called = import(folder, arguments);
        CAPTURE(arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, word));
        CHECK_FALSE(std::filesystem::exists(folder / "n.map"));
    };
    refused("mN.csv -o n.map", "--force-unit mN");
    refused("r.csv " + kColumns + "--column where -o n.map", "expected ROLE=NAME");
    refused("r.csv " + kColumns + "--depths-mm 2,1 -o n.map", "expected ascending depths");
    refused("r.csv " + kColumns + "--depths-mm 1,two -o n.map", "--depths-mm: found '1,two'");
    refused("r.csv " + kColumns + "--depths-mm 1,2,99 -o n.map", "r.csv: found no force 99 mm deep");
    refused("r.csv " + kColumns + "--region-mm 1,2 -o n.map", "--region-mm: found 2 numbers, expected 4");
    refused("r.csv " + kColumns + "--region-mm 100,200,100,200 -o n.map", "in the region");
    refused("r.csv " + kColumns + "--grid hexagons -o n.map", "--grid");
    refused("r.csv " + kColumns + "--form sliding -o n.map", "a column for t");
    refused("none.csv -o n.map", "none.csv: cannot be read");
    write_text_atomically(folder / "a_2mm.csv", "0.2,0.3\n0.4,0.5\n");
    refused("r.csv " + kColumns + "--scale 0.02 -o n.map",
            "--scale: found a recording of the form probing, expected arrays");
    refused("r.csv " + kColumns + "--surface-z-mm 2 -o n.map", "expected a table of sliding");
    refused("a_2mm.csv --spacing-mm 1 --layers 5 -o n.map",
            "--layers: found a recording of the form matrices, expected a table");
    const char* nothing_left = "leave nothing for this one to choose";
    refused("r.csv " + kColumns + "--depths-mm 1,2 --layers 2 -o n.map", nothing_left);
    refused("r.csv " + kColumns + "--grid on-grid --pitch-mm 4 -o n.map", nothing_left);
    refused("r.csv " + kColumns + "--contact first-row --contact-force-N 5 -o n.map", nothing_left);
    write_text_atomically(folder / "z.csv", "x,y,z,fn\n0,0,0,0\n0,0,-1,1\n5,0,0,0\n5,0,-1,1\n");
    refused("z.csv --depth-unit m -o n.map", "--depth-unit: found z.csv, which has no column of depths");
    refused("a_2mm.csv --spacing-mm 1 --dataset F -o n.map", "--dataset: found 'F' for a_2mm.csv");
    refused("a_2mm.csv --spacing-mm 1 --axes yxd -o n.map",
            "--axes: found yxd for a_2mm.csv, which has two dimensions");
    refused("r.csv " + kColumns + "-o none/n.map", "no folder to put it into");
    CHECK(import(folder, "mN.csv --force-unit mN -o n.map").status == 0);
    CHECK(read_map(folder / "n.map").normal_N.back() == close_to(2.1f));
}

TEST_CASE("maps import: hostile recordings end with status 2 and a message that names what is wrong") {
    const TemporaryFolder folder;
    // 5 x 5 places, 4 depths; `x_mm` of the first, `fn` of a row
    const auto grid = [](double x_mm, const auto& fn) {
        std::string rows;
        for (int p = 0; p < 25; ++p) {
            for (int k = 0; k < 4; ++k)
                rows += std::to_string(x_mm + 2 * (p % 5)) + "," + std::to_string(2 * (p / 5)) + "," +
                        std::to_string(k) + "," + fn(p, k) + "\n";
        }
        return rows;
    };
    const auto rising = [](int, int k) { return std::to_string(0.5 * k); };
    const std::string head = "x,y,depth,fn\n";
    write_text_atomically(folder / "mN.csv", head + grid(0.0, [](int, int k) { return std::to_string(700 * k); }));
    write_text_atomically(folder / "metres.csv", head + "0,0,0,0\n0,0,0.001,0.9\n0,0,0.002,2\n");
    write_text_atomically(folder / "column.csv", "x,y,depth\n0,0,0\n0,0,1\n");
    write_text_atomically(folder / "two.csv", head + grid(0.0, rising) + grid(300.0, rising));
    write_text_atomically(folder / "nan.csv", head + grid(0.0, [](int, int) { return "nan"; }));
    write_text_atomically(folder / "empty_2mm.csv", "n/a,n/a\nnan,\n");
    std::string promised = npy_header({1'000'000, 1'000, 1'000});
    write_text_atomically(folder / "promised.npy", promised + "abcd");
    std::string back = "t,x,y,z,fx,fy,fz\n";
    for (int i = 0; i < 400; ++i)
        back += std::to_string(i < 200 ? 0.01 * i : 0.01 * i - 1.0) + "," + std::to_string(0.1 * i) + ",0,-1,0,0,0.5\n";
    write_text_atomically(folder / "back.csv", back);
    const auto refused = [&](const std::string& arguments, const char* word) {
        const Called called = import(folder, arguments + " -o n.map");
        CAPTURE(arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, arguments.substr(0, arguments.find(' '))));
        CHECK(contains(called.err, word));
        CHECK_FALSE(std::filesystem::exists(folder / "n.map"));
    };
    refused("mN.csv", "state the column's unit by --force-unit mN");
    refused("metres.csv", "state the unit of the depths by --depth-unit m");
    refused("column.csv", "expected a column for fn");
    refused("two.csv", "two grids in one file?");
    refused("nan.csv", "no row with numbers");
    refused("empty_2mm.csv --spacing-mm 1", "all cells are empty");
    refused("promised.npy --spacing-mm 1 --depths-mm 1", "4000000000000 for the shape (1000000, 1000, 1000)");
    refused("back.csv", "line 202, t: found '1");
    // some rows that are no numbers are only counted
    write_text_atomically(folder / "some.csv",
                          head + grid(0.0, [&](int p, int k) { return p == 7 ? std::string("nan") : rising(p, k); }));
    CHECK(contains(import(folder, "some.csv -o some.map").out, "1 cells missing; 4 of 100 rows and 1 points rejected"));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they multiply it
TEST_CASE("maps import: takes less than four times the file's size in memory") {
    const TemporaryFolder folder;
    const std::size_t n = 1000;
    NpyArray array{{10, n, n}, std::vector<float>(10 * n * n)};
    for (std::size_t i = 0; i < array.values.size(); ++i)
        array.values[i] = 0.1f * static_cast<float>(1 + i / (n * n)) + 1e-5f * static_cast<float>(i % 97);
    write_npy(folder / "a.npy", array.shape, array.values);
    array = {};
    const auto times = [&](const char* file, const std::string& arguments) {
        const double share =
            memory_of_import(folder, arguments) / static_cast<double>(std::filesystem::file_size(folder / file));
        MESSAGE(std::string(file), ": ", share, " times its size");
        return share;
    };
    CHECK(times("a.npy", "a.npy --depths-mm 1,2,3,4,5,6,7,8,9,10 --spacing-mm 1 -o a.map") < 4.0);
    std::string rows = "x_mm,y_mm,depth_mm,fn_N,fx_N,fy_N\n";
    for (int place = 0; place < 250 * 250; ++place) {
        const std::string at = std::to_string(place % 250) + "," + std::to_string(place / 250) + ",";
        for (int k = 0; k < 20; ++k)
            rows += at + std::to_string(0.2 * k) + "," + std::to_string(0.1 * k + 1e-4 * (place % 7)) +
                    ",0.012345,0.023456\n";
    }
    write_text_atomically(folder / "p.csv", rows);
    rows = {};
    CHECK(times("p.csv", "p.csv -o p.map") < 4.0);
}
#endif
