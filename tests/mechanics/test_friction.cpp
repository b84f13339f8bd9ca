#include <cmath>
#include <doctest/doctest.h>

#include "mechanics/error.h"
#include "mechanics/friction.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

const Compliance& friction_slab() {
    static const Compliance made =
        slab_compliance(slab_problem(hex_box(graded_box(0.1, 0.05, 20, 6, 0.0015)), Element::hex8_bbar, {2500.0, 0.45}),
                        {0.035, 0.065, 0.035, 0.065}, true);
    return made;
}

struct Slide {
    FrictionWork work;
    FrictionState state;
    Contact contact;
    void to(double x_m, double y_m, double depth_m, double mu) {
        FrictionOptions options;
        options.coefficient = mu;
        slide_to(friction_slab(), {kBall, {x_m, y_m, depth_m}}, options, work, state, contact);
        CHECK(!contact.flags.not_settled);
        for (std::size_t i = 0; i < state.touch.size(); ++i) {
            const double t = std::hypot(state.force_N[3 * i + 1], state.force_N[3 * i + 2]);
            CHECK(state.force_N[3 * i] > 0.0);
            CHECK(t <= mu * state.force_N[3 * i] * (1.0 + 1e-9));
        }
        CHECK(contact.violation_m <= 1e-6 * depth_m);
    }
};

}  // namespace

TEST_CASE("friction: a coefficient of zero is the frictionless contact") {
    Slide slide;
    Contact smooth;
    ContactWork work;
    for (const double x_m : {0.0487, 0.049, 0.0502}) {
        const Tool tool{kBall, {x_m, 0.0507, 0.003}};
        slide.to(x_m, 0.0507, 0.003, 0.0);
        press_to_depth(friction_slab(), {&tool, 1}, {}, work, smooth);
        CHECK(slide.contact.tool[0].normal_N == close_to(smooth.tool[0].normal_N).epsilon(1e-6));
        CHECK(std::abs(slide.contact.tool[0].tangential_x_N - smooth.tool[0].tangential_x_N) <
              1e-6 * smooth.tool[0].normal_N);
        CHECK(slide.contact.touch == smooth.touch);
    }
}

TEST_CASE("friction: sticks first, then slides at mu N, against the motion in every direction") {
    const double mu = 0.3;
    for (const double turn : {0.0, 1.1, 3.14159265358979, -2.0}) {
        CAPTURE(turn);
        Slide slide;
        const double ux = std::cos(turn);
        const double uy = std::sin(turn);
        slide.to(0.05, 0.05, 0.002, mu);
        slide.to(0.05 + 2e-5 * ux, 0.05 + 2e-5 * uy, 0.002, mu);
        const auto along = [&] {
            return ux * slide.contact.tool[0].tangential_x_N + uy * slide.contact.tool[0].tangential_y_N;
        };
        const auto across = [&] {
            return -uy * slide.contact.tool[0].tangential_x_N + ux * slide.contact.tool[0].tangential_y_N;
        };
        const double stuck = along();
        CHECK(stuck > 0.0);
        CHECK(stuck < 0.3 * mu * slide.contact.tool[0].normal_N);
        double before = stuck;
        for (int i = 1; i <= 12; ++i) {
            slide.to(0.05 + 3e-4 * i * ux, 0.05 + 3e-4 * i * uy, 0.002, mu);
            CHECK(along() > 0.9 * before);  // rises, then stays but for the ripple of the nodes
            before = along();
        }
        // nodes that have just touched still stick: 6 to 8 % less here
        CHECK(along() < mu * slide.contact.tool[0].normal_N);
        CHECK(along() > 0.91 * mu * slide.contact.tool[0].normal_N);
        CHECK(std::abs(across()) < 0.05 * along());
    }
}

TEST_CASE("friction: a replay from a stored state gives the same bits; turning back turns the force") {
    Slide slide;
    for (int i = 0; i < 6; ++i) slide.to(0.048 + 3e-4 * i, 0.05, 0.002, 0.4);
    const FrictionState stored = slide.state;
    slide.to(0.0501, 0.0502, 0.0022, 0.4);
    const double first = slide.contact.tool[0].tangential_x_N;
    Slide again;
    again.state = stored;
    again.to(0.0501, 0.0502, 0.0022, 0.4);
    CHECK(again.contact.tool[0].tangential_x_N == first);
    CHECK(first > 0.0);
    for (int i = 1; i <= 10; ++i) slide.to(0.0501 - 3e-4 * i, 0.0502, 0.0022, 0.4);
    CHECK(slide.contact.tool[0].tangential_x_N < -0.3 * slide.contact.tool[0].normal_N);
    slide.to(0.047, 0.05, 0.0, 0.4);  // lifted: forgets
    CHECK(slide.contact.tool[0].normal_N == 0.0);
    CHECK(!slide.state.touching);
}

TEST_CASE("friction: bad poses hold, a compliance without tangential part is refused") {
    Slide slide;
    slide.to(0.05, 0.05, 0.002, 0.3);
    const double force = slide.contact.tool[0].normal_N;
    slide_to(friction_slab(), {kBall, {std::nan(""), 0.05, 0.002}}, {}, slide.work, slide.state, slide.contact);
    CHECK(slide.contact.flags.held);
    CHECK(slide.contact.tool[0].normal_N == force);
    Compliance normal_only = friction_slab();
    normal_only.full_m_per_N.resize(0, 0);
    CHECK_THROWS_AS(slide_to(normal_only, {kBall, {0.05, 0.05, 0.002}}, {}, slide.work, slide.state, slide.contact),
                    LoadError);
}
