// Through the case file: what a finite-element program must get right, and what it must refuse.

#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <random>

#include "fem/case.h"
#include "files/input_error.h"
#include "mechanics/layer.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/fem/fem_cases.h"
#include "tests/files/msh_writer.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::fem;
using namespace palpa::test;

namespace {

const std::string kBlock =
    R"({"box": {"size_mm": [20, 30, 10], "elements": [3, 4, 3], "grading": {"centre_mm": [7, 11], "finest_mm": 2}}})";

// Free to become thinner: rollers on three sides that meet.
const std::string kRollers =
    R"({"face": "xmin", "fix": "x"}, {"face": "ymin", "fix": "y"}, {"face": "zmin", "fix": "z"})";

// A quarter of a wide slab, pressed at its corner.
FemResult quarter(int n, int nz, double finest_mm, double width_mm, double poisson) {
    const std::string side = number_text(0.5 * width_mm);
    const std::string cells = std::to_string(n);
    const std::string mesh = "{\"box\": {\"size_mm\": [" + side + ", " + side + ", 50], \"elements\": [" + cells +
                             ", " + cells + ", " + std::to_string(nz) +
                             "], \"grading\": {\"centre_mm\": [0, 0], \"finest_mm\": " + number_text(finest_mm) + "}}}";
    return solved(
        case_text(mesh, "hex8-bbar",
                  R"([{"face": "zmin", "fix": "xyz"}, {"face": "xmin", "fix": "x"}, {"face": "ymin", "fix": "y"}])",
                  press_at(0, 0, 16), gel(2500, poisson)));
}

std::string said(const std::string& text, const std::filesystem::path& folder = ".") {
    return message_of([&] { solved(text, folder); });
}

}  // namespace

TEST_CASE("case: patch test, a uniform traction makes the same strain in every cell, to 1e-12") {
    for (const char* element : {"hex8-bbar", "hex8", "tet4"}) {
        CAPTURE(element);
        // a pull of 100 Pa along z: 1/E of it along z, -nu/E across
        const FemResult r = solved(case_text(kBlock, element, "[" + kRollers + "]",
                                             R"([{"traction_Pa": [0, 0, 100], "face": "zmax"}])", gel(4000, 0.4)));
        const double e = 100.0 / 4000.0;
        for (Eigen::Index cell = 0; cell < r.fields.strain.cols(); ++cell) {
            const mechanics::Voigt expected{-0.4 * e, -0.4 * e, e, 0.0, 0.0, 0.0};
            CHECK((r.fields.strain.col(cell) - expected).cwiseAbs().maxCoeff() < 1e-12 * e);
            CHECK(std::abs(r.fields.stress_Pa(2, cell) - 100.0) < 1e-9);
            CHECK(r.von_mises_Pa(cell) == close_to(100.0).epsilon(1e-10));
        }
        CHECK(*r.centre_m == close_to(-0.01 * e).epsilon(1e-12));
        CHECK(r.applied_N == close_to(100.0 * 6e-4).epsilon(1e-12));
        CHECK(*r.skel_m == close_to(0.01 * e).epsilon(1e-12));
        CHECK(r.reaction_N[2].z() == close_to(-100.0 * 6e-4).epsilon(1e-12));
        CHECK(r.solution.energy_J == close_to(0.5 * r.applied_N * *r.skel_m).epsilon(1e-11));
    }
}

TEST_CASE("case: pressure on every side squeezes evenly, by -p (1 - 2 nu)/E") {
    std::string loads = "[";
    for (const char* face : {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"}) {
        loads += std::string(loads.size() > 1 ? ", " : "") + R"({"traction_Pa": 50, "face": ")" + face + "\"}";
    }
    for (const char* element : {"hex8-bbar", "tet4"}) {
        const FemResult r = solved(case_text(kBlock, element, "[" + kRollers + "]", loads + "]", gel(4000, 0.4)));
        const double e = -50.0 * 0.2 / 4000.0;
        for (Eigen::Index cell = 0; cell < r.fields.strain.cols(); ++cell) {
            CHECK((r.fields.strain.col(cell).head<3>().array() - e).abs().maxCoeff() < 1e-12);
            CHECK(r.fields.strain.col(cell).tail<3>().cwiseAbs().maxCoeff() < 1e-12);
        }
        for (const auto& reaction : r.reaction_N) CHECK(reaction.norm() == close_to(0.0).epsilon(1e-9).scale(0.015));
    }
}

