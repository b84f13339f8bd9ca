#include <cmath>
#include <doctest/doctest.h>

#include "stiffnessmaps/field.h"
#include "stiffnessmaps/import/sliding.h"
#include "tests/close_to.h"
#include "tests/stiffnessmaps/import_helpers.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

constexpr double kStiffness_N_per_mm = 0.6;
constexpr double kFriction = 0.2;

struct Raster {
    double tilt = 0.0;  // of the surface about y, radians
    double height_mm = -40.0;
    bool sinusoidal = true;  // depth 0.1 ... 2.9 mm at 1 Hz, else constant
    double depth_mm = 2.0;
    double friction = kFriction;
    double lump = 0.0;       // extra stiffness in the middle, share
    double deeper_mm = 0.0;  // of every second pass
    double exponent = 1.0;   // of force over depth
};

// 40 x 30 mm, lines along x 2 mm apart there and back, two passes out of phase, 100 Hz, 20 mm/s.
std::string raster(const Raster& r) {
    std::string text = "t_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N\n";
    double t = 0.0;
    for (int pass = 0; pass < 3; ++pass) {
        for (int line = 0; line <= 15; ++line) {
            for (int i = 0; i <= 200; ++i, t += 0.01) {
                const int direction = line % 2 == 0 ? 1 : -1;
                const double x = direction > 0 ? 0.2 * i : 40.0 - 0.2 * i;
                const double y = 2.0 * line;
                const double depth = r.sinusoidal ? 1.5 - 1.4 * std::cos(2.0 * 3.14159265 * 1.03 * t + pass * 2.0)
                                                  : r.depth_mm + pass % 2 * r.deeper_mm;
                const double lump =
                    1.0 + r.lump * std::exp(-((x - 20.0) * (x - 20.0) + (y - 15.0) * (y - 15.0)) / 50.0);
                const double fn = kStiffness_N_per_mm * lump * std::pow(depth, r.exponent);
                const double ft = -direction * r.friction * fn;  // on the tool, along the surface
                const double c = std::cos(r.tilt);
                const double s = std::sin(r.tilt);
                const double z = r.height_mm + std::tan(r.tilt) * x - depth / c;
                for (const double v : {t, x, y, z, c * ft - s * fn, 0.0}) text += number_text(v) + ",";
                text += number_text(s * ft + c * fn) + "\n";
            }
        }
    }
    return text;
}

double force_in(const Map& map, double x_mm, double y_mm, double depth_mm) {
    const Field field = make_field(map, {});
    return normal_force_N(field, place_at(field, {1e-3 * x_mm, 1e-3 * y_mm}), 1e-3 * depth_mm);
}

}  // namespace

TEST_CASE("sliding: under a sinusoidal force the surface is found, its tilt removed, and the forces come back") {
    Raster r;
    r.tilt = 0.15;
    r.lump = 0.5;
    ImportReport report;
    const Map map = imported(raster(r), {}, &report);
    CHECK(report.form == RecordingForm::sliding);
    CHECK(std::get<double>(choice_of(map, "surface_tilt_deg")->value) == close_to(8.6).epsilon(0.05));
    for (const double depth : {1.0, 1.5, 2.0, 2.4}) {
        CAPTURE(depth);
        CHECK(force_in(map, 6.0, 6.0, depth) == close_to(kStiffness_N_per_mm * depth).epsilon(0.06));
        CHECK(force_in(map, 20.0, 15.0, depth) == close_to(1.5 * kStiffness_N_per_mm * depth).epsilon(0.08));
    }
    CHECK(report.residual.median_share() < 0.02);
    CHECK(report.residual.n > 5000);
}

TEST_CASE(
    "sliding: the force against motion along +x is stored as positive; lines that go back are left out of "
    "it") {
    Raster r;
    ImportReport report;
    const Map map = imported(raster(r), {}, &report);
    REQUIRE(map.tangential == TangentialKind::recorded);
    REQUIRE(report.tangential.has_value());
    CHECK(report.tangential->n > 1000);
    CHECK(report.tangential->median_share() < 0.02);
    double sum = 0.0;
    double n = 0.0;
    for (std::size_t i = 0; i < map.normal_N.size(); ++i) {
        if (std::isnan(map.tangential_x_N[i]) || std::isnan(map.normal_N[i])) continue;
        sum += static_cast<double>(map.tangential_x_N[i] / map.normal_N[i]);
        n += 1.0;
    }
    CHECK(n > 100.0);
    CHECK(sum / n == close_to(kFriction).epsilon(0.02));
    ImportOptions none;
    none.tangential = TangentialChoice::none;
    CHECK(imported(raster(r), none).tangential_x_N.empty());
}

