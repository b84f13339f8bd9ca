#include <doctest/doctest.h>

#include "app/screens/settings.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::app;
using namespace palpa::test;

TEST_CASE("settings: what is saved is read back") {
    const TemporaryFolder folder;
    const auto file = folder / "palpa/settings.json";
    Settings s;
    s.scene = "/somewhere/scene.json";
    s.left_handed = true;
    s.side_view = false;
    s.test_mode = true;
    s.keep_results = false;
    s.guided_done = true;
    s.text_percent = 120;
    s.width_px = 1920;
    s.px_per_mm["eDP-1, 2560 x 1600"] = 11.8125;
    REQUIRE(save_settings(s, {}, file).empty());
    std::string problem;
    const Settings again = load_settings(file, problem);
    CHECK(problem.empty());
    CHECK(again.scene == s.scene);
    CHECK(again.left_handed);
    CHECK_FALSE(again.side_view);
    CHECK(again.test_mode);
    CHECK_FALSE(again.full_screen);
    CHECK_FALSE(again.keep_results);
    CHECK(again.guided_done);
    CHECK(again.text_percent == 120);
    CHECK(again.width_px == 1920);
    CHECK(again.px_per_mm == s.px_per_mm);
}

TEST_CASE("settings: none are the defaults; broken ones are named, and kept aside when others are saved") {
    const TemporaryFolder folder;
    const auto file = folder / "settings.json";
    std::string problem;
    CHECK(load_settings(file, problem).width_px == 1280);
    CHECK(problem.empty());
    write_text_atomically(file, "{\"width_px\": \"wide\"}");
    CHECK(load_settings(file, problem).width_px == 1280);
    CHECK(contains(problem, "settings.json: width_px: found 'wide'"));
    CHECK(save_settings({}, {}, file).empty());
    CHECK(read_text(folder / "settings.json.broken-1") == "{\"width_px\": \"wide\"}");
    CHECK(load_settings(file, problem).width_px == 1280);
    CHECK(problem.empty());
}

TEST_CASE("settings: of two windows each saves what it changed, and undoes nothing of the other") {
    const TemporaryFolder folder;
    const auto file = folder / "settings.json";
    Settings first, second;
    first.keep_results = false;
    first.text_percent = 120;
    first.px_per_mm["left screen"] = 5.0;
    REQUIRE(save_settings(first, {}, file).empty());
    second.profile = "/mine/pen.json";
    second.px_per_mm["right screen"] = 4.0;
    REQUIRE(save_settings(second, {}, file).empty());
    std::string problem;
    Settings both = load_settings(file, problem);
    CHECK_FALSE(both.keep_results);
    CHECK(both.text_percent == 120);
    CHECK(both.profile == "/mine/pen.json");
    CHECK(both.px_per_mm.size() == 2);
    Settings back = first;
    back.text_percent = 100;  // a change back is a change
    REQUIRE(save_settings(back, first, file).empty());
    both = load_settings(file, problem);
    CHECK(both.text_percent == 100);
    CHECK_FALSE(both.keep_results);
    Settings reset = back;  // a screen whose scale is reset is measured no more, the other window's still is
    reset.px_per_mm.clear();
    REQUIRE(save_settings(reset, back, file).empty());
    both = load_settings(file, problem);
    CHECK(both.px_per_mm == std::map<std::string, double>{{"right screen", 4.0}});
}

TEST_CASE("settings: a place that cannot be written is said in words") {
    CHECK(contains(save_settings({}, {}, "/dev/null/palpa/settings.json"), "settings are not kept"));
    CHECK(contains(save_settings({}, {}, {}), "XDG_CONFIG_HOME"));
}