TEST_CASE("case: a rigid translation makes no strain and no force") {
    for (const char* element : {"hex8-bbar", "hex8", "tet4"}) {
        const FemResult r =
            solved(case_text(kBlock, element, R"([{"face": "zmin", "fix": "xyz", "value_mm": 1.5}])", "[]"));
        CHECK(r.max_displacement_m == close_to(1.5e-3 * std::sqrt(3.0)).epsilon(1e-12));
        CHECK((r.solution.u_m.array() - 1.5e-3).abs().maxCoeff() < 1e-14);
        CHECK(r.max_strain < 1e-12);
        CHECK(r.reaction_N[0].norm() < 1e-12);
        CHECK_FALSE(r.centre_m);
        CHECK_FALSE(r.skel_m);
        CHECK(r.converged);
    }
}

TEST_CASE("case: a squeezed block answers E A d/h at both supports") {
    const FemResult r =
        solved(case_text(kBlock, "hex8-bbar", "[" + kRollers + R"(, {"face": "zmax", "fix": "z", "value_mm": -0.1}])",
                         "[]", gel(4000, 0.4)));
    CHECK(r.reaction_N[3].z() == close_to(-4000.0 * 6e-4 * 0.01).epsilon(1e-10));
    CHECK(r.reaction_N[2].z() == close_to(4000.0 * 6e-4 * 0.01).epsilon(1e-10));
    CHECK(r.solution.energy_J == close_to(0.5 * 4000.0 * 6e-4 * 0.01 * 1e-4).epsilon(1e-10));
    CHECK(r.max_strain == close_to(0.01).epsilon(1e-9));
}

TEST_CASE("case: CalculiX 2.20 stores the same energy in the same mesh") {
    // tests/mechanics/calculix: C3D8 and C3D4, a ball 1000 times stiffer, pressed beside the middle
    const std::string mesh =
        R"({"box": {"size_mm": [100, 100, 50], "elements": [6, 6, 4], "grading": {"centre_mm": [50, 50], "finest_mm": 8}}})";
    const std::string materials =
        R"({"gel": {"young_Pa": 2500, "poisson": 0.45}, "ball": {"young_Pa": 2.5e6, "poisson": 0.3}})";
    const std::string regions =
        R"([{"all": true, "material": "gel"}, {"sphere": {"centre_mm": [50, 50, 30], "radius_mm": 15}, "material": "ball"}])";
    const auto energy_J = [&](const std::string& element, const std::string& list) {
        return solved(case_text(mesh, element, kClamped, press_at(47, 52, 30), materials, list)).solution.energy_J;
    };
    CHECK(energy_J("hex8", regions) == close_to(1.147082e-6 + 1.242941e-8).epsilon(1e-6));
    CHECK(energy_J("tet4", regions) == close_to(5.040069e-7 + 1.477925e-8).epsilon(1e-6));
    // later regions win
    CHECK(energy_J("hex8", regions.substr(0, regions.size() - 1) +
                               R"(, {"box": {"min_mm": [0, 0, 0], "max_mm": [100, 100, 50]}, "material": "gel"}])") >
          1.2 * energy_J("hex8", regions));
}

TEST_CASE("case: the mesh is finest at the place that is named, also in a box that origin_mm moves") {
    const auto centre_m = [](const char* origin, const char* centre, double at_mm) {
        const std::string mesh =
            std::string(R"({"box": {"size_mm": [100, 100, 50], "elements": [6, 6, 4], "origin_mm": )") + origin +
            R"(, "grading": {"centre_mm": )" + centre + R"(, "finest_mm": 4}}})";
        return *solved(case_text(mesh, "hex8-bbar", kClamped, press_at(at_mm, at_mm, 30), gel(2500, 0.45))).centre_m;
    };
    CHECK(centre_m("[-50, -50, 0]", "[0, 0]", 0) == close_to(centre_m("[0, 0, 0]", "[50, 50]", 50)).epsilon(1e-9));
    CHECK(contains(said(case_text(
                       R"({"box": {"size_mm": [100, 100, 50], "elements": [6, 6, 4], "origin_mm": [-50, -50, 0],
                           "grading": {"centre_mm": [60, 0], "finest_mm": 4}}})",
                       "hex8-bbar", kClamped, press_at(0, 0, 30), gel(2500, 0.45))),
                   "found 60, expected a place in the box, -50 to 50"));
}

TEST_CASE("case: nodes on the ends of a cylinder are warned of, ends midway between nodes are not") {
    const auto warned = [](const char* length_mm) {
        const FemResult r =
            solved(case_text(R"({"box": {"size_mm": [10, 10, 6], "elements": [20, 20, 8]}})", "hex8-bbar", kClamped,
                             std::string(R"([{"indenter": {"shape": "cylinder", "radius_mm": 4, "length_mm": )") +
                                 length_mm + R"(, "centre_mm": [5, 5], "depth_mm": 1}}])",
                             gel(20000, 0.45)));
        bool found = false;
        for (const std::string& warning : contact_warnings(*r.contact))
            found = found || contains(warning, "nodes lie on the tool's ends");
        return found;
    };
    CHECK(warned("5"));
    CHECK_FALSE(warned("5.5"));
}

