#include <cmath>
#include <doctest/doctest.h>
#include <map>

#include "accuracy/visibility.h"
#include "scene/advance.h"
#include "scene/tissue.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::accuracy;
using namespace palpa::test;

namespace {

const std::string kAssets = PALPA_SOURCE_DIR "/assets";

// The shipped phantom and the same without its nodules, prepared once.
struct Phantom {
    Scene scene = read_scene(kAssets + "/scenes/display-ratio.json", kAssets);
    Plan with;
    Plan without;
    Phantom() {
        with = make_plan(scene);
        Scene plain = scene;
        leave_out_nodules(plain.tissue);
        without = make_plan(plain);
        scene.display_ratio.reset();
        scene.delay.reset();
    }
};

const Phantom& phantom() {
    static const Phantom shipped;
    return shipped;
}

// Returns the greatest lag over each nodule, and over the strokes beside them under "". Each stroke is repeated with
// samples a quarter of their distance farther, since at 30 Hz they lie 1 mm apart.
std::map<std::string, double> lags_mm(const Scene& scene, const VisibilityOptions& options) {
    const ScreenArea screen{1280, 800};
    const View view = make_view(scene.mapping, phantom().with.area, screen);
    std::map<std::string, double> out;
    for (Stroke stroke : strokes_over(phantom().with)) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            const auto samples = samples_of(stroke, scene, phantom().with, view, options);
            const Difference difference = difference_of(samples, scene, phantom().with, phantom().without, screen);
            out[stroke.nodule] = std::max(out[stroke.nodule], 1e3 * difference.lag_m);
            stroke.through_m -= 0.25 / options.rate_Hz * options.speed_m_per_s * stroke.along;
        }
    }
    return out;
}

}  // namespace

TEST_CASE(
    "visibility: `strong` lags over the shipped phantom's nodules and hardly beside them, at every sampling rate") {
    for (const double rate_Hz : {30.0, 60.0, 100.0, 133.0, 240.0, 1000.0}) {
        CAPTURE(rate_Hz);
        VisibilityOptions options;
        options.rate_Hz = rate_Hz;
        Scene scene = phantom().scene;
        scene.display_ratio = avatar::display_ratio_strong();
        auto lag_mm = lags_mm(scene, options);
        CHECK(lag_mm["A"] >= 2.5);
        CHECK(lag_mm["B"] >= 2.2);
        CHECK(lag_mm["C"] >= 1.6);
        CHECK(lag_mm[""] <= 0.15);
        if (rate_Hz == 240.0)
            MESSAGE("display ratio, A B C beside, mm: ", lag_mm["A"], " ", lag_mm["B"], " ", lag_mm["C"], " ",
                    lag_mm[""]);
        scene.display_ratio.reset();
        scene.delay = avatar::delay_strong();
        lag_mm = lags_mm(scene, options);
        CHECK(lag_mm["A"] >= 1.3);
        CHECK(lag_mm["B"] >= 1.0);
        CHECK(lag_mm["C"] >= 0.7);
        CHECK(lag_mm[""] <= 0.3);
        if (rate_Hz == 240.0)
            MESSAGE("delay, A B C beside, mm: ", lag_mm["A"], " ", lag_mm["B"], " ", lag_mm["C"], " ", lag_mm[""]);
    }
}

TEST_CASE("visibility: strokes go through every nodule, and keep away from all of them beside") {
    int over = 0;
    int beside = 0;
    for (const Stroke& stroke : strokes_over(phantom().with)) {
        CHECK(stroke.along.norm() == close_to(1.0));
        (stroke.nodule.empty() ? beside : over) += 1;
        if (!stroke.nodule.empty()) continue;
        for (const stiffnessmaps::Nodule& nodule : phantom().with.nodules)
            CHECK((stroke.through_m - Eigen::Vector2d(nodule.x_m, nodule.y_m)).norm() > 16e-3);
    }
    CHECK(over == 3);
    CHECK(beside >= 6);
}

TEST_CASE("visibility: a stroke presses with the force that was asked for, at the speed that was asked for") {
    VisibilityOptions options;
    options.force_N = 1.3;
    options.speed_m_per_s = 0.02;
    const Scene& scene = phantom().scene;
    State state = start(scene, phantom().with, {1280, 800});
    const Stroke stroke = strokes_over(phantom().with).front();
    const auto samples = samples_of(stroke, scene, phantom().with, state.view, options);
    for (const platform::Sample& sample : samples) {
        advance(scene, phantom().with, sample, state);
        CHECK(state.contact.normal_N == close_to(1.3));
    }
    CHECK((state.touch.p_m - stroke.through_m - 9e-3 * stroke.along).norm() < 1e-4);
    CHECK(samples.back().t_host_s == close_to(24.0 / 20.0).epsilon(0.01));
}

TEST_CASE("visibility: angles at 40 cm, and what stands in the report") {
    CHECK(arcmin_of(1e-3, 0.4) == close_to(8.594).epsilon(1e-3));
    VisibilityOptions options;
    CHECK(arcmin_of(kIsSeen, options) == close_to(12.89).epsilon(1e-3));
    CHECK(arcmin_of(kMayBeSeen, options) == close_to(1.289).epsilon(1e-3));
    Seen a, b, beside;
    a.stroke.nodule = "A";
    a.motion_arcmin = 13.0;
    b.stroke.nodule = "B";
    b.motion_arcmin = 12.0;
    b.difference.lag_m = 1e-3;
    beside.motion_arcmin = 1.0;
    Seen less = beside;
    less.motion_arcmin = 0.5;
    less.difference.lag_m = 2e-4;
    const Json json = visibility_json({a, b, less, beside}, {"D1"}, options);
    CHECK(json["nodules"].size() == 2);
    CHECK(json["nodules"][0]["id"] == "A");
    CHECK(json["nodules"][0]["visible"] == true);
    CHECK(json["nodules"][1]["visible"] == false);
    CHECK(json["nodules"][1]["lag_mm"] == 1.0);
    CHECK(json["beside_arcmin"] == 1.0);
    CHECK(json["beside_lag_mm"] == close_to(0.2));
    CHECK(json["beside_visible"] == false);
    beside.motion_arcmin = 1.3;
    CHECK(visibility_json({a, beside}, {}, options)["beside_visible"] == true);
    CHECK_FALSE(visibility_json({a}, {}, options).contains("beside_arcmin"));
    const std::string table = visibility_table({a, b, beside}, {"D1"}, options);
    CHECK(table.find("nodule A") != std::string::npos);
    CHECK(table.find("Annett et al. 2014") != std::string::npos);
    CHECK(table.find("nodule D1: not judged") != std::string::npos);
    CHECK(json["nodules_left_out"] == Json{"D1"});
    CHECK(nodules_left_out(phantom().with, {a, beside}) == std::vector<std::string>{"B", "C"});
}
