#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/contact.h"
#include "mechanics/error.h"
#include "mechanics/layer.h"
#include "mechanics/linear_range.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

constexpr double kYoung_Pa = 2500.0;
constexpr double kPoisson = 0.45;

// 100 x 100 x 50 mm, finest cells 1.2 mm; a stiff ball 8 mm right of the middle if asked for.
const Compliance& slab(bool nodule) {
    const auto make = [](bool with_nodule) {
        Problem problem =
            slab_problem(hex_box(graded_box(0.1, 0.05, 36, 6, 0.0012)), Element::hex8_bbar, {kYoung_Pa, kPoisson});
        const Sphere ball{{0.058, 0.05, 0.043}, 0.005};
        if (with_nodule) mix_in(sphere_share(problem.mesh, ball, 6), {2.5e6, 0.49}, Mixing::between, problem.materials);
        return slab_compliance(problem, {0.035, 0.068, 0.037, 0.063});
    };
    static const Compliance plain = make(false);
    static const Compliance stiff = make(true);
    return nodule ? stiff : plain;
}

Contact press(const Compliance& c, const Tool& tool, const ContactOptions& options = {}) {
    ContactWork work;
    Contact contact;
    press_to_depth(c, {&tool, 1}, options, work, contact);
    return contact;
}

// p >= 0, g >= -tol, p . g <= tol over every touch node, from the compliance itself.
void check_complementary(const Compliance& c, std::span<const Tool> tools, const Contact& contact, double tolerance_m) {
    Eigen::VectorXd u;
    surface_depression_m(c, contact, u);
    std::vector<double> p(static_cast<std::size_t>(c.n_touch), 0.0);
    for (std::size_t i = 0; i < contact.touch.size(); ++i)
        p[static_cast<std::size_t>(contact.touch[i])] = contact.force_N[i];
    double least_gap = 0.0;
    double work = 0.0;
    double total = 0.0;
    for (int i = 0; i < c.n_touch; ++i) {
        double delta = -1.0;
        for (std::size_t t = 0; t < tools.size(); ++t) {
            const double R = tools[t].indenter.radius_m;
            const double dx = c.position_m(0, i) - tools[t].pose.x_m;
            const double dy =
                tools[t].indenter.shape == IndenterShape::cylinder ? 0.0 : c.position_m(1, i) - tools[t].pose.y_m;
            const double r2 = dx * dx + dy * dy;
            if (r2 < R * R) delta = std::max(delta, contact.tool[t].depth_m - R + std::sqrt(R * R - r2));
        }
        const double force = p[static_cast<std::size_t>(i)];
        CHECK(force >= 0.0);
        if (delta == -1.0)
            CHECK(force == 0.0);
        else
            least_gap = std::min(least_gap, u(i) - delta);
        work += force * std::abs(u(i) - delta);
        total += force;
    }
    CHECK(least_gap > -tolerance_m);
    CHECK(work <= tolerance_m * total);
}

Eigen::VectorXd fine_then_growing_m(double fine_m, int n_fine, int n_growing, double end_m) {
    const Eigen::VectorXd far = graded_coordinates_m(end_m - n_fine * fine_m, n_growing, 0.0, fine_m * 1.2);
    Eigen::VectorXd x(n_fine + n_growing + 1);
    x.head(n_fine) = Eigen::VectorXd::LinSpaced(n_fine, 0.0, (n_fine - 1) * fine_m);
    x.tail(n_growing + 1) = n_fine * fine_m + far.array();
    return x;
}

}  // namespace