TEST_CASE("case: the slab of the paper, 100 mm wide, is 1.7 % softer than the layer") {
    const FemResult r = quarter(12, 10, 1.5, 100, 0.45);
    CHECK(*r.centre_m == close_to(0.77673e-3).epsilon(0.004));
    CHECK(r.partial);
    CHECK(r.applied_N == close_to(0.025 / 4.0).epsilon(1e-10));
    CHECK(*r.skel_m == close_to(0.57488e-3 * 1.017).epsilon(0.01));
    CHECK(r.linear == mechanics::LinearRange::fine);
}

TEST_CASE("case: a slab 400 mm wide is within 0.3 % of the bonded layer, nu 0.30 and 0.45") {
    for (const double poisson : {0.30, 0.45}) {
        CAPTURE(poisson);
        const double exact_m = mechanics::layer_depression_m({2500.0, poisson, 0.05}, {}, 0.0);
        const FemResult r = quarter(20, 12, 1.5, 400, poisson);
        CHECK(*r.centre_m == close_to(exact_m).epsilon(0.003));
        CHECK(r.solution.backward_error < 1e-14);
        CHECK(r.residual < 1e-11);
    }
}

TEST_CASE("case: the shipped cases say what their comments promise") {
    if (kSlow) return;
    const std::string folder = PALPA_SOURCE_DIR "/assets/cases/";
    const FemResult slab = solved(read_case(folder + "slab.json"));
    CHECK(*slab.centre_m == close_to(0.77673e-3).epsilon(0.003));
    CHECK(slab.reaction_N[0].z() == close_to(0.025).epsilon(1e-10));
    CHECK(slab.solution.energy_J == close_to(0.5 * 0.025 * *slab.skel_m).epsilon(1e-10));
    const FemResult wide = solved(read_case(folder + "wide-slab.json"));
    CHECK(*wide.centre_m == close_to(0.76401e-3).epsilon(0.003));
}

TEST_CASE("contact: a mesh that is fine in one direction alone is warned of") {
    // finest where the tool is along y, and elsewhere along x
    const FemResult result = solved(case_text(
        R"({"box": {"size_mm": [80, 80, 60], "elements": [30, 30, 6], "grading": {"centre_mm": [10, 40], "finest_mm": 0.3}}})",
        "hex8-bbar", kClamped,
        R"([{"indenter": {"shape": "sphere", "radius_mm": 10, "centre_mm": [65.3, 40], "depth_mm": 0.2}}])"));
    REQUIRE(result.contact);
    CHECK(result.contact->cells_across_radius < 1.0);  // sqrt(R d) is 1.4 mm, and 4.7 of the cells along y
    CHECK_FALSE(contact_warnings(*result.contact).empty());
}

TEST_CASE("contact: cells that are higher than the contact's radius are warned of") {
    const auto pressed = [](int layers) {
        return solved(case_text(
            R"({"box": {"size_mm": [10, 10, 12], "elements": [28, 28, )" + std::to_string(layers) + "]}}", "hex8-bbar",
            kClamped,
            R"([{"indenter": {"shape": "sphere", "radius_mm": 10, "centre_mm": [5, 5], "depth_mm": 0.21}}])"));
    };
    const FemResult flat = pressed(9), high = pressed(1);
    CHECK(flat.contact->cells_under_radius == close_to(std::sqrt(2.1) / (12.0 / 9.0)).epsilon(1e-9));
    CHECK(contact_warnings(*flat.contact).empty());
    CHECK(high.contact->cells_across_radius > 4.0);
    CHECK(high.contact->normal_N > 1.5 * flat.contact->normal_N);
    REQUIRE(contact_warnings(*high.contact).size() == 1);
    CHECK(contains(contact_warnings(*high.contact)[0], "8.281 times as high as its radius"));
}

TEST_CASE("fem case: no contact is larger than the whole section of its tool") {
    const FemResult deep = solved(case_text(
        R"({"box": {"size_mm": [24, 24, 12], "elements": [16, 16, 6], "grading": {"centre_mm": [12, 12], "finest_mm": 0.45}}})",
        "hex8-bbar", kClamped,
        R"([{"indenter": {"shape": "sphere", "radius_mm": 2, "centre_mm": [12, 12], "depth_mm": 8}}])"));
    CHECK(deep.contact->cells_across_radius >= 4.0);
    CHECK(deep.contact->area_m2 <= 1.000001 * std::numbers::pi * 4e-6);
}

