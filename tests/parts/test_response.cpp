#include <doctest/doctest.h>

#include "parts/response.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

Json slender() {
    Json json = small_part();
    json["size_mm"] = {20, 2, 2};
    json["loads"]["patch"]["at_mm"] = {16, 1, 2};
    return json;
}

double named_compliance(const Response& response) { return response.compliance_m_per_N[response.named]; }

}  // namespace

TEST_CASE("response: at the named load each method gives what evaluate gives") {
    const Part part = parsed(slender());
    for (const PartLoad& load : part.loads) {
        for (const Method method : {Method::paper, Method::euler_bernoulli, Method::timoshenko, Method::voxels}) {
            CAPTURE(name_of(method));
            CAPTURE(load.name);
            const Response response = response_of(part, load, {method, {}, 1e-8, {0, 2}});
            const MethodResult result = stiffness_of(part, load, {{method}, {}, 1e-8}).front();
            CHECK(named_compliance(response) == close_to(result.displacement_m / load.force_N).epsilon(1e-6));
            CHECK(response.converged);
        }
    }
}

TEST_CASE("response: it grows along the axis, and between stations its error is what it says") {
    const Part part = parsed(slender());
    const PartLoad& tip = part.loads[0];
    const Response cells = response_of(part, tip, {Method::voxels, {}, 1e-8, {0, 2}});
    for (std::size_t i = 1; i < cells.station_m.size(); ++i)
        CHECK(cells.compliance_m_per_N[i] > cells.compliance_m_per_N[i - 1]);
    CHECK(cells.interpolation_error < 0.05);
    // a load half way between two stations, solved
    PartLoad between = part.loads[1];
    between.at_m[0] = 0.5 * (cells.station_m[9] + cells.station_m[10]);
    const double solved = stiffness_of(part, between, {{Method::voxels}, {}, 1e-8}).front().displacement_m;
    const double found = compliance_at(cells, place_of(cells, between.at_m[0]));
    CHECK(std::abs(found / (solved / between.force_N) - 1.0) < 0.05);
    const Response beam = response_of(part, tip, {Method::timoshenko, {}, 1e-8, {0, 2}});
    CHECK(beam.interpolation_error < 5e-3);
    CHECK(compliance_at(beam, place_of(beam, 12e-3)) ==
          close_to(compliance_at(cells, place_of(cells, 12e-3))).epsilon(0.05));
}

TEST_CASE("response: a part that is pressed at its very end is as soft as there") {
    const Part part = parsed(slender());
    PartLoad end = part.loads[1];
    end.at_m[0] = 19.75e-3;  // of 20 mm, in voxels of 0.5 mm
    for (const Method method : {Method::timoshenko, Method::voxels}) {
        CAPTURE(name_of(method));
        const Response response = response_of(part, part.loads[1], {method, {}, 1e-8, {0, 2}});
        const double solved_m = stiffness_of(part, end, {{method}, {}, 1e-8}).front().displacement_m;
        CHECK(compliance_at(response, place_of(response, end.at_m[0])) ==
              close_to(solved_m / end.force_N).epsilon(1e-6));
    }
}

TEST_CASE("response: the picture moves with the load, and its middle at the load is the compliance") {
    const Part part = parsed(slender());
    for (const Method method : {Method::timoshenko, Method::voxels}) {
        const Response response = response_of(part, part.loads[1], {method, {}, 1e-8, {0, 2}});
        const StationPlace place{response.named == 0 ? 0 : response.named - 1, response.named == 0 ? 0.0 : 1.0};
        const auto moved = field_at(response, place, 16e-3, 1e-3);
        CHECK(moved[1] == close_to(-named_compliance(response)).epsilon(0.1));
        CHECK(std::abs(field_at(response, place, 0.0, 1e-3)[1]) < 1e-9);
    }
}

TEST_CASE("response: a part that is no beam answers at its own load only, and beams refuse it by name") {
    Json json = slender();
    json.erase("axis");
    const Part part = parsed(json);
    const Response response = response_of(part, part.loads[1], {Method::voxels, {}, 1e-6, {0, 2}});
    CHECK(response.station_m.size() == 1);
    CHECK(compliance_at(response, place_of(response, 0.003)) == named_compliance(response));
    const auto refused = [&](Method method) {
        return message_of([&] { response_of(part, part.loads[1], {method, {}, 1e-6, {0, 2}}); });
    };
    CHECK(contains(refused(Method::timoshenko), "no axis"));
    CHECK(contains(refused(Method::elastica), "one of paper"));
}

TEST_CASE("response: up to where it says so its method applies, and not beyond") {
    const Part part = parsed(slender());
    for (const Method method : {Method::euler_bernoulli, Method::timoshenko, Method::voxels}) {
        CAPTURE(name_of(method));
        const PartLoad& tip = part.loads[0];
        const Response response = response_of(part, tip, {method, {}, 1e-6, {0, 2}});
        REQUIRE(response.validity.to_m > 0.0);
        CHECK(applies_to_m(response, place_of(response, response.station_m[response.named])) ==
              close_to(response.validity.to_m));
        const auto why_not_at = [&](double share) {
            PartLoad load = tip;
            load.force_N = share * response.validity.to_m / named_compliance(response);
            return stiffness_of(part, load, {{method}, {}, 1e-6}).front().why_not;
        };
        CHECK(why_not_at(0.99) == "");
        CHECK(why_not_at(1.02) != "");
    }
    const Response paper = response_of(part, part.loads[0], {Method::paper, {}, 1e-6, {0, 2}});
    CHECK(paper.validity.to_m == 0.0);
    CHECK(contains(paper.validity.why_not, "2/3 of a beam's stiffness"));
}

TEST_CASE("response: half way to the clamp a beam applies about half as far") {
    const Part part = parsed(slender());
    const Response beam = response_of(part, part.loads[0], {Method::euler_bernoulli, {}, 1e-6, {0, 2}});
    const double half_m = 0.5 * beam.station_m[beam.named];
    CHECK(applies_to_m(beam, place_of(beam, half_m)) == close_to(0.5 * beam.validity.to_m).epsilon(0.15));
}

TEST_CASE("response: it comes back from the cache as it was, and not from a damaged one") {
    const TemporaryFolder folder;
    const Part part = parsed(slender());
    const Response response = response_of(part, part.loads[0], {Method::voxels, {}, 1e-6, {0, 2}});
    CHECK(write_response(folder / "c", 7, response).empty());
    const auto again = read_response(folder / "c", 7);
    REQUIRE(again);
    CHECK(again->compliance_m_per_N == response.compliance_m_per_N);
    CHECK(again->field == response.field);
    CHECK(again->named == response.named);
    CHECK(again->validity.to_m == response.validity.to_m);
    CHECK(again->validity.why_not == response.validity.why_not);
    CHECK(response.validity.why_not != "");
    CHECK_FALSE(read_response(folder / "c", 8));
}
