#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "files/npy.h"
#include "stiffnessmaps/import/matrices.h"
#include "stiffnessmaps/map_file.h"
#include "tests/close_to.h"
#include "tests/stiffnessmaps/array_writers.h"
#include "tests/stiffnessmaps/import_helpers.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

std::string matrix(double newtons, std::size_t n_x = 4, std::size_t n_y = 3) {
    std::string text;
    for (std::size_t j = 0; j < n_y; ++j) {
        for (std::size_t i = 0; i < n_x; ++i)
            text += (i > 0 ? "," : "") +
                    number_text(newtons + 0.01 * static_cast<double>(i) + 0.1 * static_cast<double>(j));
        text += "\n";
    }
    return text;
}

ImportOptions spaced() {
    ImportOptions options;
    options.spacing_m = {0.76e-3, 2e-3};
    options.origin_m = {1e-3, 2e-3};
    return options;
}

}  // namespace

TEST_CASE("matrices: one file per depth, normal and tangential, depths from the names in any order") {
    const TemporaryFolder folder;
    std::vector<std::filesystem::path> files;
    for (const char* depth : {"10", "2", "3.5"}) {
        for (const char* kind : {"normal", "tangential"}) {
            files.push_back(folder / (std::string(kind) + "_" + depth + "mm.csv"));
            write_text_whole(files.back(), matrix((kind[0] == 't' ? 0.1 : 0.3) * std::stod(depth)));
        }
    }
    ImportReport report;
    const Map map = import_recording(files, spaced(), report);
    CHECK(report.form == RecordingForm::matrices);
    CHECK(map.n_x == 4);
    CHECK(map.n_y == 3);
    REQUIRE(map.n_depths() == 3);
    CHECK(map.depths_m[0] == close_to(2e-3));
    CHECK(map.depths_m[2] == close_to(10e-3));
    CHECK(map.normal_N[0] == close_to(0.6f));
    CHECK(map.normal_N[2 * 12 + 4 + 1] == close_to(3.11f));
    CHECK(map.tangential == TangentialKind::recorded);
    CHECK(map.tangential_x_N[2 * 12] == close_to(1.0f));
    CHECK(map.tangential_y_N.empty());
    CHECK(map.x_of(1) == close_to(1.76e-3));
    CHECK(report.residual.worst_N < 1e-6);
    // what is written is a map like any other
    write_map(map, folder / "x.map");
    const Map back = read_map(folder / "x.map");
    CHECK(map_json(back) == map_json(map));
    CHECK(back.filled_normal_N == map.filled_normal_N);
}

TEST_CASE("matrices: what is not stated is asked for") {
    const TemporaryFolder folder;
    const auto said = [&](const std::vector<std::string>& names, const ImportOptions& options) {
        std::vector<std::filesystem::path> files;
        for (const std::string& name : names) files.push_back(folder / name);
        ImportReport report;
        return message_of([&] { import_recording(files, options, report); });
    };
    write_text_whole(folder / "a.csv", matrix(1.0));
    write_text_whole(folder / "b_3mm.csv", matrix(2.0));
    write_text_whole(folder / "c_4mm.csv", matrix(2.0, 5));
    write_text_whole(folder / "mN_4mm.csv", matrix(2000.0));
    write_text_whole(folder / "empty_4mm.csv", "nan,nan\nnan,nan\n");
    write_png(folder / "d_2mm.png", 4, 3, std::vector<std::uint16_t>(12, 900));
    CHECK(contains(said({"b_3mm.csv"}, {}), "--spacing-mm DX,DY"));
    CHECK(contains(said({"a.csv"}, spaced()),
                   "found 1 matrices in 1 files, with a depth in 0 of their names, expected the depth of "
                   "each: --depths-mm"));
    CHECK(
        contains(said({"b_3mm.csv", "c_4mm.csv"}, spaced()), "c_4mm.csv: shape: found (3, 5), expected (3, 4) as in"));
    CHECK(contains(said({"b_3mm.csv", "b_3mm.csv"}, spaced()), "the depth 3 mm twice"));
    for (const char* name : {"e_2,5mm.csv", "e_2p5mm.csv"}) {  // no 5 mm
        write_text_whole(folder / name, matrix(2.0));
        CHECK(contains(said({name}, spaced()), "names such as normal_3mm.csv and normal_2.5mm.csv"));
    }
    CHECK(contains(said({"mN_4mm.csv"}, spaced()), "--force-unit mN"));
    CHECK(contains(said({"empty_4mm.csv"}, spaced()), "no number: all cells are empty"));
    CHECK(contains(said({"d_2mm.png"}, spaced()),
                   "an image of counts without a unit, expected what one count is: --scale"));
    ImportOptions options = spaced();
    options.force_unit = ForceUnit::mN;
    CHECK(said({"mN_4mm.csv"}, options) == "");
    options.depths_m = {1e-3, 2e-3};
    CHECK(contains(said({"mN_4mm.csv"}, options), "found 1 matrices, expected 2, one for each depth of --depths-mm"));
}

TEST_CASE("matrices: a three-dimensional array in any order of its axes") {
    const TemporaryFolder folder;
    std::vector<double> values;  // [y][x][depth], as MATLAB people keep them
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 4; ++x) {
            for (int d = 0; d < 2; ++d) values.push_back(1.0 + d + 0.1 * y + 0.01 * x);
        }
    }
    write_mat(folder / "a.mat", "F", {3, 4, 2}, values);
    ImportOptions options = spaced();
    options.axes = "yxd";
    options.depths_m = {2e-3, 5e-3};
    ImportReport report;
    const Map map = import_recording({folder / "a.mat"}, options, report);
    CHECK(map.n_x == 4);
    CHECK(map.n_y == 3);
    CHECK(map.normal_N[12 + 4 + 3] == close_to(2.13f));
    options.axes = "dyx";
    CHECK(contains(message_of([&] { import_recording({folder / "a.mat"}, options, report); }),
                   "found 3 matrices, expected 2, one for each depth of --depths-mm (another order of axes: --axes)"));
}

