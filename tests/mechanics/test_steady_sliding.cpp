#include <cmath>
#include <doctest/doctest.h>

#include "mechanics/error.h"
#include "mechanics/friction.h"
#include "mechanics/steady_sliding.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

// With all three components, so that the step-by-step solver works on it too.
const Compliance& sliding_slab() {
    static const Compliance made = [] {
        const Problem problem =
            slab_problem(hex_box(graded_box(0.1, 0.05, 24, 6, 0.0012)), Element::hex8_bbar, {2500.0, 0.40});
        SurfaceRequest request =
            request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.037, 0.063, 0.037, 0.063});
        request.tangential = true;
        request.sideways = true;
        return surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
    }();
    return made;
}

Contact steady(const Tool& tool, const Eigen::Vector2d& direction, double mu, int max_changes = 40, int sweeps = 300) {
    SteadyWork work;
    Contact contact;
    slide_steadily(sliding_slab(), tool, {direction, mu, max_changes, sweeps}, work, contact);
    return contact;
}

}  // namespace

TEST_CASE("steady sliding: without friction it is the frictionless contact") {
    for (const double depth_m : {0.0005, 0.002, 0.006}) {
        const Tool tool{kBall, {0.0493, 0.0507, depth_m}};
        ContactWork work;
        Contact smooth;
        press_to_depth(sliding_slab(), {&tool, 1}, {}, work, smooth);
        const Contact slid = steady(tool, {1.0, 0.0}, 0.0);
        CHECK(slid.touch == smooth.touch);
        CHECK(slid.tool[0].normal_N == close_to(smooth.tool[0].normal_N).epsilon(1e-9));
        CHECK(std::abs(slid.tool[0].tangential_x_N - smooth.tool[0].tangential_x_N) < 1e-9 * smooth.tool[0].normal_N);
        // towards it without a jump: to first order in mu
        const Contact nearly = steady(tool, {1.0, 0.0}, 1e-6);
        CHECK(nearly.tool[0].normal_N == close_to(smooth.tool[0].normal_N).epsilon(1e-5));
    }
}

TEST_CASE(
    "steady sliding: nothing pulls, nothing penetrates, what presses touches; the drag is that of the full "
    "compliance") {
    for (const double mu : {0.1, 0.5, 1.0}) {
        for (const double turn : {0.0, 0.7, -2.4}) {
            const Eigen::Vector2d e(std::cos(turn), std::sin(turn));
            const Tool tool{kBall, {0.051, 0.0495, 0.003}};
            const Contact contact = steady(tool, e, mu);
            CHECK(!contact.flags.not_settled);
            REQUIRE(contact.touch.size() > 20);
            Eigen::VectorXd f_N = Eigen::VectorXd::Zero(3 * sliding_slab().n_touch);
            for (std::size_t i = 0; i < contact.touch.size(); ++i) {
                CHECK(contact.force_N[i] >= 0.0);
                f_N.segment<3>(3 * contact.touch[i]) =
                    contact.force_N[i] * Eigen::Vector3d(1.0, mu * e.x(), mu * e.y());
            }
            // the columns of tangential unit forces were solved by themselves: an independent check of Maxwell-Betti
            const Eigen::VectorXd u_m = sliding_slab().full_m_per_N * f_N;
            for (int i = 0; i < sliding_slab().n_touch; ++i) {
                const double dx = sliding_slab().position_m(0, i) - tool.pose.x_m;
                const double dy = sliding_slab().position_m(1, i) - tool.pose.y_m;
                const double r2 = dx * dx + dy * dy;
                if (r2 >= kBall.radius_m * kBall.radius_m) continue;
                const double R = kBall.radius_m;
                const double gap_m = u_m(3 * i) - (tool.pose.depth_m - R + std::sqrt(R * R - r2));
                CHECK(gap_m >= -1e-9 * tool.pose.depth_m);
                CHECK(f_N(3 * i) * gap_m <= 1e-9 * contact.tool[0].normal_N * tool.pose.depth_m);
            }
        }
    }
}

