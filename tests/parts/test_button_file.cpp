#include <doctest/doctest.h>
#include <fstream>

#include "parts/button_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

Json button_part() {
    Json json = small_part();
    json["button"] = Json::parse(R"({"travel_mm": 3, "gravity": "-z",
      "cover": {"radius_mm": 6, "cap_radius_mm": 2.5, "thickness_mm": 1, "material": "soft", "spacings": 8},
      "support": {"latch": {"stiffness_N_per_m": 800, "threshold_N": 100}}, "off_mm": 0.3})");
    return json;
}

std::string refused_button(const Json& json) {
    return message_of([&] { button_curve(parsed(json)); });
}

std::string refused_curve(const std::string& text) {
    return message_of([&] {
        Table table(text, "c.tsv", '\t');
        read_curve(table);
    });
}

}  // namespace

TEST_CASE("button file: every key arrives, in SI units, gravity along the travel") {
    const Part part = parsed(button_part());
    REQUIRE(part.button);
    CHECK(part.button->travel_m == close_to(3e-3));
    CHECK(part.button->cover->young_Pa == 2e9);
    CHECK(part.button->cover->cap_radius_m == close_to(2.5e-3));
    CHECK(part.button->cover->gravity_m_per_s2.z() == close_to(9.80665));
    CHECK(std::get<mechanics::LatchSupport>(part.button->support).threshold_N == 100.0);
    CHECK(*part.button->off_m == close_to(0.3e-3));
    Json aslant = button_part();
    aslant["button"]["gravity"] = "x";
    CHECK(parsed(aslant).button->cover->gravity_m_per_s2.isApprox(Eigen::Vector3d(9.80665, 0, 0)));
    CHECK_FALSE(parsed(small_part()).button);
}

TEST_CASE("button file: a measured curve beside the part is its support") {
    const TemporaryFolder folder;
    std::ofstream(folder / "c.tsv") << "travel_mm\tpress_N\trelease_N\n0\t0\t0\n1\t1.2\t0.9\n2\t0.7\t0.6\n3\t2\t1.9\n";
    Json json = button_part();
    json["button"].erase("cover");
    json["button"].erase("gravity");
    json["button"]["support"] = {{"curve", "c.tsv"}};
    const Part part = parse_part(json, (folder / "p.json").string());
    const mechanics::ButtonCurve curve = button_curve(part);
    CHECK(curve.peak_N == close_to(1.2));
    CHECK(curve.peak_m == close_to(1e-3).epsilon(1e-9));
    CHECK(curve.trough_m == close_to(2e-3).epsilon(1e-9));
    json["button"]["travel_mm"] = 4;
    CHECK(contains(message_of([&] { parse_part(json, (folder / "p.json").string()); }), "a curve to travel_mm = 4"));
}

TEST_CASE("button file: off after on, a cap not smaller than the cover and other wrong keys are named") {
    Json json = button_part();
    json["button"]["support"] = {{"truss", {{"bar_N_per_m", 1000}, {"half_span_mm", 5}, {"rise_mm", 2}}}};
    json["button"]["on_mm"] = 1.0;
    json["button"]["off_mm"] = 1.5;
    CHECK(contains(refused_button(json), "button.off_mm"));
    CHECK(contains(refused_button(json), "off before on"));
    json["button"].erase("off_mm");
    json["button"]["travel_mm"] = 1000;  // a table of 1,025 travels would not see the snap
    CHECK(contains(refused_button(json), "button.travel_mm"));
    json = button_part();
    json["button"]["cover"]["cap_radius_mm"] = 6;
    CHECK(contains(refused_button(json), "button.cover.cap_radius_mm"));
    json = button_part();
    json["button"]["cover"]["material"] = "wood";
    CHECK(contains(refused_button(json), "'wood'"));
    json = button_part();
    json["button"]["support"] = Json::object();
    CHECK(contains(refused_button(json), "0 supports"));
    json = button_part();
    json["button"].erase("cover");
    json["button"].erase("gravity");
    json["button"].erase("support");
    CHECK(contains(refused_button(json), "neither cover nor support"));
    json = button_part();
    json["button"]["support"]["latch"]["threshold_N"] = 1e9;
    CHECK(contains(refused_button(json), "threshold"));
    CHECK(contains(refused_button(small_part()), "no button"));
}

TEST_CASE("button file: curves that are no curves name their line") {
    const std::string header = "travel_mm\tpress_N\trelease_N\n";
    CHECK(contains(refused_curve(header + "0\t0\t0\n0\t1\t1\n"), "3"));
    CHECK(contains(refused_curve(header + "0.5\t0\t0\n1\t1\t1\n"), "0 in the first row"));
    CHECK(contains(refused_curve(header + "0\t0\t0\n1\t1\t1.1\n"), "make energy"));
    CHECK_FALSE(refused_curve(header + "0\t0\t0\n1\tn/a\t1\n").empty());
    CHECK(contains(refused_curve(header), "at least 2"));
    CHECK(contains(refused_curve("travel_mm\tforce_N\n0\t0\n"), "press_N"));
}

TEST_CASE("button file: the cover's table is computed once, kept in the cache, and not taken for another cover") {
    const TemporaryFolder folder;
    const Json json = button_part();
    const mechanics::ButtonCurve plain = button_curve(parsed(json));
    std::string warning;
    const auto cached = [&](const Json& from) { return button_curve(parsed(from), folder / "c", warning); };
    const auto files = [&] {
        const std::filesystem::directory_iterator all(folder / "c");
        return std::distance(begin(all), end(all));
    };
    for (int i = 0; i < 2; ++i) {
        const mechanics::ButtonCurve curve = cached(json);
        CHECK(curve.press_N == plain.press_N);
        CHECK(curve.newton_iterations == plain.newton_iterations);
        CHECK(files() == 1);
    }
    Json harder = json;
    harder["button"]["support"]["latch"]["stiffness_N_per_m"] = 900;  // the cover stays
    CHECK(cached(harder).press_N != plain.press_N);
    CHECK(files() == 1);
    Json thicker = json;
    thicker["button"]["cover"]["thickness_mm"] = 1.1;
    CHECK(cached(thicker).press_N[1].back() == close_to(1.1 * plain.press_N[1].back()).epsilon(1e-3));
    CHECK(files() == 2);
    std::filesystem::resize_file(std::filesystem::directory_iterator(folder / "c")->path(), 40);  // damaged
    CHECK(cached(json).press_N == plain.press_N);
    CHECK(cached(thicker).press_N[0][500] > plain.press_N[0][500]);
    CHECK(warning.empty());
}
