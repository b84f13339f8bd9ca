#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/tissue.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::avatar;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

Scene read(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "s.json", text);
    return read_scene(folder / "s.json", kAssets);
}

std::string with(const std::string& more) { return R"({"name": "n", "tissue": {"map": "silicone.map"})" + more + "}"; }
std::string said(const std::string& text) {
    return message_of([&] { read(text); });
}

}  // namespace

TEST_CASE("scene file: every shipped scene reads") {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kAssets / "scenes")) {
        CAPTURE(entry.path().string());
        CHECK_NOTHROW(read_scene(entry.path(), kAssets));
        ++count;
    }
    CHECK(count >= 4);
}

TEST_CASE("scene file: what is absent is not asked for, defaults are the documented ones") {
    const Scene scene = read(with(""));
    CHECK_FALSE(scene.display_ratio);
    CHECK_FALSE(scene.delay);
    CHECK_FALSE(scene.surface);
    CHECK(scene.force_scale == 1.0);
    CHECK(scene.mapping.kind == MappingKind::direct);
    CHECK(scene.profile.filename() == "s-pen.json");
    CHECK(map_folder(scene.tissue) == kAssets / "maps" / "silicone.map");  // a bare name is found among the assets
}

TEST_CASE("scene file: presets and what overrides them") {
    const Scene paper = read(with(R"(, "avatar": {"display_ratio": {"preset": "paper"}})"));
    CHECK(paper.display_ratio->f_0_N == 1.0);
    CHECK_FALSE(paper.display_ratio->cap_m);
    const Scene own = read(
        with(R"(, "avatar": {"display_ratio": {"preset": "clear", "f_0_N": 0.05, "cap_mm": null, "s_ref_mm": 0.5}})"));
    CHECK(own.display_ratio->f_0_N == 0.05);
    CHECK_FALSE(own.display_ratio->cap_m);
    CHECK(own.display_ratio->path.reference_m == close_to(5e-4));
    const Scene delay = read(with(
        R"(, "avatar": {"delay": {"preset": "clear", "m_ms_per_N": 1000, "force": "recorded", "smoothing_mm": 1.5}})"));
    CHECK(delay.delay->m_s_per_N == 1.0);
    CHECK(delay.delay->cap_s == close_to(0.15));
    CHECK(delay.tangential.force == TangentialForce::recorded);
    CHECK(*delay.tangential.smoothing_m == close_to(1.5e-3));
}