TEST_CASE("Hertz: within 3 % at contact radius / spacing > 4, on a block that is nearly a half-space") {
    // a quarter by symmetry; spacing 0.55 mm, contact radius 2.5 .. 3.3 mm
    const Eigen::VectorXd x = fine_then_growing_m(0.55e-3, 9, kSlow ? 9 : 12, 0.25);
    const Mesh mesh = hex_box(x, x, (0.25 - x.reverse().array()).matrix());
    Problem problem = slab_problem(mesh, Element::hex8_bbar, {kYoung_Pa, kPoisson});
    const Faces outer = boundary_faces(mesh);
    fix(nodes_of(faces_on(mesh, outer, Side::xmin)), "x", 0.0, problem.supports);
    fix(nodes_of(faces_on(mesh, outer, Side::ymin)), "y", 0.0, problem.supports);
    const Compliance c = slab_compliance(problem, {0.0, 0.007, 0.0, 0.007});
    for (const double depth : {0.0008, 0.001, 0.00135}) {
        CAPTURE(depth);
        const double hertz = hertz_force_N(plane_strain_modulus_Pa(kYoung_Pa, kPoisson), 0.008, depth);
        const Contact contact = press(c, {kBall, {0.0, 0.0, depth}});
        CHECK(hertz_contact_radius_m(0.008, depth) / 0.55e-3 > 4.0);
        MESSAGE("force over Hertz at contact radius / spacing " << hertz_contact_radius_m(0.008, depth) / 0.55e-3
                                                                << ": " << 4.0 * contact.tool[0].normal_N / hertz);
        CHECK(4.0 * contact.tool[0].normal_N == close_to(hertz).epsilon(0.03));
        CHECK(contact.flags.over_edge);  // the quarter ends under the ball
    }
}

TEST_CASE("contact force on the 50 mm slab lies within 9 % of Hertz") {
    // +-9 % scatter of coarse meshes about Hertz's half-space value, a few per cent above it with depth
    for (const double depth : {0.0005, 0.001, 0.002}) {
        CAPTURE(depth);
        const double ratio = press(slab(false), {kBall, {0.05, 0.05, depth}}).tool[0].normal_N /
                             hertz_force_N(plane_strain_modulus_Pa(kYoung_Pa, kPoisson), 0.008, depth);
        CHECK(ratio > 0.91);
        CHECK(ratio < 1.09);
    }
}

TEST_CASE("hard case 20: pressures push, gaps stay open, force rises with depth") {
    ContactWork work;
    Contact contact;
    double last = 0.0;
    for (double depth = 0.0001; depth < 0.0075; depth += 0.00023) {
        CAPTURE(depth);
        const Tool tool{kBall, {0.0522, 0.0487, depth}};
        press_to_depth(slab(true), {&tool, 1}, {}, work, contact);
        CHECK(!contact.flags.not_settled);
        check_complementary(slab(true), {&tool, 1}, contact, 1e-9 * depth);
        CHECK(contact.tool[0].normal_N > last);
        last = contact.tool[0].normal_N;
    }
}

TEST_CASE("hard case 20: deep starts, random jumps: the same answer warm or cold, to the last bit") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(0.04, 0.06);
    std::uniform_real_distribution<double> deep(0.0002, 0.007);
    ContactWork work;
    Contact warm;
    for (int i = 0; i < 60; ++i) {
        const Tool tool{kBall, {place(random), place(random), deep(random)}};
        press_to_depth(slab(true), {&tool, 1}, {}, work, warm);
        const Contact cold = press(slab(true), tool);
        CHECK(warm.touch == cold.touch);
        CHECK(warm.force_N == cold.force_N);
        CHECK(warm.tool[0].tangential_x_N == cold.tool[0].tangential_x_N);
    }
}

TEST_CASE("hard case 20: Gauss-Seidel alone gives the same force; without sweeps it says that it has not settled") {
    const Tool tool{kBall, {0.0511, 0.0493, 0.004}};
    const Contact direct = press(slab(true), tool);
    ContactOptions sweeps;
    sweeps.max_changes = 0;
    const Contact swept = press(slab(true), tool, sweeps);
    CHECK(swept.tool[0].normal_N == close_to(direct.tool[0].normal_N).epsilon(1e-9));
    CHECK(!swept.flags.not_settled);
    sweeps.sweeps = 1;
    const Contact rough = press(slab(true), tool, sweeps);
    if (rough.flags.not_settled) CHECK(rough.violation_m > 0.0);
    for (const double p : rough.force_N) CHECK(p >= 0.0);
}

