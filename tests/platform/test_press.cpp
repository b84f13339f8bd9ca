#include <doctest/doctest.h>

#include "platform/press.h"

using palpa::platform::Phase;
using palpa::platform::Presses;
using palpa::platform::PressOwner;
using palpa::platform::Sample;

namespace {

Sample at(Phase phase, std::int64_t pointer_id = 1) {
    Sample sample;
    sample.phase = phase;
    sample.pointer_id = pointer_id;
    sample.t_device_s = 1.0;
    sample.x_px = 50.0;
    return sample;
}

std::vector<Phase> phases(const std::vector<Sample>& samples) {
    std::vector<Phase> out;
    for (const Sample& sample : samples) out.push_back(sample.phase);
    return out;
}

std::vector<Phase> admitted(const std::vector<Phase>& all, PressOwner owner) {
    Presses presses;
    std::vector<Sample> out;
    for (const Phase phase : all) palpa::platform::admit(at(phase), owner, presses, out);
    CHECK(presses.held.empty());
    return phases(out);
}

}  // namespace

TEST_CASE("press: on tissue everything passes") {
    const std::vector<Phase> all{Phase::hover, Phase::down, Phase::move, Phase::up, Phase::hover};
    CHECK(admitted(all, PressOwner::tissue) == all);
}

TEST_CASE("press: on a panel only hovering passes") {
    const std::vector<Phase> all{Phase::hover, Phase::down, Phase::move, Phase::up, Phase::hover};
    CHECK(admitted(all, PressOwner::panel) == std::vector<Phase>{Phase::hover, Phase::hover});
}

TEST_CASE("press: pressure is watched wherever the press is, on a panel and after a cancel too") {
    for (const PressOwner owner : {PressOwner::tissue, PressOwner::panel, PressOwner::nobody}) {
        for (const double rise : {0.0, 0.001}) {
            Presses presses;
            std::vector<Sample> out;
            Sample sample = at(Phase::down);
            for (int i = 0; i < 100; ++i) {
                sample.t_host_s = 0.01 * i;
                sample.pressure = 0.5 + rise * i;
                palpa::platform::admit(sample, owner, presses, out);
                sample.phase = Phase::move;
            }
            const auto kind = palpa::platform::pressure_kind(presses.pressure, sample.tool);
            CHECK(kind ==
                  (rise > 0.0 ? palpa::platform::PressureKind::varies : palpa::platform::PressureKind::constant));
        }
    }
    Presses lifted;  // the time between two presses is no touch
    std::vector<Sample> out;
    Sample sample = at(Phase::down);
    for (int press = 0; press < 2; ++press) {
        for (int i = 0; i < 20; ++i) {
            sample.t_host_s = 100.0 * press + 0.001 * i;
            sample.phase = i == 0 ? Phase::down : Phase::move;
            sample.pressure = 0.5;
            palpa::platform::admit(sample, PressOwner::panel, lifted, out);
        }
        palpa::platform::cancel_all(sample.t_host_s, lifted, out);
    }
    CHECK(palpa::platform::pressure_kind(lifted.pressure, sample.tool) == palpa::platform::PressureKind::unknown);
}

TEST_CASE("press: moves and ups without a down are dropped") {
    CHECK(admitted({Phase::move, Phase::up}, PressOwner::tissue).empty());
}

TEST_CASE("press: two fingers, one on a panel") {
    Presses presses;
    std::vector<Sample> out;
    palpa::platform::admit(at(Phase::down, 1), PressOwner::panel, presses, out);
    palpa::platform::admit(at(Phase::down, 2), PressOwner::tissue, presses, out);
    CHECK_FALSE(palpa::platform::presses_tissue(presses, 1));
    CHECK(palpa::platform::presses_tissue(presses, 2));
    palpa::platform::admit(at(Phase::move, 1), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::move, 2), PressOwner::panel, presses, out);  // the down has decided
    palpa::platform::admit(at(Phase::up, 1), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::up, 2), PressOwner::tissue, presses, out);
    CHECK(phases(out) == std::vector<Phase>{Phase::down, Phase::move, Phase::up});
    for (const Sample& sample : out) CHECK(sample.pointer_id == 2);
}

TEST_CASE("press: cancelled, it stays dead until the next down") {
    Presses presses;
    std::vector<Sample> out;
    palpa::platform::admit(at(Phase::down), PressOwner::tissue, presses, out);
    palpa::platform::cancel_all(9.0, presses, out);
    palpa::platform::cancel_all(9.5, presses, out);
    palpa::platform::admit(at(Phase::move), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::up), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::down), PressOwner::tissue, presses, out);
    CHECK(phases(out) == std::vector<Phase>{Phase::down, Phase::cancel, Phase::down});
    CHECK(out[1].t_host_s == 9.0);
    CHECK(out[1].x_px == 50.0);
}

TEST_CASE("press: a lost up ends in a cancel") {
    Presses presses;
    std::vector<Sample> out;
    palpa::platform::admit(at(Phase::down), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::down), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::hover), PressOwner::tissue, presses, out);
    CHECK(phases(out) == std::vector<Phase>{Phase::down, Phase::cancel, Phase::down, Phase::cancel, Phase::hover});
}

TEST_CASE("press: a device that is gone cancels its own press only") {
    Presses presses;
    std::vector<Sample> out;
    palpa::platform::admit(at(Phase::down, 1), PressOwner::tissue, presses, out);
    palpa::platform::admit(at(Phase::down, 2), PressOwner::tissue, presses, out);
    palpa::platform::cancel_gone(3.0, 2, presses, out);
    palpa::platform::cancel_gone(3.0, 77, presses, out);
    REQUIRE(out.size() == 3);
    CHECK(out[2].phase == Phase::cancel);
    CHECK(out[2].pointer_id == 2);
    CHECK(palpa::platform::presses_tissue(presses, 1));
}
