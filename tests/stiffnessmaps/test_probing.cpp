#include "stiffnessmaps/import/probing.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::test;

namespace {

std::string row(int point, int step, double x, double y, double depth, double force) {
    return std::to_string(point) + "," + std::to_string(step) + "," + number_text(x) + "," + number_text(y) + "," +
           number_text(depth) + "," + number_text(depth + 0.001) + "," + number_text(force) + "\n";
}

// 3 x 2 points at 2 mm, four depths; force 0.1 N at contact, then 0.5 N/mm. One point is missing.
std::string small() {
    std::string text = "point,depth_step,ref_x_mm,ref_y_mm,depth_cmd_mm,depth_mm,fn_N\n";
    for (int p = 0; p < 6; ++p) {
        if (p == 4) continue;
        for (int k = 0; k < 5; ++k) text += row(p, k, -4.0 + 2.0 * (p % 3), 7.0 + 2.0 * (p / 3), k, 0.1 + 0.5 * k);
    }
    return text;
}

std::string said(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "r.csv", text);
    ProbingReport report;
    return message_of([&] { import_probing(folder / "r.csv", 3e-3, report); });
}

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = small();
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("probing: grid from the commanded positions, force at contact subtracted, missing cells stay missing") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "r.csv", small());
    ProbingReport report;
    const Map map = import_probing(folder / "r.csv", 3e-3, report);
    CHECK(map.n_x == 3);
    CHECK(map.n_y == 2);
    CHECK(map.n_depths() == 4);
    CHECK(map.origin_m[0] == doctest::Approx(-4e-3));
    CHECK(map.spacing_m[1] == doctest::Approx(2e-3));
    CHECK(report.missing_cells == 1);
    CHECK(std::isnan(map.normal_N[4]));
    CHECK(map.normal_N[0] == doctest::Approx(0.5f));
    CHECK(map.normal_N[3 * 6] == doctest::Approx(2.0f));
    CHECK(report.median_offset_N == doctest::Approx(0.1));
    CHECK(report.worst_residual_N < 1e-6);
    CHECK(map.source.kind == SourceKind::recorded);
}

TEST_CASE("probing: bad recordings are refused by line and column") {
    CHECK(said(small()) == "");
    CHECK(contains(said(replaced("fn_N", "force")), "expected a column 'fn_N'"));
    CHECK(contains(said(replaced("-4,7,1", "-4,7,one")), "line 3, depth_cmd_mm: found 'one'"));
    CHECK(contains(said(replaced("-4,7,1", "-4,7.7,1")), "expected the position of line 2"));
    CHECK(contains(said(replaced("-2,7,0", "-2.9,7,0")), "expected the position of line 7"));
    CHECK(contains(said("point,ref_x_mm,ref_y_mm,depth_cmd_mm,depth_mm,fn_N\n1,0,0,0,0,0\n"), "no point with two depths"));
    CHECK(contains(said("point;ref_x_mm;fn_N\n1;2;3\n"), "expected a column 'point'"));
    // off the grid, and twice in one cell
    std::string off = small();
    for (int k = 0; k < 5; ++k) off += row(9, k, -4.7, 7.0, k, 1.0 * k);
    CHECK(contains(said(off), "a position on the regular grid"));
    std::string twice = small();
    for (int k = 0; k < 5; ++k) twice += row(9, k, -4.0, 7.0, k, 1.0 * k);
    CHECK(contains(said(twice), "a second point in one cell"));
}

TEST_CASE("probing: a row whose depth is far off its command is rejected and counted") {
    std::string text = "point,ref_x_mm,ref_y_mm,depth_cmd_mm,depth_mm,fn_N\n";
    text += "0,0,0,0,0,0\n0,0,0,1,1,1\n0,0,0,2,45,7\n0,0,0,2,2,2\n";
    const TemporaryFolder folder;
    write_text_atomically(folder / "r.csv", text);
    ProbingReport report;
    const Map map = import_probing(folder / "r.csv", 3e-3, report);
    CHECK(report.rejected_rows == 1);
    CHECK(map.normal_N.back() == doctest::Approx(2.0f));
}

TEST_CASE("probing: the real recording of a phantom with a stiff inclusion becomes 62 x 39 cells of 1.58 mm") {
    const std::filesystem::path file = std::filesystem::path(PALPA_RECORDINGS) / "probing/probingRAL2018B_T2.csv";
    if (!std::filesystem::exists(file)) {
        MESSAGE("not checked: the recording is not beside the checkout: ", file.string());
        return;
    }
    ProbingReport report;
    const Map map = import_probing(file, 3e-3, report);
    CHECK(map.n_x == 62);
    CHECK(map.n_y == 39);
    CHECK(map.spacing_m[0] == doctest::Approx(1.58e-3).epsilon(2e-3));
    CHECK(map.spacing_m[1] == doctest::Approx(1.58e-3).epsilon(2e-3));
    CHECK(report.points == 2344);
    CHECK(report.missing_cells == 62 * 39 - 2344);
    CHECK(report.median_residual_N < 0.02 * force_range(map).highest_N);

    const Field field = make_field(map, {});
    CHECK(field.isotonic_changed > 100);
    std::vector<double> depths_m;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        if (field.measured[cell] == 0.0) continue;
        const Eigen::Vector2d p(map.x_of(cell % map.n_x), map.y_of(cell / map.n_x));
        depths_m.push_back(depth_at(field, place_at(field, p), 1.0).depth_m);
    }
    std::sort(depths_m.begin(), depths_m.end());
    CHECK(depths_m.front() > 0.3e-3);   // over the inclusion 1 N sinks in less ...
    CHECK(depths_m.back() < 4.2e-3);
    CHECK(depths_m[depths_m.size() / 2] > 1.3 * depths_m[depths_m.size() / 50]);  // ... than beside it
}
