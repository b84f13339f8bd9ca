#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <limits>

#include "scene/part_tissue.h"
#include "scene/plan.h"
#include "scene/tissue.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/scene/allocations.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::test;
namespace fs = std::filesystem;

namespace {

// A slender beam in a folder of its own, with a copy that is soft all along.
struct Designs {
    TemporaryFolder folder;
    Scene scene;
    Designs() {
        Json json = small_part();
        json["size_mm"] = {20, 2, 2};
        write("a.json", json);
        json["shape"][1]["permute"] = {{"all", true}};
        write("b.json", json);
        scene.file = folder / "scene.json";
        options({"a.json", "b.json"}).method = parts::Method::timoshenko;
    }
    void write(const char* name, const Json& json) { std::ofstream(folder / name) << json.dump(); }
    PartOptions& options(const std::vector<std::string>& names) {
        PartOptions out;
        for (const std::string& name : names) out.designs.push_back(folder / name);
        out.load = "tip";
        out.method = parts::Method::timoshenko;
        scene.tissue = out;
        return std::get<PartOptions>(scene.tissue);
    }
    PartTissue made() const { return prepare(std::get<PartOptions>(scene.tissue), scene, {}); }
};

// A pen on a design, at a place in the part's own frame.
Press press_on(const PartTissue& tissue, std::size_t design, double u_m, double v_m, double force_N) {
    Press out;
    out.p_m = tissue.designs[design].origin_m + Eigen::Vector2d(u_m, v_m);
    out.force_N = force_N;
    out.down = true;
    return out;
}

Contact pressed(const PartTissue& tissue, const Press& press, PartWork& work) {
    Contact contact;
    contact.normal_N = press.force_N;
    answer(tissue, StageId::depth, press, work, contact);
    return contact;
}

}  // namespace

TEST_CASE("part tissue: the displacement is the force times the compliance of the design under the pen") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    for (std::size_t i = 0; i < 2; ++i) {
        PartWork work = make_work(tissue);
        const parts::Response& response = tissue.designs[i].responses[tissue.first_method];
        const double u_m = 0.019;
        const Contact contact = pressed(tissue, press_on(tissue, i, u_m, 1e-3, 3.0), work);
        CHECK(work.design == i);
        CHECK(contact.measured);
        CHECK(contact.depth_m == close_to(3.0 * compliance_at(response, place_of(response, u_m))).epsilon(1e-9));
        CHECK(work.depth_m[1 - i] == 0.0);  // the other design is not pressed
    }
}

TEST_CASE("part tissue: both designs bear the same force, the soft one gives way more") {
    Designs designs;
    std::get<PartOptions>(designs.scene.tissue).both = true;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    pressed(tissue, press_on(tissue, 0, 0.015, 1e-3, 2.0), work);
    CHECK(work.force_N[0] == 2.0);
    CHECK(work.force_N[1] == 2.0);
    CHECK(work.depth_m[1] > 1.5 * work.depth_m[0]);
}

TEST_CASE("part tissue: it is stiffer near the clamp, and a stiffer scene answers like a lighter press") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    const double far_m = pressed(tissue, press_on(tissue, 0, 0.018, 1e-3, 1.0), work).depth_m;
    const double near_m = pressed(tissue, press_on(tissue, 0, 0.006, 1e-3, 1.0), work).depth_m;
    CHECK(near_m < 0.2 * far_m);
    Press stiff = press_on(tissue, 0, 0.018, 1e-3, 1.0);
    stiff.stiffness_scale = 4.0;
    CHECK(pressed(tissue, stiff, work).depth_m == close_to(0.25 * far_m));
}