TEST_CASE("matrices: slices of stiffness and elasticity become forces by a stated formula") {
    const TemporaryFolder folder;
    std::vector<std::uint16_t> counts(12, 2000);
    counts[5] = 0;
    write_png(folder / "e.png", 4, 3, counts);
    ImportOptions options = spaced();
    options.quantity = Quantity::young;
    options.scale = 0.005e3;  // 5 Pa a count: 10 kPa
    options.scale_stated = true;
    options.missing = 0.0;
    CHECK(contains(message_of([&] {
                       ImportReport r;
                       import_recording({folder / "e.png"}, options, r);
                   }),
                   "--depths-mm"));
    options.depths_m = {1e-3, 4e-3};
    options.indenter_radius_m = 4e-3;
    ImportReport report;
    const Map map = import_recording({folder / "e.png"}, options, report);
    // Hertz: 4/3 * 10 kPa / 0.75 * sqrt(4 mm) * (1 mm)^1.5
    const double wanted_N = 4.0 / 3.0 * 1e4 / 0.75 * std::sqrt(4e-3) * std::pow(1e-3, 1.5);
    CHECK(map.normal_N[0] == close_to(wanted_N));
    CHECK(map.normal_N[12] == close_to(8.0 * wanted_N));
    CHECK(std::isnan(map.normal_N[5]));
    CHECK(map.filled_normal_N[5] == close_to(wanted_N));
    REQUIRE(report.notes.size() == 1);
    CHECK(contains(report.notes[0], "Hertz"));
    REQUIRE(choice_of(map, "contact_formula") != nullptr);
    options.indenter = IndenterShape::cylinder;
    CHECK(elastic_force_N(1e4, 1e-3, options) == close_to(3.14159265 / 4.0 * 1e4 / 0.75 * 20e-3 * 1e-3));
    // stiffness: a straight line
    write_text_whole(folder / "k.csv", "0.5,1\n2,n/a\n");
    options.quantity = Quantity::stiffness;
    options.scale = 1e3;
    options.scale_stated = false;
    const Map k = import_recording({folder / "k.csv"}, options, report);
    CHECK(k.normal_N[4] == close_to(2.0f));
    options.scale = 1e6;  // N/mm taken for kN/mm
    CHECK(contains(message_of([&] { import_recording({folder / "k.csv"}, options, report); }),
                   "expected from 0.001 to 1000 N/mm"));
}

TEST_CASE("matrices: sizes that soft tissue does not have are refused after scale and formula too, unless confirmed") {
    const TemporaryFolder folder;
    write_text_whole(folder / "a_2mm.csv", matrix(20.0));
    const auto said = [&](const ImportOptions& options) {
        ImportReport report;
        return message_of([&] { import_recording({folder / "a_2mm.csv"}, options, report); });
    };
    ImportOptions scaled = spaced();
    scaled.scale_stated = true;
    scaled.scale = 1e3;
    CHECK(contains(said(scaled), "N, expected from 0.01 to 200 N on soft tissue: another --scale, or --force-unit N"));
    scaled.scale = 1e-8;
    CHECK(contains(said(scaled), "expected from 0.01 to 200 N"));
    scaled.force_unit = ForceUnit::N;
    CHECK(said(scaled) == "");

    ImportOptions young = spaced();
    young.quantity = Quantity::young;
    young.scale = 1e7;
    young.scale_stated = true;
    young.depths_m = {1e-3, 2e-3};
    CHECK(contains(said(young), "a greatest force of"));
    young.scale = 1e3;
    CHECK(said(young) == "");
    young.force_unit = ForceUnit::mN;
    CHECK(contains(said(young), "found mN for stiffnesses or Young's moduli"));

    ImportOptions small = spaced();
    small.spacing_m = {0.05e-3, 0.05e-3};
    CHECK(contains(said(small), "places that extend over 0.15 mm, expected from 1 to 1000 mm"));
    small.length_unit = LengthUnit::mm;
    CHECK(said(small) == "");
    small.length_unit = LengthUnit::m;
    CHECK(contains(said(small), "--length-unit: found another unit than mm for arrays"));

    ImportOptions deep = spaced();
    for (const double depth_m : {1e-6, 0.4}) {
        deep.depths_m = {depth_m};
        deep.depth_unit.reset();
        CHECK(contains(said(deep), "expected from 0.05 to 100 mm: state the unit of the depths by --depth-unit"));
        deep.depth_unit = LengthUnit::mm;
        CHECK(said(deep) == "");
    }
}

TEST_CASE("matrices: a slice at many depths holds no more numbers than files may") {
    const TemporaryFolder folder;
    write_npy(folder / "k.npy", {1000, 1000}, std::vector<float>(1'000'000, 2.0f));
    ImportOptions options = spaced();
    options.quantity = Quantity::stiffness;
    options.scale = 1e3;
    for (int k = 1; k <= 21; ++k) options.depths_m.push_back(1e-3 * k);
    ImportReport report;
    CHECK(contains(message_of([&] { import_recording({folder / "k.npy"}, options, report); }),
                   "more than 20 million numbers"));
}