TEST_CASE("hertz through a case: depth gives the force within 4 %, the force gives the depth back") {
    const std::string mesh =
        R"({"box": {"size_mm": [120, 120, 80], "elements": [22, 22, 12], "grading": {"centre_mm": [60, 60], "finest_mm": 0.24}}})";
    const auto with = [&](const std::string& rest) {
        return solved(
            case_text(mesh, "hex8-bbar", kClamped,
                      R"([{"indenter": {"shape": "sphere", "radius_mm": 10, "centre_mm": [60, 60], )" + rest + "}}]"));
    };
    const FemResult deep = with(R"("depth_mm": 0.1)");
    REQUIRE(deep.contact);
    const double hertz_N = mechanics::hertz_force_N(mechanics::plane_strain_modulus_Pa(2500, 0.45), 0.01, 1e-4);
    CHECK(deep.contact->normal_N == close_to(hertz_N).epsilon(0.04));
    CHECK(deep.contact->area_m2 == close_to(std::numbers::pi * 1e-6).epsilon(0.05));
    CHECK(deep.contact->cells_across_radius == close_to(1.0 / 0.24).epsilon(1e-6));
    CHECK(contact_warnings(*deep.contact).empty());
    CHECK(*deep.centre_m == close_to(1e-4).epsilon(1e-9));
    CHECK(deep.reaction_N[0].z() == close_to(deep.contact->normal_N).epsilon(1e-9));
    CHECK(deep.contact->force_N.rowwise().sum().z() == close_to(-deep.contact->normal_N).epsilon(1e-12));
    CHECK(deep.converged);

    const FemResult pushed = with("\"force_N\": " + number_text(deep.contact->normal_N));
    CHECK(pushed.contact->depth_m == close_to(1e-4).epsilon(1e-6));
    const FemResult rough = with(R"("depth_mm": 0.1, "friction": 0.5)");
    CHECK(rough.contact->normal_N > deep.contact->normal_N);  // the surface is held back
    CHECK(rough.contact->normal_N < 1.05 * deep.contact->normal_N);
    CHECK(with("\"friction\": 0.5, \"force_N\": " + number_text(rough.contact->normal_N)).contact->depth_m ==
          close_to(1e-4).epsilon(1e-6));
}

TEST_CASE("indenter: a rectangle that was too small grows until the contact is inside") {
    // soft bed under a thin layer: what lies on top says little of how deep the tool goes
    const std::string layered =
        R"([{"all": true, "material": "gel"}, {"box": {"min_mm": [0, 0, 30], "max_mm": [100, 100, 50]}, "material": "skin"}])";
    const FemResult r = solved(case_text(
        kSlab, "hex8-bbar", kClamped,
        R"([{"indenter": {"shape": "sphere", "radius_mm": 30, "centre_mm": [50, 50], "force_N": 0.1}}])",
        R"({"gel": {"young_Pa": 500, "poisson": 0.45}, "skin": {"young_Pa": 50000, "poisson": 0.45}})", layered));
    CHECK(r.contact->normal_N == close_to(0.1).epsilon(1e-8));
    CHECK(-r.contact->force_N.row(2).sum() == close_to(0.1).epsilon(1e-8));
    const FemResult bar = solved(
        case_text(kSlab, "hex8-bbar", kClamped,
                  R"([{"indenter": {"shape": "cylinder", "radius_mm": 20, "centre_mm": [50, 50], "depth_mm": 1}}])"));
    CHECK(bar.contact->over_edge);  // endless along y
    CHECK(bar.contact->normal_N > 0.0);
}

TEST_CASE("indenter: a quarter of a symmetric block is judged as the whole block is") {
    const auto pressed = [](double size_mm, int cells, double at_mm, const char* supports) {
        const std::string box = R"({"box": {"size_mm": [)" + number_text(size_mm) + ", " + number_text(size_mm) +
                                R"(, 50], "elements": [)" + std::to_string(cells) + ", " + std::to_string(cells) +
                                ", 7]}}";
        return solved(case_text(box, "hex8-bbar", supports,
                                R"([{"indenter": {"shape": "sphere", "radius_mm": 40, "depth_mm": 2, "centre_mm": [)" +
                                    number_text(at_mm) + ", " + number_text(at_mm) + "]}}]"));
    };
    const FemResult whole = pressed(100, 30, 50, R"([{"face": "zmin", "fix": "xyz"}])");
    const FemResult quarter = pressed(
        50, 15, 0, R"([{"face": "zmin", "fix": "xyz"}, {"face": "xmin", "fix": "x"}, {"face": "ymin", "fix": "y"}])");
    CHECK(quarter.contact->normal_N == close_to(0.25 * whole.contact->normal_N).epsilon(1e-6));
    CHECK(quarter.linear_ratio == close_to(whole.linear_ratio).epsilon(0.02));
}

