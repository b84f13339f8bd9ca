#include <cmath>
#include <doctest/doctest.h>

#include "study/observations.h"
#include "study/power.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

PowerRow row(double effect, int participants, double p, double estimate, double low, double high) {
    return {effect, 1.0, participants, {"sensitivity", "a", "b", "t", "", p, estimate, {low, high}}};
}

const PowerResult& of(const std::vector<PowerResult>& results, double effect, int participants) {
    for (const PowerResult& one : results) {
        if (one.effect == effect && one.participants == participants) return one;
    }
    FAIL("no such result");
    return results.front();
}

}  // namespace

TEST_CASE("power: rejections and coverage are counted by effect and number of participants, with their errors") {
    const std::vector<PowerRow> rows{row(0.0, 5, 0.04, 0.1, 0.01, 0.2), row(0.0, 5, 0.2, -0.1, -0.3, 0.1),
                                     row(1.0, 5, 0.3, 0.4, -0.1, 0.45), row(1.0, 5, kNone, kNone, kNone, kNone),
                                     row(1.0, 9, 0.01, 0.5, 0.45, 0.6), row(1.0, 9, 0.02, 0.3, 0.1, 0.39)};
    const std::vector<PowerResult> results = summarise_power(rows, 2, 0.05);
    REQUIRE(results.size() == 3);
    const PowerResult& null = of(results, 0.0, 5);
    CHECK(null.rejections.hits == 1);
    CHECK(null.rejections.n == 2);
    CHECK(null.rejections.standard_error() == close_to(std::sqrt(0.125)));
    CHECK(null.rejections.interval().low > 0.0);
    CHECK(null.truth == 0.0);  // exactly: no condition differs
    CHECK(null.truth_se == 0.0);
    CHECK(null.coverage.hits == 1);
    // the true value is the mean of the largest studies, 0.4
    const PowerResult& few = of(results, 1.0, 5);
    CHECK(few.truth == close_to(0.4));
    CHECK(few.truth_se == close_to(0.1));
    CHECK(few.rejections.hits == 0);
    CHECK(few.rejections.n == 2);  // a test that cannot be computed does not reject
    CHECK(few.tested == 1);
    CHECK(null.tested == 2);
    CHECK(few.coverage.n == 1);
    CHECK(few.coverage.hits == 1);
    const PowerResult& many = of(results, 1.0, 9);
    CHECK(many.rejections.rate() == 1.0);
    CHECK(many.coverage.hits == 0);
}

TEST_CASE("power: the true value is that of all studies, also for a method that has an interval in some of them") {
    std::vector<PowerRow> rows;
    for (const double estimate : {1.0, 1.0, 0.4}) {
        rows.push_back(
            {1.0, 1.0, 5, {"ppv", "a", "", "Wilson", "", kNone, estimate, {estimate - 0.1, estimate + 0.1}}});
        if (estimate < 1.0)
            rows.push_back({1.0, 1.0, 5, {"ppv", "a", "", "bootstrap", "", kNone, estimate, {0.3, 0.5}}});
    }
    for (const PowerResult& one : summarise_power(rows, 3, 0.05)) {
        CAPTURE(one.what.method);
        CHECK(one.truth == close_to(0.8));
        CHECK(one.coverage.hits == 0);  // no interval holds 0.8
    }
}

TEST_CASE("power: results are sorted, whichever study has a finding first") {
    const auto results = summarise_power(
        {row(1.0, 5, 0.2, 0.1, 0.0, 0.2), row(0.0, 9, 0.2, 0.1, 0.0, 0.2), row(0.0, 5, 0.2, 0.1, 0.0, 0.2)}, 1, 0.05);
    REQUIRE(results.size() == 3);
    CHECK(results[0].participants == 5);
    CHECK(results[1].participants == 9);
    CHECK(results[2].effect == 1.0);
}

TEST_CASE("power: a label of one study stands by the row, whichever study comes first") {
    PowerRow labelled = row(0.0, 5, 0.2, 0.1, 0.0, 0.2);
    labelled.finding.label = "ignores clustering";
    CHECK(summarise_power({row(0.0, 5, 0.2, 0.1, 0.0, 0.2), labelled}, 2, 0.05)[0].what.label == "ignores clustering");
}

TEST_CASE("power: log odds have no true value where there is an effect") {
    PowerRow one = row(1.0, 5, 0.01, 0.5, 0.1, 0.9);
    one.finding.quantity = "log odds";
    const std::vector<PowerResult> results = summarise_power({one}, 1, 0.05);
    CHECK(std::isnan(results[0].truth));
    CHECK(results[0].coverage.n == 0);
    one.effect = 0.0;
    CHECK(summarise_power({one}, 1, 0.05)[0].truth == 0.0);
}

TEST_CASE("power: findings of a report are those of its tables, and the table explains its columns") {
    const Observations seen = read_counts(PALPA_SOURCE_DIR "/assets/counts/paper.tsv");
    const Report report = make_report(seen, {});
    const std::vector<Finding> findings = findings_of(report);
    int replication = 0, wilson_shares = 0;
    for (const Finding& one : findings) {
        if (one.method == "Li et al." && one.quantity == "sensitivity") ++replication;
        if (one.method == "Wilson" && one.quantity == "sensitivity") {
            ++wilson_shares;
            CHECK(one.ci.low < one.estimate);
        }
    }
    CHECK(replication == 10);
    CHECK(wilson_shares == 5);
    const ReportTable table = power_table(summarise_power({row(1.0, 5, 0.01, 0.5, 0.1, 0.9)}, 1, 0.05));
    CHECK(table.columns.size() == power_dictionary().size());
    for (const auto& cells : table.rows) CHECK(cells.size() == table.columns.size());
}