TEST_CASE(
    "steady sliding: the force against the motion is mu N and the slope of the pressure; nothing to the side of a "
    "symmetric path") {
    const double mu = 0.4;
    const Tool tool{kBall, {0.05, 0.05, 0.003}};
    const Contact contact = steady(tool, {1.0, 0.0}, mu);
    const ToolForce& f = contact.tool[0];
    double slope_N = 0.0;
    for (std::size_t i = 0; i < contact.touch.size(); ++i) {
        const Eigen::Vector3d at = sliding_slab().position_m.col(contact.touch[i]);
        const double dx = at.x() - tool.pose.x_m;
        const double dy = at.y() - tool.pose.y_m;
        slope_N += contact.force_N[i] * dx / std::sqrt(kBall.radius_m * kBall.radius_m - dx * dx - dy * dy);
    }
    CHECK(f.tangential_x_N == close_to(mu * f.normal_N + slope_N).epsilon(1e-12));
    CHECK(std::abs(f.tangential_y_N) < 1e-9 * f.normal_N);
    // with a poisson ratio below 1/2 pressing draws the surface to the load, so dragging makes it sink ahead
    // (Maxwell-Betti): less pressure there
    CHECK(slope_N < -0.01 * f.normal_N);
    CHECK(f.moment_y_Nm > 0.0);

    const ToolForce back = steady(tool, {-1.0, 0.0}, mu).tool[0];
    CHECK(back.normal_N == close_to(f.normal_N).epsilon(1e-9));
    CHECK(back.tangential_x_N == close_to(-f.tangential_x_N).epsilon(1e-9));
    const ToolForce along_y = steady(tool, {0.0, 1.0}, mu).tool[0];
    CHECK(along_y.tangential_y_N == close_to(f.tangential_x_N).epsilon(1e-9));
}

TEST_CASE("steady sliding: what a slide of two contact radii, step by step, ends in, within 0.2 %") {
    // what is left out, slip to the side and nodes that have not slipped all the way, is 0.03 % here
    for (const double mu : {0.2, 0.5}) {
        FrictionWork work;
        FrictionState state;
        Contact contact;
        FrictionOptions options;
        options.coefficient = mu;
        Tool tool{kBall, {0.0440, 0.05, 0.002}};  // contact radius 4 mm at most
        for (int i = 0; i <= 32; ++i) {
            tool.pose.x_m = 0.0440 + 2.5e-4 * i;
            slide_to(sliding_slab(), tool, options, work, state, contact);
            REQUIRE(!contact.flags.not_settled);
        }
        const ToolForce& stepped = contact.tool[0];
        const ToolForce formula = steady(tool, {1.0, 0.0}, mu).tool[0];
        MESSAGE("mu ", mu, ": normal ", formula.normal_N / stepped.normal_N - 1.0, ", tangential ",
                formula.tangential_x_N / stepped.tangential_x_N - 1.0, " off the step-by-step solver");
        CHECK(formula.normal_N == close_to(stepped.normal_N).epsilon(0.002));
        CHECK(formula.tangential_x_N == close_to(stepped.tangential_x_N).epsilon(0.002));
    }
}

TEST_CASE("steady sliding: Gauss-Seidel alone gives the same forces") {
    const Tool tool{kBall, {0.0505, 0.0498, 0.004}};
    const Contact direct = steady(tool, {0.6, 0.8}, 0.5);
    const Contact swept = steady(tool, {0.6, 0.8}, 0.5, 0);
    CHECK(swept.touch == direct.touch);
    CHECK(swept.tool[0].normal_N == close_to(direct.tool[0].normal_N).epsilon(1e-9));
    const Contact unfinished = steady(tool, {0.6, 0.8}, 0.5, 0, 1);  // one sweep is not enough, and says so
    CHECK(unfinished.flags.not_settled);
    CHECK(unfinished.violation_m > 0.0);
}

TEST_CASE("steady sliding: no depth is no force; a pose that is not finite and a plain compliance are refused") {
    const Contact lifted = steady({kBall, {0.05, 0.05, 0.0}}, {1.0, 0.0}, 0.3);
    CHECK(lifted.tool[0].normal_N == 0.0);
    CHECK(lifted.touch.empty());
    CHECK_THROWS_AS(steady({kBall, {std::nan(""), 0.05, 0.001}}, {1.0, 0.0}, 0.3), LoadError);
    Compliance plain = sliding_slab();
    plain.along_x_m_per_N.resize(0, 0);
    SteadyWork work;
    Contact contact;
    CHECK_THROWS_WITH_AS(slide_steadily(plain, {kBall, {0.05, 0.05, 0.001}}, {}, work, contact),
                         doctest::Contains("sideways"), LoadError);
}