TEST_CASE("indenter: supports beside it do not matter, supports under it are refused") {
    const auto with = [](double x_mm, const std::string& rest = "") {
        return case_text(kSlab, "hex8-bbar", R"([{"face": "zmin", "fix": "xyz"}, {"face": "xmin", "fix": "xyz"}])",
                         R"([{"indenter": {"shape": "sphere", "radius_mm": 40, "depth_mm": 2, "centre_mm": [)" +
                             number_text(x_mm) + ", 50]" + rest + "}}]");
    };
    const FemResult r = solved(with(25));  // the rectangle reaches the held border, the tool does not
    CHECK(r.contact->normal_N > 0.0);
    CHECK(r.reaction_N[0].z() + r.reaction_N[1].z() == close_to(r.contact->normal_N).epsilon(1e-9));
    CHECK(contains(said(with(5)), "loads.indenter.centre_mm: found a support under the tool, at x 0, y"));
    const std::string symmetric =
        R"([{"face": "zmin", "fix": "xyz"}, {"face": "xmin", "fix": "x"}, {"face": "ymin", "fix": "y"}])";
    const auto corner = [&](const char* friction) {
        return case_text(
            kSlab, "hex8-bbar", symmetric,
            R"([{"indenter": {"shape": "sphere", "radius_mm": 40, "depth_mm": 4, "centre_mm": [0, 0], "friction": )" +
                std::string(friction) + "}}]");
    };
    CHECK(contains(said(corner("0.3")), "or friction 0"));
    CHECK(solved(corner("0")).contact->normal_N > 0.0);
}

TEST_CASE(
    "indenter beside other loads: a block that rises by its support meets the tool as one that it sinks into deeper") {
    const std::string mesh =
        R"({"box": {"size_mm": [60, 60, 20], "elements": [12, 12, 5], "grading": {"centre_mm": [30, 30], "finest_mm": 1.5}}})";
    const auto pressed = [&](double raised_mm, double depth_mm, const std::string& friction) {
        const std::string support =
            "[{\"face\": \"zmin\", \"fix\": \"xy\"}, {\"face\": \"zmin\", \"fix\": \"z\", \"value_mm\": " +
            number_text(raised_mm) + "}]";
        const std::string tool =
            R"([{"indenter": {"shape": "sphere", "radius_mm": 8, "centre_mm": [30, 30], "depth_mm": )" +
            number_text(depth_mm) + friction + "}}]";
        return solved(case_text(mesh, "hex8-bbar", support, tool));
    };
    for (const char* friction : {"", ", \"friction\": 0.3"}) {
        CAPTURE(friction);
        const FemResult deeper = pressed(0.0, 1.5, friction);
        const FemResult risen = pressed(0.5, 1.0, friction);
        REQUIRE(deeper.contact);
        REQUIRE(risen.contact);
        CHECK(risen.contact->nodes == deeper.contact->nodes);
        // with friction the last halves of the way differ: sticking begins elsewhere
        CHECK(risen.contact->normal_N == close_to(deeper.contact->normal_N).epsilon(*friction == '\0' ? 1e-9 : 0.01));
    }
}

TEST_CASE("indenter beside other loads: where it touches, the surface has the tool's shape; nowhere it pulls") {
    const std::string mesh =
        R"({"box": {"size_mm": [60, 60, 20], "elements": [12, 12, 5], "grading": {"centre_mm": [30, 30], "finest_mm": 1.5}}})";
    const std::string tool =
        R"({"indenter": {"shape": "sphere", "radius_mm": 8, "centre_mm": [30, 30], "depth_mm": 1}})";
    const std::string pulled = "[{\"traction_Pa\": [0, 0, 60], \"face\": \"zmax\"}, " + tool + "]";
    const FemResult alone = solved(case_text(mesh, "hex8-bbar", kClamped, "[" + tool + "]"));
    const FemCase model = case_of(case_text(mesh, "hex8-bbar", kClamped, pulled));
    const FemResult r = solved(model);
    REQUIRE(r.contact);
    CHECK(r.contact->normal_N > 1.05 * alone.contact->normal_N);  // the pulled surface is higher
    CHECK(r.residual < 1e-9);
    int touching = 0;
    for (Eigen::Index node = 0; node < r.solution.u_m.cols(); ++node) {
        const Eigen::Vector3d x_m = model.problem.mesh.nodes_m.col(node);
        if (x_m.z() < 0.02 - 1e-12) continue;
        const double away_m = std::hypot(x_m.x() - 0.03, x_m.y() - 0.03);
        if (away_m >= 0.008) continue;
        const double tool_m = 0.02 - 0.001 + 0.008 - std::sqrt(0.008 * 0.008 - away_m * away_m);
        const double above_m = x_m.z() + r.solution.u_m(2, node) - tool_m;
        CHECK(above_m < 1e-10);
        const double pressing_N = -r.contact->force_N(2, node);
        CHECK(pressing_N >= 0.0);
        if (pressing_N <= 0.0) continue;
        ++touching;
        CHECK(std::abs(above_m) < 1e-10);
    }
    CHECK(touching == r.contact->nodes);
}