TEST_CASE("hard case 20: two tools at one node, doubled nodes") {
    const Tool one{kBall, {0.05, 0.05, 0.003}};
    const Tool both[] = {one, one};
    ContactWork work;
    Contact contact;
    press_to_depth(slab(false), both, {}, work, contact);
    const Contact single = press(slab(false), one);
    CHECK(contact.tool[0].normal_N + contact.tool[1].normal_N == close_to(single.tool[0].normal_N).epsilon(1e-12));

    // every touch node listed twice: a singular compliance
    const Problem problem =
        slab_problem(hex_box(graded_box(0.1, 0.05, 14, 5, 0.0025)), Element::hex8_bbar, {kYoung_Pa, kPoisson});
    SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.03, 0.07, 0.03, 0.07});
    const Factored factored = factorise(problem, best_solver());
    const Compliance plain = surface_compliance(problem.mesh, factored, request);
    request.touch_nodes.insert(request.touch_nodes.end(), request.touch_nodes.begin(), request.touch_nodes.end());
    const Compliance doubled = surface_compliance(problem.mesh, factored, request);
    const Contact twice = press(doubled, one);
    CHECK(twice.tool[0].normal_N == close_to(press(plain, one).tool[0].normal_N).epsilon(1e-6));
    for (const double p : twice.force_N) CHECK(p >= 0.0);
}

TEST_CASE("hard case 20: a pose that is not a number holds the last answer and says so; limits are flagged") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    ContactWork work;
    Contact contact;
    Tool tool{kBall, {0.05, 0.05, 0.002}};
    press_to_depth(slab(false), {&tool, 1}, {}, work, contact);
    const double force = contact.tool[0].normal_N;
    CHECK(!contact.flags.held);
    for (const Pose& pose :
         {Pose{nan, 0.05, 0.002}, Pose{0.05, nan, 0.002}, Pose{0.05, 0.05, nan}, Pose{0.05, 0.05, HUGE_VAL}}) {
        tool.pose = pose;
        press_to_depth(slab(false), {&tool, 1}, {}, work, contact);
        CHECK(contact.flags.held);
        CHECK(contact.tool[0].normal_N == force);
    }
    press_with_force(slab(false), {kBall, {0.05, 0.05, 0.0}}, nan, {}, work, contact);
    CHECK(contact.flags.held);

    const Contact never = press(slab(false), {kBall, {nan, 0.05, 0.002}});  // nothing to hold yet: no force
    CHECK(never.flags.held);
    CHECK(never.tool[0].normal_N == 0.0);

    ContactOptions shallow;
    shallow.max_depth_m = 0.002;
    const Contact capped = press(slab(false), {kBall, {0.05, 0.05, 0.02}}, shallow);
    CHECK(capped.flags.capped);
    CHECK(capped.tool[0].normal_N == force);
    CHECK(capped.tool[0].depth_m == 0.002);
    CHECK(press(slab(false), {kBall, {0.05, 0.05, 1.0}}).tool[0].depth_m == close_to(0.05));  // the thickness

    const Contact beside = press(slab(false), {kBall, {0.2, 0.05, 0.002}});
    CHECK(beside.flags.over_edge);
    CHECK(beside.tool[0].normal_N == 0.0);
    CHECK(press(slab(false), {kBall, {0.05, 0.05, -0.01}}).tool[0].normal_N == 0.0);
    CHECK_THROWS_AS(check_tool(slab(false), {kBall, {0.2, 0.05, 0.002}}), LoadError);
    CHECK_THROWS_AS(check_tool(slab(false), {kBall, {0.05, 0.05, 0.05}}), LoadError);
    CHECK_THROWS_AS(check_tool(slab(false), {{IndenterShape::sphere, 0.0}, {0.05, 0.05, 0.001}}), LoadError);
    CHECK_NOTHROW(check_tool(slab(false), {kBall, {0.05, 0.05, 0.001}}));
}

TEST_CASE("contact: mirrored places give mirrored answers, alone and both at once") {
    const Tool left{kBall, {0.0433, 0.047, 0.0025}};
    const Tool right{kBall, {0.0567, 0.047, 0.0025}};
    const Contact a = press(slab(false), left);
    const Contact b = press(slab(false), right);
    const double N = a.tool[0].normal_N;
    CHECK(b.tool[0].normal_N == close_to(N).epsilon(1e-10));
    CHECK(std::abs(a.tool[0].tangential_x_N + b.tool[0].tangential_x_N) < 1e-9 * N);
    CHECK(std::abs(a.tool[0].tangential_y_N - b.tool[0].tangential_y_N) < 1e-9 * N);
    CHECK(std::abs(a.tool[0].moment_y_Nm + b.tool[0].moment_y_Nm) < 1e-9 * N * 0.008);
    const Tool both[] = {left, right};
    ContactWork work;
    Contact contact;
    press_to_depth(slab(false), both, {}, work, contact);
    check_complementary(slab(false), both, contact, 1e-11);
    CHECK(contact.tool[0].normal_N == close_to(contact.tool[1].normal_N).epsilon(1e-10));
    CHECK(contact.tool[0].normal_N < N);  // the neighbour has lowered the surface
}

