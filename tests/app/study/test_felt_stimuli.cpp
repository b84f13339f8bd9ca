// What simulated participants feel of surfaces on simulated devices.

#include <cmath>
#include <doctest/doctest.h>

#include "app/study/felt_stimuli.h"
#include "tests/tactile/tactile_scene.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::app;
using namespace palpa::test;

namespace {

constexpr const char* kFelt =
    R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}, "leads": "arm"})";
constexpr const char* kLocked =
    R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json", "schedule": "locked"}, "leads": "arm"})";

// Pins and arm, the arm alone, a screen: the same slab.
struct Displays {
    TactileScene felt{kFelt};
    TactileScene locked{kLocked};
    StudyScenes scenes;

    Displays() {
        scenes.push_back(StudyScene{felt.scene, felt.plan});
        scenes.push_back(StudyScene{locked.scene, locked.plan});
        scenes.push_back(StudyScene{felt.scene, felt.plan});
        scenes.back()->scene.tactile.reset();
        scenes.emplace_back();  // by hand
    }
};

Protocol protocol_of(std::optional<std::size_t> reference_on) {
    Protocol protocol;
    protocol.task = TaskKind::choice;
    protocol.conditions.resize(4);
    protocol.choice.reference_on = reference_on;
    return protocol;
}

}  // namespace

TEST_CASE("felt stimuli: hand and fingertip feel how stiff the displayed surface is, friction and delays included") {
    const Displays displays;
    constexpr std::uint64_t kSeed = 4;
    CAPTURE(kSeed);
    FeltStimuli felt(displays.scenes, {}, kSeed);
    const FeltStiffness soft = felt.of(0, 1.0);
    for (const double ratio : {0.5, 1.5, 2.0}) {
        CAPTURE(ratio);
        const FeltStiffness other = felt.of(0, ratio);
        // a compensated arm renders within 15 % (docs/tactile.md); both presses may be off
        CHECK(std::abs(other.by(Sense::hand) - soft.by(Sense::hand) - std::log(ratio)) < 0.2);
        const double by_shape = other.by(Sense::fingertip) - soft.by(Sense::fingertip);
        CHECK(by_shape / std::log(ratio) > 0.6);  // servos are late, and the more so the softer the tissue
        CHECK(by_shape / std::log(ratio) < 1.2);
        CHECK_FALSE(std::isfinite(other.by(Sense::eye)));
    }
}

TEST_CASE("felt stimuli: locked pins tell nothing, and a screen tells the eye alone") {
    const Displays displays;
    FeltStimuli felt(displays.scenes, {}, 4);
    CHECK(std::isfinite(felt.of(1, 1.0).by(Sense::hand)));
    CHECK_FALSE(std::isfinite(felt.of(1, 1.0).by(Sense::fingertip)));
    const FeltStiffness seen = felt.of(2, 1.0);
    CHECK_FALSE(std::isfinite(seen.by(Sense::hand)));
    CHECK_FALSE(std::isfinite(seen.by(Sense::fingertip)));
    REQUIRE(std::isfinite(seen.by(Sense::eye)));
    CHECK(felt.of(2, 2.0).by(Sense::eye) > seen.by(Sense::eye));
}

TEST_CASE("felt stimuli: the same seed brings the same devices, another one others") {
    const Displays displays;
    FeltStimuli a(displays.scenes, {}, 4), b(displays.scenes, {}, 4), c(displays.scenes, {}, 5);
    CHECK(a.of(0, 1.0).by(Sense::hand) == b.of(0, 1.0).by(Sense::hand));
    CHECK(a.of(0, 1.0).by(Sense::hand) != c.of(0, 1.0).by(Sense::hand));
}

TEST_CASE("felt stimuli: pairs on driven devices and pairs across displays are felt, others are not") {
    const Displays displays;
    const Protocol own = protocol_of(std::nullopt);
    CHECK(feels_displays(own, displays.scenes, 0));
    CHECK(feels_displays(own, displays.scenes, 1));
    CHECK_FALSE(feels_displays(own, displays.scenes, 2));
    CHECK_FALSE(feels_displays(own, displays.scenes, 3));
    const Protocol across = protocol_of(0);
    CHECK(feels_displays(across, displays.scenes, 2));
    CHECK_FALSE(feels_displays(across, displays.scenes, 3));
}
