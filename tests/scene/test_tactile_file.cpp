#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/tissue.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

Scene tactile_scene(const std::string& tactile,
                    const std::string& tissue = R"({"linear": {"phantom": "live-block.json"}})") {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "s.json",
                                 R"({"name": "n", "tissue": )" + tissue + R"(, "tactile": )" + tactile + "}");
    return read_scene(folder / "s.json", kAssets);
}

std::string refused(const std::string& tactile) {
    return message_of([&] { tactile_scene(tactile); });
}

}  // namespace

TEST_CASE("tactile file: what is absent is not asked for, defaults are the documented ones") {
    const TactileOptions options = *tactile_scene(R"({"display": {}})").tactile;
    CHECK_FALSE(options.arm);
    CHECK_FALSE(options.table);
    CHECK(options.finger.contact == FingerContact::parabola);
    CHECK(options.finger.diameter_m == 16e-3);
    CHECK(options.finger.pad.empty());
    CHECK(options.display->kind == DisplayKind::shape);
    CHECK(options.display->device.empty());
    CHECK(options.display->schedule == PinSchedule::lead);
    CHECK(options.force_limit_N == 2.5);
    CHECK(options.leads == Leads::touch);
    CHECK_FALSE(read_scene(kAssets / "scenes" / "linear.json", kAssets).tactile);
}

TEST_CASE("tactile file: every key is read") {
    const TactileOptions options = *tactile_scene(R"({
        "finger": {"contact": "pad", "diameter_mm": 14, "pad": "soft.json"},
        "arm": {"impedance": "high", "device": "arm.json"},
        "display": {"kind": "shape", "device": "pins.json", "zero": "top", "over_stroke": "scale", "sheet": "backed",
                    "schedule": "locked", "dither": true},
        "table": {"spacing_mm": 2, "error": 0.001}, "force_limit_N": 15, "leads": "arm"})")
                                        .tactile;
    CHECK(options.finger.contact == FingerContact::pad);
    CHECK(options.finger.diameter_m == close_to(14e-3));
    CHECK(options.finger.pad == kAssets / "fingers" / "soft.json");
    CHECK(options.arm->impedance == ArmImpedance::high);
    CHECK(options.arm->device == kAssets / "devices" / "arm.json");
    CHECK(options.display->device == kAssets / "devices" / "pins.json");
    CHECK(options.display->zero == PinZero::top);
    CHECK(options.display->over_stroke == OverStroke::scale);
    CHECK(options.display->sheet == SheetBacking::backed);
    CHECK(options.display->schedule == PinSchedule::locked);
    CHECK(options.display->dither);
    CHECK(options.table->spacing_m == close_to(2e-3));
    CHECK(options.table->error == 0.001);
    CHECK(options.force_limit_N == 15.0);
    CHECK(options.leads == Leads::arm);
}

TEST_CASE("tactile file: all four pairings of arm and display are accepted where they can show the tissue") {
    CHECK(refused(R"({"arm": {}, "display": {}})") == "");
    CHECK(refused(R"({"arm": {"impedance": "high", "device": "a.json"}, "display": {}})") == "");
    CHECK(refused(R"({"finger": {"contact": "rigid"}, "arm": {}, "display": {"kind": "pressure"}})") == "");
    CHECK(refused(R"({"finger": {"contact": "pad"}, "arm": {"impedance": "high", "device": "a.json"},
                      "display": {"kind": "pressure"}})") == "");
}

TEST_CASE("tactile file: a pairing that would show the finger whatever the tissue is refused with its reason") {
    CHECK(
        contains(refused(R"({"finger": {"contact": "rigid"}, "display": {}})"),
                 "tactile.display.kind: found a shape display under a rigid finger, expected contact parabola or pad: "
                 "the shape would be the finger's own"));
    CHECK(contains(refused(R"({"display": {"kind": "pressure"}})"),
                   "found a pressure display under a parabola of pressure, expected contact rigid or pad: the pressure "
                   "would be the finger's own"));
}

TEST_CASE("tactile file: a map is refused, for it knows no surface") {
    const std::string said = message_of([] { tactile_scene(R"({"arm": {}})", R"({"map": "silicone.map"})"); });
    CHECK(contains(said,
                   "tactile: found a tissue that knows no surface, expected linear, force_curve or block: maps and "
                   "parts know no surface under a finger"));
}

TEST_CASE("tactile file: parts that cannot work together are refused") {
    CHECK(contains(refused("{}"), "tactile: found neither an arm nor a display"));
    CHECK(contains(refused(R"({"display": {}, "leads": "arm"})"), "tactile.leads: found no arm to lead"));
    CHECK(contains(refused(R"({"arm": {}, "leads": "arm"})"), "tactile.leads: found an arm without a device"));
    CHECK(contains(refused(R"({"arm": {"impedance": "high"}})"), "tactile.arm.impedance: found a high-impedance arm"));
    CHECK(contains(refused(R"({"finger": {"contact": "pad"}, "display": {"kind": "pressure", "device": "p.json"}})"),
                   "tactile.display.device: found it beside a pressure display"));
    CHECK(contains(refused(R"({"finger": {"pad": "p.json"}, "arm": {}})"), "tactile.finger.pad: found parameters"));
    CHECK(contains(refused(R"({"arm": {}, "force_limit_N": 0})"), "tactile.force_limit_N: found 0"));
    CHECK(contains(refused(R"({"arm": {}, "pins": {}})"), "pins"));
}