TEST_CASE("contact: energy is the work of the normal force, tangential force its slope within 5 %") {
    // beside the nodule, where the slope is large; energy by integrating the force over depth
    const auto work_J = [](double x_m, double depth_m) {
        const int n = 60;
        double sum = 0.0;
        for (int i = 0; i < n; ++i)
            sum += press(slab(true), {kBall, {x_m, 0.05, depth_m * (i + 0.5) / n}}).tool[0].normal_N * depth_m / n;
        return sum;
    };
    for (const double x_m : {0.049, 0.051, 0.0525}) {
        CAPTURE(x_m);
        const double depth_m = 0.003;
        const Contact contact = press(slab(true), {kBall, {x_m, 0.05, depth_m}});
        CHECK(work_J(x_m, depth_m) == close_to(contact.energy_J).epsilon(2e-3));
        const double reach_m = 0.15e-3;  // within one cell: both sides see the same nodes
        const double slope_N = (work_J(x_m + reach_m, depth_m) - work_J(x_m - reach_m, depth_m)) / (2.0 * reach_m);
        CHECK(contact.tool[0].tangential_x_N == close_to(slope_N).epsilon(0.05));
        CHECK(slope_N > 0.03 * contact.tool[0].normal_N);  // a slope worth the name
    }
    // exactly the derivative of the discrete energy
    const double h = 1e-7;
    const auto energy_J = [](double x_m) { return press(slab(true), {kBall, {x_m, 0.05, 0.003}}).energy_J; };
    CHECK(press(slab(true), {kBall, {0.0513, 0.05, 0.003}}).tool[0].tangential_x_N ==
          close_to((energy_J(0.0513 + h) - energy_J(0.0513 - h)) / (2.0 * h)).epsilon(1e-5));
}

TEST_CASE("contact: over a nodule it is stiffer, and the tangential force changes sign there") {
    const auto at = [](double x_m) { return press(slab(true), {kBall, {x_m, 0.05, 0.003}}).tool[0]; };
    CHECK(at(0.058).normal_N > 1.15 * press(slab(false), {kBall, {0.058, 0.05, 0.003}}).tool[0].normal_N);
    CHECK(at(0.058).normal_N > at(0.05).normal_N);
    CHECK(at(0.052).tangential_x_N > 0.0);
    CHECK(at(0.064).tangential_x_N < 0.0);
}

TEST_CASE("hard case 21: the force ripple of a straight slide is small, and smaller on finer meshes") {
    const auto ripple = [](double finest_m) {
        const Problem problem =
            slab_problem(hex_box(graded_box(0.1, 0.05, 32, 6, finest_m)), Element::hex8_bbar, {kYoung_Pa, kPoisson});
        const Compliance c = slab_compliance(problem, {0.035, 0.065, 0.035, 0.065});
        double low = HUGE_VAL;
        double high = 0.0;
        double side = 0.0;
        for (int i = 0; i <= 60; ++i) {
            const Contact contact = press(c, {kBall, {0.05 + (i - 30) * 0.0001, 0.05, 0.003}});
            low = std::min(low, contact.tool[0].normal_N);
            high = std::max(high, contact.tool[0].normal_N);
            side = std::max(side, std::abs(contact.tool[0].tangential_x_N));
        }
        CHECK(side < 0.03 * high);  // homogeneous: all of it is ripple
        return (high - low) / (0.5 * (high + low));
    };
    const double coarse = ripple(2e-3);  // contact radius / spacing 2.4
    const double fine = ripple(1.1e-3);  // 4.5
    MESSAGE("force ripple at contact radius / spacing 2.4: " << 100.0 * coarse << " %, at 4.5: " << 100.0 * fine
                                                             << " %");
    CHECK(coarse < 0.05);
    CHECK(fine < 0.02);
    CHECK(fine < coarse);
}