TEST_CASE("part tissue: a press beyond what its method applies to is doubted, and the paper's spring always") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    const parts::Response& response = tissue.designs[0].responses[tissue.first_method];
    const double u_m = 0.019;
    const parts::StationPlace there = place_of(response, u_m);
    const double most_N = applies_to_m(response, there) / compliance_at(response, there);
    const auto doubt = [&](double force_N) {
        pressed(tissue, press_on(tissue, 0, u_m, 1e-3, force_N), work);
        return doubt_of(tissue, work, 0);
    };
    CHECK_FALSE(doubt(0.9 * most_N));
    REQUIRE(doubt(1.1 * most_N));
    CHECK(doubt(1.1 * most_N)->why_not == response.validity.why_not);
    CHECK(doubt(1.1 * most_N)->to_m == close_to(most_N * compliance_at(response, there)));
    CHECK(response.validity.why_not != "");
    pressed(tissue, {}, work);
    CHECK_FALSE(doubt_of(tissue, work, 0));
    while (tissue.methods[work.method] != parts::Method::paper) REQUIRE(next_method(tissue, work) != nullptr);
    REQUIRE(doubt_of(tissue, work, 0));
    CHECK(doubt_of(tissue, work, 0)->to_m == 0.0);
}

TEST_CASE(
    "part tissue: a method that is chosen between presses has a station of its own: cells have fewer than beams") {
    Designs designs;
    ::setenv("XDG_CACHE_HOME", designs.folder.path().c_str(), 1);
    designs.options({"a.json"}).method = parts::Method::voxels;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    while (tissue.methods[work.method] != parts::Method::timoshenko) REQUIRE(next_method(tissue, work) != nullptr);
    pressed(tissue, press_on(tissue, 0, 0.019, 1e-3, 1.0), work);
    pressed(tissue, {}, work);
    REQUIRE(std::string(next_method(tissue, work)) == "voxels");
    CHECK(work.station[0].low < tissue.designs[0].responses[work.method].station_m.size());
    CHECK_FALSE(doubt_of(tissue, work, 0));
}

TEST_CASE("part tissue: beside the part nothing is pressed; pens that are no numbers end the touch") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    const Contact beside = pressed(tissue, press_on(tissue, 0, 0.024, 1e-3, 2.0), work);
    CHECK(beside.depth_m == 0.0);
    CHECK(beside.normal_N == 0.0);
    CHECK_FALSE(beside.measured);
    Press bad = press_on(tissue, 0, std::numeric_limits<double>::quiet_NaN(), 0.0, 2.0);
    CHECK(pressed(tissue, bad, work).depth_m == 0.0);
    CHECK_FALSE(work.down);
}

TEST_CASE("part tissue: a pull resists with the stiffness along the load, and its rise enters the laws") {
    Designs designs;
    std::get<PartOptions>(designs.scene.tissue).gesture = PartGesture::pull;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    Press press = press_on(tissue, 0, 0.019, 1e-3, 1.0);
    pressed(tissue, press, work);
    press.p_m.y() -= 0.5e-3;
    press.heading = {0.0, -1.0};
    Contact contact = pressed(tissue, press, work);
    answer(tissue, StageId::tangential, press, work, contact);
    const parts::Response& response = tissue.designs[0].responses[tissue.first_method];
    const double k = 1.0 / compliance_at(response, place_of(response, 0.019));
    CHECK(contact.depth_m == close_to(0.5e-3));
    CHECK(contact.tangential_N == close_to(0.5e-3 * k).epsilon(1e-9));
    const Station station{press.p_m, press.heading, 1.0, 0.2e-3, 1.0};
    CHECK(rise_N(tissue, station, work) == close_to(0.2e-3 * k).epsilon(1e-9));
    const Station sideways{press.p_m, {1.0, 0.0}, 1.0, 0.2e-3, 1.0};
    CHECK(rise_N(tissue, sideways, work) == 0.0);
    // before the pull's beginning there is nothing that resists
    const RiseOnPart rise{100.0, {0.0, 0.0}, {0.0, -1.0}};
    CHECK(rise({0.0, -1e-3}, {0.0, -1.0}, 4e-3) == close_to(0.1));
}

