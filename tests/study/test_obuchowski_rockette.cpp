#include <cmath>
#include <doctest/doctest.h>

#include "files/distributions.h"
#include "study/obuchowski_rockette.h"
#include "tests/close_to.h"
#include "tests/study/froc_sets.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

MeritTable table_of(const FreeResponse& data, Merit merit) {
    MeritTable table{data.conditions.size(), data.participants.size(), {}, {}};
    for (std::size_t i = 0; i < table.conditions; ++i) {
        for (std::size_t j = 0; j < table.participants; ++j) {
            const MeritFigure figure = merit_of(data, i, j, merit);
            table.theta.push_back(figure.all);
            table.without.push_back(figure.without);
        }
    }
    return table;
}

}  // namespace

TEST_CASE("Obuchowski-Rockette: components and tests of the stored sets") {
    for (const char* name : {"froc_small.json", "froc_big.json"}) {
        CAPTURE(name);
        const auto json = froc_json(name);
        const auto& stored = json["OR"];
        const MeritTest test = test_merits(table_of(froc_set(json), Merit::wafroc), 0.95);
        const auto near = [&](double value, const char* key) {
            CAPTURE(key);
            CHECK(std::abs(value - stored[key].get<double>()) < 1e-9);
        };
        near(test.components.var, "Var");
        near(test.components.cov1, "Cov1");
        near(test.components.cov2, "Cov2");
        near(test.components.cov3, "Cov3");
        near(test.components.ms_t, "msT");
        near(test.components.ms_tr, "msTR");
        near(test.f, "F");
        near(test.ddf, "ddf");
        REQUIRE(test.pairs.size() == 1);
        near(test.pairs[0].se, "se_diff");
        for (std::size_t i = 0; i < 2; ++i) {
            CHECK(std::abs(test.conditions[i].mean - stored["single"][i][0].get<double>()) < 1e-9);
            CHECK(std::abs(test.conditions[i].se - stored["single"][i][1].get<double>()) < 1e-9);
            CHECK(std::abs(test.conditions[i].df - stored["single"][i][2].get<double>()) < 1e-9);
        }
        // of two conditions t is the root of F, and the interval holds 0 where p is above 0.05
        CHECK(test.pairs[0].t * test.pairs[0].t == close_to(test.f).epsilon(1e-12));
        CHECK(test.pairs[0].p == close_to(test.p).epsilon(1e-9));
        CHECK((test.pairs[0].ci.low < 0.0 && test.pairs[0].ci.high > 0.0) == (test.p > 0.05));
        CHECK(test.status.empty());
    }
}

TEST_CASE("Obuchowski-Rockette: what cannot be computed says why") {
    MeritTable table{2, 1, {0.5, 0.6}, {{0.5, 0.4}, {0.6, 0.7}}};
    CHECK(test_merits(table, 0.95).status.find("fewer than two participants") != std::string::npos);
    table = {1, 2, {0.5, 0.6}, {{0.5, 0.4}, {0.6, 0.7}}};
    CHECK(test_merits(table, 0.95).status.find("one condition only") != std::string::npos);
    CHECK(std::isfinite(test_merits(table, 0.95).conditions[0].se));
    table = {2, 2, {1.0, 1.0, 1.0, 1.0}, {{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}};
    const MeritTest same = test_merits(table, 0.95);
    CHECK(same.status.find("vary neither") != std::string::npos);
    CHECK(std::isnan(same.pairs[0].p));
    table.without[2][1] = std::nan("");
    CHECK(test_merits(table, 0.95).status.find("jackknife") != std::string::npos);
    table.theta[0] = std::nan("");
    CHECK(test_merits(table, 0.95).status.find("not there") != std::string::npos);
}

TEST_CASE("Obuchowski-Rockette: people who differ alike under all conditions leave infinite degrees of freedom") {
    const MeritTable table{2, 2, {0.5, 0.6, 0.7, 0.8}, {{0.5, 0.4}, {0.6, 0.5}, {0.7, 0.8}, {0.8, 0.9}}};
    const MeritTest test = test_merits(table, 0.95);
    CHECK(std::isinf(test.ddf));
    CHECK(test.p == close_to(palpa::files::chi_squared_p(test.f, 1.0)));
}