TEST_CASE("hard case 12: stiffness contrast 1e6, 1e8, and rigid beyond") {
    const auto with = [](double contrast) {
        return solved(case_text(
            kSlab, "hex8-bbar", kClamped, press_at(48, 50, 16),
            R"({"gel": {"young_Pa": 2500, "poisson": 0.45}, "ball": {"young_Pa": )" + number_text(2500 * contrast) +
                R"(, "poisson": 0.45}})",
            R"([{"all": true, "material": "gel"}, {"sphere": {"centre_mm": [50, 50, 30], "radius_mm": 12}, "material": "ball"}])"));
    };
    const FemResult soft = with(1e6);
    const FemResult stiff = with(1e8);
    const FemResult rigid = with(1e11);
    for (const FemResult* r : {&soft, &stiff, &rigid}) {
        CHECK(r->solution.backward_error < 1e-14);
        CHECK(r->converged);
        CHECK(r->reaction_N[0].z() == close_to(0.025).epsilon(1e-6));
    }
    const double size = rigid.max_displacement_m;
    CHECK((soft.solution.u_m - stiff.solution.u_m).cwiseAbs().maxCoeff() < 1e-5 * size);
    CHECK((soft.solution.u_m - rigid.solution.u_m).cwiseAbs().maxCoeff() < 1e-5 * size);
    CHECK((with(1e3).solution.u_m - rigid.solution.u_m).cwiseAbs().maxCoeff() > 1e-4 * size);  // 1000 is not rigid
    CHECK(rigid.von_mises_Pa.array().isNaN().count() > 0);
    CHECK(soft.von_mises_Pa.allFinite());
}

TEST_CASE("hard case 13: inverted and flat elements are refused by their number in the file") {
    const TemporaryFolder folder;
    const auto with = [&](const MshWritten& mesh, const std::string& element) {
        write_text_atomically(folder / "m.msh", msh_4(mesh, true));
        return said(case_text(R"({"file": "m.msh"})", element, R"([{"physical": "base", "fix": "xyz"}])",
                              R"([{"traction_Pa": 10, "physical": "top"}])"),
                    folder.path());
    };
    MshWritten good = row_of_cubes(3);
    CHECK(with(good, "hex8-bbar").empty());
    CHECK(contains(with(good, "tet4"), "m.msh: found 3 hexahedra and 0 tetrahedra, expected tetrahedra only"));
    MshWritten inverted = good;
    auto& cube = inverted.cells[7].nodes;
    REQUIRE(inverted.cells[7].type == 5);
    for (std::size_t k = 0; k < 4; ++k) std::swap(cube[k], cube[k + 4]);
    CHECK(contains(with(inverted, "hex8-bbar"), "m.msh: found inverted or flat elements 107 (1 in all)"));
    MshWritten flat = good;
    for (const std::size_t corner : {8u, 9u, 12u, 13u})
        flat.nodes[corner][2] = 0.0;  // the first cube's upper face, on its lower one
    CHECK(contains(with(flat, "hex8"), "inverted or flat elements"));
}