TEST_CASE("contact: force input finds the depth") {
    ContactWork work;
    Contact contact;
    double last_m = 0.0;
    for (const double force_N : {1e-6, 0.001, 0.01, 0.05, 0.1, 0.2}) {
        CAPTURE(force_N);
        press_with_force(slab(true), {kBall, {0.053, 0.049, 0.0}}, force_N, {}, work, contact);
        CHECK(contact.tool[0].normal_N == close_to(force_N).epsilon(1e-8));
        CHECK(contact.tool[0].depth_m > last_m);
        CHECK(!contact.flags.capped);
        last_m = contact.tool[0].depth_m;
        // the stiffness is the slope
        const double h = 1e-9;
        const Contact more = press(slab(true), {kBall, {0.053, 0.049, last_m + h}});
        const Contact less = press(slab(true), {kBall, {0.053, 0.049, last_m - h}});
        CHECK(contact.stiffness_N_per_m ==
              close_to((more.tool[0].normal_N - less.tool[0].normal_N) / (2.0 * h)).epsilon(1e-3));
    }
    press_with_force(slab(true), {kBall, {0.053, 0.049, 0.003}}, 0.0, {}, work, contact);
    CHECK(contact.tool[0].normal_N == 0.0);
    ContactOptions shallow;
    shallow.max_depth_m = 0.002;
    press_with_force(slab(true), {kBall, {0.053, 0.049, 0.0}}, 5.0, shallow, work, contact);
    CHECK(contact.flags.capped);
    CHECK(contact.tool[0].depth_m == close_to(0.002));
    press_with_force(slab(true), {kBall, {0.3, 0.3, 0.0}}, 0.1, {}, work, contact);  // beside the tissue
    CHECK(contact.flags.capped);
    CHECK(contact.tool[0].normal_N == 0.0);
}

TEST_CASE("contact: a force that no depth gives is said to be missed, and the search ends") {
    // between nodes the force is a straight line from a depth on, whose last bit is worth more than this force
    ContactWork work;
    Contact contact;
    press_with_force(slab(false), {kBall, {0.0506, 0.0506, 0.0}}, 1e-18, {}, work, contact);
    CHECK(contact.flags.force_missed);
    press_with_force(slab(false), {kBall, {0.0506, 0.0506, 0.0}}, 0.05, {}, work, contact);
    CHECK_FALSE(contact.flags.force_missed);
    ContactOptions rough;  // one sweep: the force jumps from depth to depth
    rough.max_changes = 0;
    rough.sweeps = 1;
    press_with_force(slab(true), {kBall, {0.053, 0.049, 0.0}}, 0.1, rough, work, contact);
    if (std::abs(contact.tool[0].normal_N - 0.1) > 1e-9) CHECK(contact.flags.force_missed);
}

TEST_CASE("contact: a compliance that cannot be factored is not taken for settled") {
    Compliance damaged = slab(false);
    damaged.revision = new_revision();
    damaged.normal_m_per_N.topRows(damaged.n_touch).diagonal() *= -1.0;
    const Contact contact = press(damaged, {kBall, {0.05, 0.05, 0.002}});
    CHECK(contact.flags.not_settled);
    CHECK(std::isfinite(contact.tool[0].normal_N));
    CHECK(contact.tool[0].normal_N >= 0.0);
}

TEST_CASE("contact: another compliance at the same address is not taken for the one before") {
    // the two differ but share what was once looked at: the address, the first entry and one more
    Compliance c = slab(false);
    const Tool tool{kBall, {0.05, 0.05, 0.002}};
    ContactWork work;
    Contact contact;
    press_to_depth(c, {&tool, 1}, {}, work, contact);
    const Contact fresh_before = press(c, tool);
    CHECK(contact.force_N == fresh_before.force_N);
    Compliance other = c;
    const Eigen::Index middle = contact.touch[contact.touch.size() / 2];
    other.normal_m_per_N(middle, middle) *= 1.5;
    other.revision = new_revision();
    const double* const address = c.normal_m_per_N.data();
    c.normal_m_per_N = other.normal_m_per_N;
    c.revision = other.revision;
    REQUIRE(c.normal_m_per_N.data() == address);
    press_to_depth(c, {&tool, 1}, {}, work, contact);
    const Contact fresh = press(other, tool);
    CHECK(contact.tool[0].normal_N == fresh.tool[0].normal_N);
    CHECK(contact.tool[0].normal_N < fresh_before.tool[0].normal_N);
}

