#include <cmath>
#include <doctest/doctest.h>

#include "files/table.h"
#include "study/observations.h"
#include "study/report.h"
#include "tests/error_message.h"

using namespace palpa::study;
using namespace palpa::test;
using palpa::files::Json;

namespace {

Observations observed_answers(const char* name) {
    palpa::files::Table table = palpa::files::read_csv(std::string(PALPA_RECORDINGS) + "/statistics/" + name);
    Observations seen;
    while (table.next()) {
        const auto of = [&](const char* column) { return std::string(table.field(table.column(column))); };
        const bool hit = of("y") == "1";
        seen.rows.push_back({index_of("c" + of("c"), seen.conditions), index_of("p" + of("p"), seen.participants),
                             index_of("l" + of("l"), seen.nodules), 0, hit, !hit, 0});
    }
    return seen;
}

Json mixed_of(const Observations& seen) {
    Json json;
    add_mixed(mixed_report(seen, 0.95), json);
    return json.is_null() ? Json() : json["mixed_logistic"];
}

}  // namespace

TEST_CASE("mixed report: likelihood-ratio test, odds ratio and sensitivity of stored answers") {
    const Json json = mixed_of(observed_answers("glmm1.csv"));
    CHECK(json["status"] == "computed");
    CHECK(std::abs(json["test"]["likelihood_ratio"].get<double>() - 6.08629) < 1e-4);
    CHECK(std::abs(json["test"]["p"].get<double>() - .013623) < 1e-5);
    REQUIRE(json["pairs"].size() == 1);
    CHECK(std::abs(std::log(json["pairs"][0]["odds_ratio"].get<double>()) + .88374) < 1e-4);
    CHECK(json["pairs"][0]["p"] == json["test"]["p"]);
    const double z = 1.959963984540054;
    CHECK(std::abs(std::log(json["pairs"][0]["ci"][0].get<double>()) - (-.88374 - z * .36708)) < 5e-4);
    CHECK(json["conditions"][1]["sensitivity"].get<double>() > json["conditions"][0]["sensitivity"].get<double>());
    CHECK(json["notes"].empty());
    CHECK(json["prior_sd"].is_null());
}

TEST_CASE("mixed report: it needs names, several nodules, and a study that is not too large") {
    Observations seen = observed_answers("glmm2.csv");
    CHECK(contains(lme4_script(mixed_report(seen, 0.95)), "glmer(cbind(found, missed)"));
    seen.rows[0].participant = -1;
    const Json unnamed = mixed_of(seen);
    CHECK(unnamed["status"] == "cannot be computed, because the participant of 1 of " +
                                   std::to_string(seen.rows.size()) + " hits and misses is not known");
    CHECK(unnamed["participants"].is_null());
    CHECK(lme4_script(mixed_report(seen, 0.95)).empty());
    CHECK(mixed_of({}).is_null());
    seen = observed_answers("glmm2.csv");
    for (Observation& row : seen.rows) row.nodule = 0;
    CHECK(contains(mixed_of(seen)["status"].get<std::string>(), "one nodule only"));
    seen = observed_answers("glmm2.csv");
    for (Observation& row : seen.rows) row.nodule %= 3;
    CHECK(contains(mixed_of(seen)["notes"][0].get<std::string>(), "3 nodules"));
    seen.conditions.resize(2);
    for (int c = 2; c < 122; ++c) {
        seen.conditions.push_back("c" + std::to_string(c));
        seen.rows.push_back({c, 0, 0, 0, 1, 0, 0});
    }
    CHECK(contains(mixed_of(seen)["status"].get<std::string>(), "so many conditions"));
}

TEST_CASE("mixed report: a condition under which everything was found says that a prior is there") {
    Observations seen = observed_answers("glmm1.csv");
    for (Observation& row : seen.rows) {
        if (row.condition == 1) row.tp = 1, row.fn = 0;
    }
    const Json json = mixed_of(seen);
    CHECK(json["prior_sd"] == 3.0);
    CHECK(contains(json["notes"][0].get<std::string>(), "Separation"));
    CHECK(json["pairs"][0]["p"].get<double>() < 1e-4);
}