TEST_CASE("sliding: the surface is found where the force is a power of depth between 1 and 2") {
    for (const double exponent : {1.15, 1.3, 1.5, 1.8}) {
        CAPTURE(exponent);
        Raster r;
        r.exponent = exponent;
        const Map map = imported(raster(r));
        CHECK(std::get<double>(choice_of(map, "surface_exponent")->value) == close_to(1.0 / exponent).epsilon(0.03));
        ImportOptions known;
        known.surface_z_m = 1e-3 * r.height_mm;
        const Map right = imported(raster(r), known);
        for (const double depth_mm : {1.0, 1.5, 2.0, 2.5})
            CHECK(force_in(map, 20.0, 15.0, depth_mm) == close_to(force_in(right, 20.0, 15.0, depth_mm)).epsilon(0.03));
    }
}

TEST_CASE("sliding: a lateral force that pushes the tool along is told, and not taken for friction") {
    Raster r;
    r.friction = -kFriction;
    ImportReport report;
    const Map map = imported(raster(r), {}, &report);
    CHECK(map.tangential == TangentialKind::none);
    REQUIRE(report.notes.size() == 1);
    CHECK(contains(report.notes[0], "does not hold the tool back"));
}

TEST_CASE("sliding: at constant depth the depth must be known, and is then kept to") {
    Raster r;
    r.sinusoidal = false;
    CHECK(contains(refusal(raster(r)), "a force that hardly changes from pass to pass"));
    CHECK(contains(refusal(raster(r)), "--at-depth-mm"));
    const TemporaryFolder folder;
    std::vector<std::filesystem::path> files;
    ImportOptions options;
    for (const double depth : {3.0, 1.0, 2.0}) {
        r.depth_mm = depth;
        files.push_back(folder / ("r" + number_text(depth) + ".csv"));
        write_text_atomically(files.back(), raster(r));
        options.at_depths_m.push_back(1e-3 * depth);
    }
    ImportReport report;
    const Map map = import_recording(files, options, report);
    REQUIRE(map.n_depths() == 3);
    CHECK(map.depths_m[0] == close_to(1e-3));
    CHECK(force_in(map, 20.0, 15.0, 1.0) == close_to(kStiffness_N_per_mm).epsilon(0.001));
    CHECK(force_in(map, 20.0, 15.0, 3.0) == close_to(3.0 * kStiffness_N_per_mm).epsilon(0.001));
    options.at_depths_m.pop_back();
    CHECK(contains(message_of([&] { import_recording(files, options, report); }),
                   "2 depths for 3 files, expected one for each file"));
    // or the surface's height is
    ImportOptions height;
    height.surface_z_m = -40e-3;
    const Map known = imported(raster(r), height);
    REQUIRE(known.n_depths() == 1);
    CHECK(known.depths_m[0] == close_to(2e-3));
}

TEST_CASE("sliding: a tool that never goes shallow has its depths chosen where it was") {
    std::string text = "t_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N\n";
    for (int i = 0; i < 8000; ++i) {
        const double depth = 2.0 + std::sin(2.0 * 3.14159265 * 3.0 * 0.005 * i);
        const double x = 0.1 * (i % 400);
        for (const double v : {0.005 * i, (i / 400) % 2 == 0 ? x : 39.9 - x, 1.0 * (i / 400), 5.0 - depth, 0.0, 0.0})
            text += number_text(v) + ",";
        text += number_text(kStiffness_N_per_mm * depth) + "\n";
    }
    ImportOptions options;
    options.surface_z_m = 5e-3;
    const Map map = imported(text, options);
    REQUIRE(map.n_depths() == 8);
    CHECK(map.depths_m.front() == close_to(1.05e-3).epsilon(0.02));
    CHECK(map.depths_m.back() == close_to(2.95e-3).epsilon(0.02));
    CHECK(contains(choice_of(map, "depths_mm")->how, "hardly reaches the first"));
    for (const double depth : {1.2, 2.0, 2.8})
        CHECK(force_in(map, 20.0, 10.0, depth) == close_to(kStiffness_N_per_mm * depth).epsilon(1e-4));
    options.depths_m = {0.3e-3, 1.2e-3};
    CHECK(contains(message_of([&] { imported(text, options); }),
                   "found no force 0.3 mm deep, expected depths that the recording reaches, from 1 to 3 mm"));
}