TEST_CASE("part tissue: the method changes between presses only, in turn") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    REQUIRE(tissue.methods.size() == 3);
    PartWork work = make_work(tissue);
    const double before_m = pressed(tissue, press_on(tissue, 0, 0.018, 1e-3, 1.0), work).depth_m;
    CHECK(next_method(tissue, work) == nullptr);
    Contact contact;
    answer(tissue, StageId::depth, Press{}, work, contact);
    CHECK(std::string(next_method(tissue, work)) == "paper");
    CHECK(pressed(tissue, press_on(tissue, 0, 0.018, 1e-3, 1.0), work).depth_m != close_to(before_m).epsilon(0.05));
    CHECK_FALSE(switch_events(tissue, work));
}

TEST_CASE(
    "part tissue: what is said of the depth's error is of the method that answers, and the greatest of both designs") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    for (std::size_t i = 0; i < tissue.methods.size(); ++i) {
        const Stage stage = depth_stage(tissue, i);
        CHECK(contains(stage.fidelity, parts::name_of(tissue.methods[i])));
        CHECK(contains(stage.error, "the model's own error"));
    }
    PartTissue other = tissue;
    REQUIRE(other.designs.size() == 2);
    other.designs[1].responses[0].interpolation_error = 0.123;
    CHECK(contains(depth_stage(other, 0).error, "12.3 %"));
}

TEST_CASE("part tissue: a finger that is led by depth is pushed by the stiffness at its place") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    const Press press = press_on(tissue, 0, 0.018, 1e-3, 1.0);
    const double depth_m = pressed(tissue, press, work).depth_m;
    const Push push = push_to(tissue, press.p_m, depth_m, work);
    CHECK(push.force_N == close_to(1.0).epsilon(1e-9));
    CHECK(push.slope_N_per_m == close_to(1.0 / depth_m).epsilon(1e-9));
}

TEST_CASE("part tissue: cells that are iterated a piece at a time answer as those that are computed at once") {
    Designs designs;
    ::setenv("XDG_CACHE_HOME", designs.folder.path().c_str(), 1);
    PartOptions& options = designs.options({"a.json", "b.json"});
    options.method = parts::Method::voxels;
    const parts::Part part = parts::read_part(options.designs[1]);
    const parts::Response whole =
        parts::response_of(part, part.loads[0], {parts::Method::voxels, {}, 1e-3, options.view});
    PartCells cells(options);
    double before = cells.share();
    int pieces = 0;
    for (; cells.advance(); ++pieces) {
        CHECK(cells.share() >= before);
        before = cells.share();
    }
    CHECK(before == 1.0);
    CHECK(pieces > 30);
    const PartTissue tissue = designs.made();
    const parts::Response& pieced = tissue.designs[1].responses.back();
    CHECK(pieced.compliance_m_per_N == whole.compliance_m_per_N);
    CHECK(pieced.field == whole.field);
    PartCells again(options);  // all of it is in the cache
    CHECK(again.advance());
    CHECK(again.advance());
    CHECK_FALSE(again.advance());
}

TEST_CASE("part tissue: a touch allocates nothing") {
    const Designs designs;
    const PartTissue tissue = designs.made();
    PartWork work = make_work(tissue);
    pressed(tissue, press_on(tissue, 0, 0.018, 1e-3, 1.0), work);
    const auto before = allocations();
    for (int i = 0; i < 50; ++i) pressed(tissue, press_on(tissue, 0, 0.001 * (i % 19), 1e-3, 0.1 * i), work);
    CHECK(allocations() == before);
}

TEST_CASE("part tissue: wrong scenes are refused by name") {
    Designs designs;
    const auto refused = [&] { return message_of([&] { designs.made(); }); };
    std::get<PartOptions>(designs.scene.tissue).load = "head";
    CHECK(contains(refused(), "one of tip, patch"));
    designs.options({"a.json"});
    designs.scene.surface = SurfaceEffect{};
    CHECK(contains(refused(), "parts are drawn as they are"));
    designs.scene.surface.reset();
    std::get<PartOptions>(designs.scene.tissue).view = {0, 1};
    std::get<PartOptions>(designs.scene.tissue).gesture = PartGesture::pull;
    CHECK(contains(refused(), "for a pull"));
}