TEST_CASE("contact: a roller, and a thin incompressible layer that bulges up to the tool") {
    const Tool roller{{IndenterShape::cylinder, 0.01, 0.02}, {0.05, 0.05, 0.002}};
    const Contact rolled = press(slab(false), roller);
    CHECK(rolled.tool[0].normal_N >
          press(slab(false), {{IndenterShape::sphere, 0.01}, {0.05, 0.05, 0.002}}).tool[0].normal_N);
    CHECK(std::abs(rolled.tool[0].tangential_x_N) < 1e-9);
    CHECK(rolled.tool[0].tangential_y_N == 0.0);
    for (const int touch : rolled.touch) CHECK(std::abs(slab(false).position_m(1, touch) - 0.05) <= 0.01);

    const Problem thin =
        slab_problem(hex_box(graded_box(0.08, 0.004, 32, 4, 0.0008)), Element::hex8_bbar, {kYoung_Pa, 0.4999});
    const Compliance c = slab_compliance(thin, {0.02, 0.06, 0.02, 0.06});
    const Tool ball{{IndenterShape::sphere, 0.05}, {0.0402, 0.0399, 0.0004}};
    const Contact contact = press(c, ball);
    check_complementary(c, {&ball, 1}, contact, 1e-12);
    double widest = 0.0;
    for (const int touch : contact.touch)
        widest = std::max(widest, std::hypot(c.position_m(0, touch) - 0.0402, c.position_m(1, touch) - 0.0399));
    CHECK(widest > std::sqrt(2.0 * 0.05 * 0.0004) * 1.05);  // beyond where the undeformed ball would cut the plane
}

TEST_CASE("contact: a surface that other loads have raised is met over its whole width") {
    const Compliance& flat = slab(false);
    Compliance raised = flat;
    raised.revision = flat.revision + 1000;
    raised.position_m.row(2).array() += 0.001;
    const Tool shallow{kBall, {0.0502, 0.0499, 0.0001}};
    const Tool deep{kBall, {0.0502, 0.0499, 0.0011}};
    const Contact on_raised = press(raised, shallow);
    const Contact on_flat = press(flat, deep);
    CHECK(on_raised.touch == on_flat.touch);
    CHECK(on_raised.tool[0].normal_N == close_to(on_flat.tool[0].normal_N).epsilon(1e-9));
}

TEST_CASE("contact: nothing is allocated after the first calls") {
    ContactWork work = make_contact_work(slab(true), 150);
    Contact contact;
    Eigen::VectorXd u;
    const auto run = [&] {
        for (int i = 0; i < 200; ++i) {
            const Tool tool{kBall, {0.05 + 0.006 * std::sin(0.1 * i), 0.05, 0.003 + 0.002 * std::cos(0.07 * i)}};
            press_to_depth(slab(true), {&tool, 1}, {}, work, contact);
            press_with_force(slab(true), tool, 0.05 + 0.02 * std::cos(0.07 * i), {}, work, contact);
            surface_depression_m(slab(true), contact, u);
        }
    };
    run();
    const long before = allocation_count();
    run();
    CHECK(allocation_count() == before);
    if (!allocation_count_works()) MESSAGE("allocations are not counted in this build");
}

TEST_CASE("linear range: amber above 10 %, red above 25 %") {
    CHECK(linear_range(linearity_ratio(0.001, 0.05, 0.02)) == LinearRange::fine);
    CHECK(linear_range(linearity_ratio(0.003, 0.05, 0.02)) == LinearRange::amber);
    CHECK(linear_range(linearity_ratio(0.003, 0.01, 0.1)) == LinearRange::red);
    CHECK(linearity_ratio(0.0, 0.05, 0.0) == 0.0);
}