TEST_CASE("sliding: two depths fit every power of the force, so that they tell no surface") {
    Raster r;
    r.sinusoidal = false;
    r.depth_mm = 1.0;
    r.deeper_mm = 1.0;
    CHECK(contains(refusal(raster(r)), "a tool that presses at one or two heights"));
    ImportOptions height;
    height.surface_z_m = -40e-3;
    const Map known = imported(raster(r), height);
    CHECK(force_in(known, 20.0, 15.0, 2.0) == close_to(2.0 * kStiffness_N_per_mm).epsilon(0.01));
}

TEST_CASE("sliding: depths that the recording has are taken as they are, and units that cannot be are told") {
    const auto text_of = [](double depths, double forces) {
        std::string text = "t_s,x_mm,y_mm,depth,fn\n";
        for (int i = 0; i < 4000; ++i) {
            const double depth = 1.0 + i / 1000;
            for (const double v : {0.01 * i, 0.2 * (i % 100), 2.0 * ((i / 100) % 10), depths * depth})
                text += number_text(v) + ",";
            text += number_text(forces * 0.7 * depth) + "\n";
        }
        return text;
    };
    ImportOptions options;
    options.form = RecordingForm::sliding;
    const Map map = imported(text_of(1.0, 1.0), options);
    REQUIRE(map.n_depths() == 4);
    CHECK(map.depths_m[3] == close_to(4e-3));
    CHECK(map.tangential == TangentialKind::none);
    CHECK(force_in(map, 10.0, 10.0, 3.0) == close_to(2.1).epsilon(0.001));
    CHECK(contains(refusal(text_of(1e-3, 1.0), options), "--depth-unit m"));
    CHECK(contains(refusal(text_of(1.0, 1e3), options), "--force-unit mN"));
}

TEST_CASE("sliding: bad recordings are refused by line and column") {
    const std::string text = raster({});
    std::string back = text;
    const auto second = back.find("\n0.02,");
    REQUIRE(second != std::string::npos);
    back.replace(second + 1, 4, "-1.0");
    CHECK(contains(refusal(back),
                   "line 4, t_s: found '-1.0', expected a time that is not before the last row's, 0.01 s"));
    CHECK(contains(refusal(text.substr(0, text.find_last_of(','))), "fields, expected 7 as in the header"));
    CHECK(contains(refusal("t_s,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N\n1,2,3,4,5,6,7\n"), "1 rows with numbers"));
    ImportOptions forced;
    forced.form = RecordingForm::sliding;
    CHECK(contains(message_of([&] { imported("x_mm,y_mm,depth_mm,fn_N\n1,2,3,4\n", forced); }), "a column for t ("));
    // a force of the other sign presses nothing
    ImportOptions negated;
    negated.negate_force = true;
    CHECK(contains(message_of([&] { imported(text, negated); }), "--negate-force"));
    std::string nan = text;
    for (int i = 0; i < 3; ++i) nan += "n/a,n/a,n/a,n/a,n/a,n/a,n/a\n";
    ImportReport report;
    imported(nan, {}, &report);
    CHECK(report.rejected_rows == 3);
}

TEST_CASE("sliding: every real recording imports without options and says how far the map is from it") {
    for (const char* name : {"ContPalpTrial1", "ContPalpTrial3"}) {
        const auto file = recording("sliding/" + std::string(name) + ".csv");
        if (file.empty()) {
            MESSAGE("not checked: the recordings are not beside the checkout");
            return;
        }
        CAPTURE(name);
        ImportReport report;
        const Map map = import_recording({file}, {}, report);
        CHECK(report.form == RecordingForm::sliding);
        CHECK(map.tangential == TangentialKind::recorded);
        CHECK(report.residual.n > 10000);
        CHECK(report.residual.median_share() < 0.05);  // the surface is soft and curved, and was never recorded
        CHECK(static_cast<double>(report.outliers) < 0.01 * static_cast<double>(report.rows));
    }
}