TEST_CASE("scene file: the look of the surface and the cues that are drawn with it") {
    const Scene plain = read(with(R"(, "surface": {"profile": {}})"));
    CHECK(plain.surface->material == SurfaceMaterial::skin);
    CHECK_FALSE(plain.surface->indenter);
    CHECK(plain.cues.footprint + plain.cues.crease + plain.cues.depth_gain == 0.0);
    const Scene all = read(with(R"(, "surface": {"profile": {}, "material": "silicone", "indenter": "fingertip"},
                 "cues": {"footprint": 0.7, "crease": 0.6, "depth_gain": 0.5, "side_view": true})"));
    CHECK(all.surface->material == SurfaceMaterial::silicone);
    CHECK(all.surface->indenter == DrawnIndenter::fingertip);
    CHECK(all.cues.footprint == 0.7);
    CHECK(all.cues.crease == 0.6);
    CHECK(all.cues.depth_gain == 0.5);
    CHECK(all.cues.side_view);
}

TEST_CASE("scene file: strength stands for f_0 and m on one scale, and 0 removes the law with all that it asks for") {
    const auto ratio = [](const std::string& keys) {
        return read(with(R"(, "avatar": {"display_ratio": {)" + keys + "}}"));
    };
    const auto delay = [](const std::string& keys) { return read(with(R"(, "avatar": {"delay": {)" + keys + "}}")); };
    CHECK(ratio(R"("preset": "strong")").display_ratio->f_0_N == 0.005);
    CHECK(ratio(R"("preset": "strong")").display_ratio->cap_m == 8e-3);
    CHECK(ratio(R"("preset": "clear", "strength": 2)").display_ratio->f_0_N == 0.01);
    CHECK(ratio(R"("preset": "clear", "strength": 2)").display_ratio->cap_m == 3e-3);
    CHECK(ratio(R"("preset": "paper", "strength": 2)").display_ratio->f_0_N == 0.01);
    CHECK(delay(R"("preset": "strong")").delay->m_s_per_N == 12.0);
    CHECK(delay(R"("preset": "strong")").delay->cap_s == close_to(0.4));
    CHECK(delay(R"("preset": "clear", "strength": 0.5)").delay->m_s_per_N == 1.5);
    for (const Scene& scene : {ratio(R"("preset": "strong", "strength": 0, "smoothing_mm": 3, "s_ref_mm": 1)"),
                               delay(R"("preset": "strong", "strength": 0, "smoothing_mm": 3, "s_ref_mm": 1)")}) {
        CHECK_FALSE(scene.display_ratio);
        CHECK_FALSE(scene.delay);
        CHECK_FALSE(scene.tangential.smoothing_m);
        CHECK(path_of(scene).reference_m == PathParameters{}.reference_m);
    }
}

TEST_CASE("scene file: the texture is dragged only beside a law, and not by a strength of 0") {
    const auto drag = [](const std::string& law, const std::string& keys) {
        return read(with(R"(, "avatar": {"display_ratio": {"preset": "clear")" + law + R"(}, "texture_drag": {)" +
                         keys + "}}"))
            .texture_drag;
    };
    CHECK(drag("", "")->strength == 1.0);
    CHECK(drag("", R"("strength": 0.25)")->strength == 0.25);
    CHECK_FALSE(drag("", R"("strength": 0)"));
    CHECK_FALSE(drag(R"(, "strength": 0)", ""));
}

TEST_CASE("scene file: wrong keys and values are refused by key") {
    CHECK(contains(said("{}"), "name: found nothing"));
    CHECK(contains(said(with(R"(, "avatr": {})")), "avatr: found an unknown key, expected one of"));
    CHECK(contains(said(with(R"(, "avatar": {})")), "found no law, expected display_ratio or delay"));
    CHECK(contains(said(with(R"(, "avatar": {"delay": {"preset": "clear"}, "display_ratio": {"preset": "clear"}})")),
                   "found both laws"));
    CHECK(contains(said(with(R"(, "avatar": {"delay": {"preset": "slow"}})")),
                   "avatar.delay.preset: found 'slow', expected one of clear paper strong"));
    CHECK(contains(said(with(R"(, "avatar": {"delay": {"preset": "clear", "strength": -1}})")),
                   "avatar.delay.strength: found -1, expected a number from 0 to 100"));
    CHECK(contains(said(with(R"(, "avatar": {"delay": {"preset": "clear", "strength": 2, "m_ms_per_N": 3}})")),
                   "avatar.delay.strength: found a strength beside m_ms_per_N, expected one of the two"));
    CHECK(contains(said(with(R"(, "avatar": {"display_ratio": {"preset": "clear", "strength": 2, "f_0_N": 3}})")),
                   "avatar.display_ratio.strength: found a strength beside f_0_N, expected one of the two"));
    CHECK(contains(said(with(R"(, "avatar": {"delay": {"preset": "clear"}, "texture_drag": {"strength": 1.5}})")),
                   "avatar.texture_drag.strength: found 1.5, expected a number from 0 to 1"));
    CHECK(contains(said(with(R"(, "avatar": {"texture_drag": {}})")), "found no law"));
    CHECK(contains(said(with(R"(, "avatar": {"delay": {"preset": "clear", "rise": 1.5}})")),
                   "avatar.delay.rise: found 1.5"));
    CHECK(contains(said(with(R"(, "avatar": {"display_ratio": {"preset": "clear", "f_0_N": 0}})")), "f_0_N: found 0"));
    CHECK(contains(said(with(R"(, "mapping": {"kind": "direct", "rotate_deg": 45})")),
                   "mapping.rotate_deg: found 45, expected 0, 90, 180 or 270"));
    CHECK(
        contains(said(with(R"(, "mapping": {"kind": "direct", "tissue_mm": [0, 1]})")), "mapping.tissue_mm: found 0"));
    CHECK(contains(said(with(R"(, "force_scale": -1)")), "force_scale: found -1"));
    CHECK(contains(said(with(R"(, "cues": {"crease": 1})")), "cues: found no surface to draw them on"));
    const std::string surface = R"(, "surface": {"profile": {}})";
    CHECK(contains(said(with(surface + R"(, "cues": {"crease": 1.5})")), "cues.crease: found 1.5"));
    CHECK(contains(said(with(surface + R"(, "cues": {"size": 1})")), "cues.size: found an unknown key"));
    CHECK(contains(said(with(R"(, "surface": {"profile": {}, "material": "wood"})")),
                   "surface.material: found 'wood', expected one of skin silicone"));
    CHECK(contains(said(with(R"(, "seed": 0.5)")), "seed: found 0.5, expected a whole number"));
}

TEST_CASE("scene file: parts, every key, and wrong ones by name") {
    const auto part = [](const std::string& keys) {
        return R"({"name": "n", "tissue": {"part": {"designs": ["button.json"])" + keys + "}}}";
    };
    Scene scene = read(part(
        R"(, "load": "cap", "method": "timoshenko", "cell_mm": 2, "gesture": "pull", "view": ["y", "x"], "both": true)"));
    const PartOptions* options = part_options(scene.tissue);
    REQUIRE(options != nullptr);
    CHECK(options->designs.front() == kAssets / "parts" / "button.json");
    CHECK(options->load == "cap");
    CHECK(options->method == palpa::parts::Method::timoshenko);
    CHECK(*options->cell_m == close_to(2e-3));
    CHECK(options->gesture == PartGesture::pull);
    CHECK(options->view == std::array{1, 0});
    CHECK(options->both);
    CHECK(map_folder(scene.tissue).empty());
    CHECK(contains(said(part(R"(, "view": ["x", "x"])")), "tissue.part.view"));
    CHECK(contains(said(part(R"(, "view": "xz")")), "tissue.part.view"));
    CHECK(contains(said(part(R"(, "method": "elastica")")), "tissue.part.method"));
    CHECK(contains(said(part(R"(, "gesture": "shake")")), "tissue.part.gesture"));
    CHECK(contains(said(R"({"name": "n", "tissue": {"part": {"designs": []}}})"), "an array of names of part files"));
    CHECK(contains(said(R"({"name": "n", "tissue": {"part": {"designs": ["button.json\u0000x"]}}})"), "zero byte"));
    CHECK(contains(said(R"({"name": "n", "tissue": {"part": {"designs": ["a.json", "b.json", "c.json"]}}})"),
                   "one or two"));
    CHECK(contains(said(R"({"name": "n", "tissue": {"map": "silicone.map", "part": {"designs": ["a.json"]}}})"),
                   "one of map, linear, part"));
}