TEST_CASE("hard case 13: a sliver changes the answer by less than 1e-4") {
    // a tetrahedron with a node just above its base: three proper tets and, below them, a sliver of half the
    // stiffness
    const TemporaryFolder folder;
    const auto top_m = [&](double thickness_mm) {
        MshWritten mesh;
        mesh.nodes = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {10.0 / 3.0, 10.0 / 3.0, thickness_mm}};
        mesh.names = {{2, 1, "base"}, {3, 2, "gel"}, {3, 3, "film"}};
        mesh.cells = {{2, {1}, {0, 2, 1}},
                      {4, {2}, {0, 1, 4, 3}},
                      {4, {2}, {1, 2, 4, 3}},
                      {4, {2}, {2, 0, 4, 3}},
                      {4, {3}, {0, 1, 2, 4}}};
        write_text_atomically(folder / "m.msh", msh_2(mesh, false));
        const FemCase model = case_of(
            case_text(R"({"file": "m.msh"})", "tet4", R"([{"physical": "base", "fix": "xyz"}])",
                      R"([{"traction_Pa": [0, 0, -5], "face": "xmin"}])",
                      R"({"gel": {"young_Pa": 2500, "poisson": 0.45}, "film": {"young_Pa": 1250, "poisson": 0.45}})",
                      R"([{"physical": "gel", "material": "gel"}, {"physical": "film", "material": "film"}])"),
            folder.path());
        CHECK(model.report.slivers.empty() == (thickness_mm > 0.1));
        const FemResult r = solved(model);
        CHECK(r.converged);
        return r.solution.u_m(2, 3);
    };
    const double reference_m = top_m(1e-4);
    CHECK(reference_m < 0.0);
    for (const double thickness_mm : {1e-5, 1e-7, 1e-9}) {
        CAPTURE(thickness_mm);
        CHECK(top_m(thickness_mm) == close_to(reference_m).epsilon(1e-4));
    }
    CHECK(std::abs(top_m(1.0) / reference_m - 1.0) > 1e-3);
}

TEST_CASE("hard case 14: a floating body, or a missing support, is named and never moves wildly") {
    const auto held = [](const std::string& supports) {
        return said(case_text(kBlock, "hex8-bbar", supports, R"([{"traction_Pa": 10, "face": "zmax"}])"));
    };
    CHECK(contains(held("[]"), "c.json: supports: found part 1 of 1"));
    CHECK(contains(held("[]"), "free to move in 6 ways"));
    CHECK(contains(held(R"([{"face": "zmin", "fix": "z"}])"), "free to move in 3 ways"));
    CHECK(contains(held(R"([{"face": "zmin", "fix": "z"}, {"face": "xmin", "fix": "x"}])"), "translation y"));
    CHECK(held("[" + kRollers + "]").empty());

    // two cubes apart from each other, one of them held
    MshWritten apart = row_of_cubes(1);
    const MshWritten other = row_of_cubes(1);
    for (auto x : other.nodes) apart.nodes.push_back({x[0] + 50.0, x[1], x[2]});
    for (auto cell : other.cells) {
        if (cell.type != 5) continue;
        for (int& node : cell.nodes) node += 8;
        apart.cells.push_back(cell);
    }
    const TemporaryFolder folder;
    write_text_atomically(folder / "m.msh", msh_2(apart, true));
    const std::string message =
        said(case_text(R"({"file": "m.msh"})", "hex8", R"([{"physical": "base", "fix": "xyz"}])", "[]"), folder.path());
    CHECK(contains(message, "part 2 of 2"));
    CHECK(contains(message, "x 50..60"));
}

TEST_CASE("hard case 15: nu near 0.5 does not lock, and 0.5 is refused") {
    const auto error = [](double poisson) {
        return *quarter(10, 7, 2.5, 400, poisson).skel_m /
                   mechanics::layer_mean_depression_m({2500.0, poisson, 0.05}, {}) -
               1.0;
    };
    CHECK(std::abs(error(0.4999) - error(0.3)) < 0.01);
    for (const double poisson : {0.5, 0.51, -1.0, 7.0, 0.49999999999999994, -0.99999999999999999}) {
        CHECK(contains(said(case_text(kBlock, "hex8-bbar", kClamped, "[]", gel(2500, poisson))),
                       "c.json: materials.gel.poisson: found"));
    }
    for (const double young_Pa : {0.0, -3.0, 1e300}) {
        CHECK(contains(said(case_text(kBlock, "hex8-bbar", kClamped, "[]", gel(young_Pa, 0.4))),
                       "c.json: materials.gel.young_Pa: found"));
    }
}

