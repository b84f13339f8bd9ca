#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "study/read_logs.h"
#include "study/stiffer_counts.h"
#include "study/trial_log.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

const std::string kStifferHead = "condition\treference_kPa\tcomparison_kPa\tstiffer\tn\n";

Observations stiffer_counts(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "counts.tsv", text);
    return read_counts(folder / "counts.tsv");
}

std::string refusal_of_stiffer(const std::string& rows) {
    return message_of([&] { stiffer_counts(kStifferHead + rows); });
}

// A study's log with one choice, written as the app writes it.
Observations logged(const ChoiceRow& row) {
    const TemporaryFolder folder;
    ChoiceLog log(next_run(folder.path(), "01", "softer"));
    REQUIRE(log.write(row));
    return read_study(folder.path());
}

}  // namespace

TEST_CASE("stiffer counts: a table gives levels of ln(comparison/reference)") {
    const Observations seen = stiffer_counts(
        "condition\tparticipant\treference_kPa\tcomparison_kPa\tstiffer\tn\n"
        "pen\tp1\t1.75\t3.5\t9\t10\npen\tp2\t1.75\t0.875\t1\t10\nhand\tn/a\t2\t3\t7\t7\nhand\tn/a\t3\t2\t0\t5\n");
    REQUIRE(seen.stiffer.size() == 4);
    CHECK(seen.stiffer[0].x == close_to(std::log(2.0)));
    CHECK(seen.stiffer[1].x == close_to(-std::log(2.0)));
    CHECK(seen.stiffer[1].participant == 1);
    CHECK(seen.stiffer[2].participant == -1);
    CHECK(seen.stiffer[2].axis == StiffnessAxis::comparison_reference);
    CHECK(seen.stiffer[0].stiffer == 9);
}

TEST_CASE("stiffer counts: stiffer > n is refused with line and column") {
    CHECK(
        contains(refusal_of_stiffer("pen\t1.75\t2\t11\t10\n"), "line 2, stiffer: found '11', expected at most n = 10"));
    CHECK(contains(refusal_of_stiffer("pen\t1.75\t2\t10\t10\npen\t1.75\t3\t1\t0\n"), "line 3, n: found '0'"));
}

TEST_CASE("stiffer counts: what is wrong is named with line and column") {
    for (const std::string bad : {"nan", "n/a", "inf", "0", "-1", "soft"}) {
        CAPTURE(bad);
        CHECK(
            contains(refusal_of_stiffer("pen\t" + bad + "\t2\t1\t10\n"), "line 2, reference_kPa: found '" + bad + "'"));
        CHECK(contains(refusal_of_stiffer("pen\t2\t" + bad + "\t1\t10\n"),
                       "line 2, comparison_kPa: found '" + bad + "'"));
    }
    CHECK(contains(refusal_of_stiffer("pen\t1\t2\t1\t0\n"), "line 2, n: found '0'"));
    CHECK(contains(refusal_of_stiffer("pen\t1\t2\t1.5\t4\n"), "line 2, stiffer: found '1.5'"));
    CHECK(contains(refusal_of_stiffer("pen\t1\t2\t1\t4\npen\t1\t2\t1\t4\n"),
                   "line 3, condition: found 'pen', expected it once"));
    CHECK(contains(refusal_of_stiffer("pen\t1\t2\t1\t4\npen\t2\t4\t1\t4\n"), "condition 'pen': found one level only"));
    CHECK(contains(refusal_of_stiffer("\t1\t2\t1\t4\n"), "condition: found '', expected a name"));
    CHECK(contains(refusal_of_stiffer(""), "no rows"));
    CHECK(contains(message_of([&] { stiffer_counts("condition\tstiffer\tn\tcolour\n"); }), "the column 'colour'"));
    CHECK(
        contains(message_of([&] { stiffer_counts("condition\tstiffer\tn\n"); }), "expected a column 'reference_kPa'"));
}

TEST_CASE("stiffer counts: names that are none, and answers that would count twice, are refused") {
    const std::string head = "condition\tparticipant\treference_kPa\tcomparison_kPa\tstiffer\tn\n";
    const auto refusal = [&](const std::string& rows) { return message_of([&] { stiffer_counts(head + rows); }); };
    CHECK(
        contains(refusal("pen\tp1\t1\t2\t3\t4\npen\tn/a\t2\t1\t1\t4\n"),
                 "line 3, participant: found 'n/a', expected rows of participants or rows for all of them, not both"));
    CHECK(contains(refusal("pen\tp1\t1\t2\t3\t4\npen\tTotal\t1\t2\t3\t4\n"), "line 3, participant: found 'Total'"));
    CHECK(contains(refusal("pen\tp1\t1\t2\t3\t4\nsum\tp1\t1\t2\t3\t4\n"), "condition: found 'sum' beside"));
    CHECK(contains(refusal("NA\tp1\t1\t2\t3\t4\n"), "line 2, condition: found 'NA'"));
    CHECK(contains(refusal("pen\tnull\t1\t2\t3\t4\n"), "line 2, participant: found 'null'"));
}

TEST_CASE("stiffer counts: a log tells the order, and where the reference stayed") {
    ChoiceRow row;
    row.condition = "on";
    row.reference_kPa = 1.0;
    row.comparison_kPa = 2.0;
    const double x = std::log(2.0);
    struct Case {
        const char *first, *answer, *reference_on;  // the answer is the softer one
        double x;
        int stiffer;
    };
    for (const Case& one :
         {Case{"reference", "reference", "n/a", x, 1}, Case{"reference", "comparison", "n/a", x, 0},
          Case{"comparison", "reference", "n/a", -x, 0}, Case{"comparison", "comparison", "n/a", -x, 1},
          Case{"reference", "reference", "off", x, 1}, Case{"comparison", "reference", "off", x, 1},
          Case{"comparison", "comparison", "off", x, 0}}) {
        CAPTURE(one.first);
        CAPTURE(one.answer);
        CAPTURE(one.reference_on);
        row.first = one.first;
        row.answer = one.answer;
        row.reference_on = one.reference_on;
        row.correct = row.answer == "reference" ? 1 : 0;
        const Observations seen = logged(row);
        REQUIRE(seen.stiffer.size() == 1);
        CHECK(seen.stiffer[0].x == close_to(one.x));
        CHECK(seen.stiffer[0].stiffer == one.stiffer);
        const bool stays = std::string(one.reference_on) != "n/a";
        CHECK(seen.stiffer[0].axis == (stays ? StiffnessAxis::comparison_reference : StiffnessAxis::second_first));
    }
    row.reference_kPa = std::nan("");
    CHECK(contains(message_of([&] { logged(row); }), "reference_kPa: found 'n/a', expected a stiffness in kPa"));
    row.reference_kPa = 1.0;
    row.answer = "both";
    CHECK(contains(message_of([&] { logged(row); }), "answer: found 'both', expected reference or comparison"));
}

TEST_CASE("stiffer counts: practice is left out") {
    ChoiceRow row;
    row.condition = "on";
    row.reference_kPa = 1.0;
    row.comparison_kPa = 2.0;
    row.correct = 1;
    row.block = "practice";
    const TemporaryFolder folder;
    ChoiceLog log(next_run(folder.path(), "01", "softer"));
    REQUIRE(log.write(row));
    row.block = "test";
    row.trial = 2;
    REQUIRE(log.write(row));
    CHECK(read_study(folder.path()).stiffer.size() == 1);
}
