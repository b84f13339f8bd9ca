#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

#include "mechanics/contact.h"
#include "mechanics/contact_area.h"
#include "mechanics/layer.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

struct Pressed {
    Contact contact;
    double node_sum_m2 = 0.0;  // whole shares
    double area_m2 = 0.0;
};

constexpr double kRadius_m = 0.01;
constexpr double kContact_m = 0.001;  // Hertz: radius of the contact at kContact^2 / kRadius

struct Slab {
    Mesh mesh;
    Compliance compliance;
    double middle_m = 0.0;
};

// Fine in the middle of its top.
Slab slab_of(double spacing_m) {
    const double fine_m = 1.6 * kContact_m;
    const int n = static_cast<int>(std::ceil(fine_m / spacing_m));
    Eigen::VectorXd half(n + 9);
    for (int i = 0; i <= n; ++i) half(i) = spacing_m * i;
    double step_m = spacing_m;
    for (int i = n + 1; i < half.size(); ++i) half(i) = half(i - 1) + (step_m *= 1.75);
    const Eigen::Index m = half.size();
    Eigen::VectorXd x(2 * m - 1);
    for (Eigen::Index i = 0; i < m; ++i) x(m - 1 + i) = half(m - 1) + half(i), x(m - 1 - i) = half(m - 1) - half(i);
    Eigen::VectorXd z(m);
    for (Eigen::Index i = 0; i < m; ++i) z(i) = half(m - 1) - half(m - 1 - i);
    Slab slab{hex_box(x, x, z), {}, half(m - 1)};
    const Problem problem = slab_problem(slab.mesh, Element::hex8_bbar, {2500.0, 0.45});
    const double low_m = slab.middle_m - 1.5 * kContact_m - spacing_m;
    const double high_m = slab.middle_m + 1.5 * kContact_m + spacing_m;
    slab.compliance = slab_compliance(problem, {low_m, high_m, low_m, high_m});
    return slab;
}

Pressed pressed(const Slab& slab, double off_m) {
    const Compliance& c = slab.compliance;
    const Tool tool{{IndenterShape::sphere, kRadius_m},
                    {slab.middle_m + off_m, slab.middle_m + 0.5 * off_m, kContact_m * kContact_m / kRadius_m}};
    Pressed out;
    ContactWork work;
    press_to_depth(c, {&tool, 1}, {}, work, out.contact);
    out.node_sum_m2 = out.contact.tool[0].area_m2;
    std::vector<int> nodes;
    for (const int touch : out.contact.touch) nodes.push_back(c.node[static_cast<std::size_t>(touch)]);
    const Faces top = faces_on(slab.mesh, boundary_faces(slab.mesh), Side::zmax);
    out.area_m2 = contact_area_m2(top, tributary_area_m2(slab.mesh, top), nodes, out.contact.force_N);
    return out;
}

}  // namespace

TEST_CASE("contact area: within a tenth of Hertz at three spacings across the radius, 6 % at four and five") {
    const double hertz_m2 = std::numbers::pi * kContact_m * kContact_m;
    for (const double spacings : {3.0, 4.0, 5.0}) {
        const double spacing_m = kContact_m / spacings;
        const Slab slab = slab_of(spacing_m);
        for (const double off : {0.0, 0.25, 0.5}) {
            CAPTURE(spacings);
            CAPTURE(off);
            const Pressed p = pressed(slab, off * spacing_m);
            MESSAGE(spacings << " spacings, " << off << " beside a node: " << p.area_m2 / hertz_m2
                             << " of Hertz, whole shares " << p.node_sum_m2 / hertz_m2);
            CHECK(p.area_m2 == close_to(hertz_m2).epsilon(spacings < 4.0 ? 0.10 : 0.06));
            CHECK(p.area_m2 < p.node_sum_m2);
        }
    }
}

TEST_CASE("contact area: a node alone counts whole, as do nodes pressed evenly") {
    const Mesh mesh = hex_box(Eigen::VectorXd::LinSpaced(5, 0.0, 4.0), Eigen::VectorXd::LinSpaced(5, 0.0, 4.0),
                              Eigen::VectorXd::LinSpaced(2, 0.0, 1.0));
    const Faces top = faces_on(mesh, boundary_faces(mesh), Side::zmax);
    const Eigen::VectorXd area_m2 = tributary_area_m2(mesh, top);
    const int middle = nearest_node(mesh, 2.0, 2.0, 1.0);
    const int beside = nearest_node(mesh, 3.0, 2.0, 1.0);
    const int one[] = {middle};
    const double one_N[] = {0.3};
    CHECK(contact_area_m2(top, area_m2, one, one_N) == close_to(1.0));
    const int two[] = {middle, beside};
    const double even_N[] = {0.3, 0.3};
    CHECK(contact_area_m2(top, area_m2, two, even_N) == close_to(2.0));
    const double odd_N[] = {0.3, 0.1};
    CHECK(contact_area_m2(top, area_m2, two, odd_N) == close_to(1.0 + 1.0 / 3.0 + 0.125));
}