TEST_CASE(
    "hard case 19: the load's total holds for any disc, smaller than a face, on an edge, on a corner, over "
    "the border") {
    const auto pushed = [](double x_mm, double y_mm, double diameter_mm) {
        return solved(case_text(kSlab, "hex8-bbar", kClamped, press_at(x_mm, y_mm, diameter_mm)));
    };
    constexpr std::uint32_t kSeed = 19;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> place(20.0, 80.0);
    for (int i = 0; i < 3; ++i) {
        const FemResult r = pushed(place(random), place(random), i == 0 ? 0.1 : 12.0);
        CHECK(r.reaction_N[0].z() == close_to(0.025).epsilon(1e-10));
        CHECK_FALSE(r.partial);
    }
    CHECK(pushed(50, 50, 0.5).reaction_N[0].z() == close_to(0.025).epsilon(1e-10));  // on a node
    CHECK(pushed(50, 43.3, 0.5).applied_N == close_to(0.025).epsilon(1e-10));        // on an edge
    const FemResult half = pushed(0, 50, 16);
    CHECK(half.partial);
    CHECK(half.applied_N == close_to(0.0125).epsilon(1e-10));
    CHECK(half.reaction_N[0].z() == close_to(0.0125).epsilon(1e-10));
    CHECK(contains(said(case_text(kSlab, "hex8-bbar", kClamped, press_at(-9, 50, 16))),
                   "centre_mm: found a disc beside the body"));
    CHECK(contains(said(case_text(kSlab, "hex8-bbar", kClamped, press_at(50, 50, 1e6))),
                   "diameter_mm: found a disc of which "));
    CHECK_THROWS_WITH(solved(case_text(kSlab, "hex8-bbar", kClamped, press_at(50, 50, 16, 1e300), gel(1e-6, 0.45))),
                      doctest::Contains("the displacement is not finite"));
}

TEST_CASE("case: mechanics does not depend on how the mesh came: box or file, either version, either encoding") {
    const TemporaryFolder folder;
    const std::string loads = R"([{"traction_Pa": 10, "face": "zmax"}])";
    const FemResult box =
        solved(case_text(R"({"box": {"size_mm": [30, 10, 10], "elements": [3, 1, 1]}})", "hex8-bbar", kClamped, loads));
    for (const std::string& bytes : all_encodings(row_of_cubes(3))) {
        write_text_atomically(folder / "m.msh", bytes);
        const FemResult file =
            solved(case_text(R"({"file": "m.msh"})", "hex8-bbar", R"([{"physical": "base", "fix": "xyz"}])",
                             R"([{"traction_Pa": 10, "physical": "top"}])"),
                   folder.path());
        CHECK((file.solution.u_m - box.solution.u_m).cwiseAbs().maxCoeff() < 1e-14);
        CHECK(file.reaction_N[0].z() == close_to(box.reaction_N[0].z()).epsilon(1e-12));
        const FemCase hard = case_of(
            case_text(R"({"file": "m.msh"})", "hex8-bbar", R"([{"physical": "base", "fix": "xyz"}])", "[]",
                      R"({"gel": {"young_Pa": 2500, "poisson": 0.45}, "b": {"young_Pa": 9000, "poisson": 0.45}})",
                      R"([{"physical": "gel", "material": "gel"}, {"physical": "hard", "material": "b"}])"),
            folder.path());
        CHECK(hard.problem.mesh.region == Eigen::Vector3i(0, 0, 1));
    }
}

TEST_CASE("case: far out of the linear range the gauge is red") {
    const FemResult r =
        solved(case_text(kSlab, "hex8-bbar", kClamped, press_at(50, 50, 16, 2.5)));  // the paper's force
    CHECK(r.linear == mechanics::LinearRange::red);
    CHECK(*r.centre_m > 0.05);  // more than the slab is thick
}

TEST_CASE("case: every bad file is refused with the words of its first line") {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PALPA_SOURCE_DIR "/tests/fem/bad_cases")) {
        if (entry.path().extension() != ".json") continue;
        ++files;
        const std::string text = read_text(entry.path());
        REQUIRE(text.substr(0, 9) == "// says: ");
        const std::string expected = text.substr(9, text.find('\n') - 9);
        const std::string message = message_of([&] { solved(read_case(entry.path())); });
        CAPTURE(entry.path().filename().string());
        CAPTURE(message);
        CHECK(contains(message, expected));
        CHECK(contains(message, "bad_cases/"));
        CHECK((contains(message, "expected") || contains(message, "cannot be read")));
    }
    CHECK(files > 30);
}

TEST_CASE("hard case 31: random damage to a case file ends in an answer or a refusal") {
    constexpr std::uint32_t kSeed = 8;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    const std::string good = case_text(R"({"box": {"size_mm": [20, 30, 10], "elements": [2, 2, 2]}})", "tet4", kClamped,
                                       press_at(10, 10, 8));
    REQUIRE(said(good).empty());
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::string bytes = good;
        for (int k = 0; k < 2; ++k) bytes[random() % bytes.size()] = static_cast<char>(' ' + random() % 90);
        try {
            const FemResult r = solved(bytes);
            CHECK(r.solution.u_m.allFinite());
        } catch (const InputError&) {
            ++refused;
        } catch (const std::runtime_error& error) {
            CHECK(contains(error.what(), "not finite"));
        }
    }
    CHECK(refused > 200);
}
