#include <doctest/doctest.h>

#include "files/text.h"
#include "study/observations.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

Observations counts(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "counts.tsv", text);
    return read_counts(folder / "counts.tsv");
}

std::string refusal_of_counts(const std::string& text) {
    return message_of([&] { counts(text); });
}

}  // namespace

TEST_CASE("observations: counts by condition, nodule and participant") {
    const Observations seen = counts(
        "condition\tparticipant\tnodule\ttp\tfn\tfp\npen\tp1\tA\t1\t0\tn/a\npen\tp1\tn/"
        "a\t0\t0\t2\r\nhand\tp2\tB\t0\t1\tn/a\n");
    CHECK(seen.conditions == std::vector<std::string>{"pen", "hand"});
    CHECK(seen.participants == std::vector<std::string>{"p1", "p2"});
    CHECK(seen.nodules == std::vector<std::string>{"A", "B"});
    REQUIRE(seen.rows.size() == 3);
    CHECK(seen.rows[1].nodule == -1);
    CHECK(seen.rows[1].fp == 2);
    CHECK(seen.rows[2].participant == 1);
}

TEST_CASE("observations: forced choices") {
    const Observations seen = counts("condition\tcorrect\tn\tcomparison\non\t8\t10\t2.0 kPa\non\t5\t10\t1.875 kPa\n");
    REQUIRE(seen.choices.size() == 2);
    CHECK(seen.choices[1].comparison == 1);
    CHECK(seen.choices[0].correct == 8);
}

TEST_CASE("observations: bad counts are refused with line and column") {
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\n"),
                   "line 1: found the columns 'condition' 'tp' 'fn', expected a column 'fp'"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\ttn\n"), "the column 'tn'"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\n"), "no rows"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\npen\t-1\t0\t0\n"),
                   "line 2, tp: found '-1', expected a whole number"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\npen\t1.5\t0\t0\n"), "line 2, tp: found '1.5'"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\npen\t1\t0\tn/a\n"), "line 2, fp: found 'n/a'"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\n\t1\t0\t0\n"), "condition: found '', expected a name"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\tn\npen\t21\t0\t0\t20\n"),
                   "line 2, tp: found '21', expected at most n = 20"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\tn\npen\t10\t5\t0\t20\n"),
                   "line 2, n: found '20', expected tp + fn = 15"));
    CHECK(contains(refusal_of_counts("condition\tcorrect\tn\npen\t11\t10\n"),
                   "line 2, correct: found '11', expected at most n = 10"));
    CHECK(contains(refusal_of_counts("condition\tparticipant\ttp\tfn\tfp\npen\tp1\t1\t0\t0\npen\tp1\t1\t0\t0\n"),
                   "line 3, condition: found 'pen', expected it once: line 2 has the same"));
    CHECK(contains(refusal_of_counts("condition\ttp\tfn\tfp\npen\t1\t0"),
                   "line 2: found 3 fields, expected 4"));  // cut in the middle
}

TEST_CASE("observations: what is counted twice, and names that tables take for a missing value, are refused") {
    const std::string head = "condition\tparticipant\tnodule\ttp\tfn\tfp\n";
    CHECK(
        contains(refusal_of_counts(head + "pen\tp1\tA\t1\t0\t0\npen\tp1\tn/a\t3\t1\t0\n"),
                 "line 3, nodule: found 'n/a', expected rows of nodules or one row for all of them, not both: line 2"));
    CHECK(contains(refusal_of_counts(head + "pen\tp1\tn/a\t3\t1\t0\npen\tp1\tA\t1\t0\t0\n"),
                   "line 3, nodule: found 'A'"));
    CHECK(contains(refusal_of_counts(head + "pen\tp1\tA\t1\t0\t2\npen\tp1\tn/a\t0\t0\t2\n"), "line 3, fp: found '2'"));
    CHECK(contains(refusal_of_counts(head + "pen\tp1\tA\t1\t0\t0\npen\tn/a\tA\t3\t1\t0\n"),
                   "line 3, participant: found 'n/a'"));
    CHECK(contains(refusal_of_counts(head + "pen\tp1\ttotal\t1\t0\t0\n"), "line 2, nodule: found 'total'"));
    CHECK(contains(refusal_of_counts(head + "pen\tall\tA\t1\t0\t0\n"), "line 2, participant: found 'all'"));
    CHECK(refusal_of_counts(head + "pen\tp1\tA\t1\t0\tn/a\npen\tp1\tn/a\t0\t0\t2\nhand\tp1\tn/a\t3\t1\t0\n").empty());
    const std::string choices = "condition\tparticipant\tcomparison\tcorrect\tn\n";
    CHECK(contains(refusal_of_counts(choices + "on\tp1\t2 kPa\t1\t2\non\tp1\tn/a\t1\t2\n"),
                   "line 3, comparison: found 'n/a'"));
    CHECK(contains(refusal_of_counts(choices + "on\tp1\t2 kPa\t1\t2\non\tn/a\t2 kPa\t1\t2\n"),
                   "line 3, participant: found 'n/a'"));
    const std::string totals = "condition\ttp\tfn\tfp\n";
    CHECK(contains(refusal_of_counts(totals + "pen\t1\t0\t0\nhand\t2\t0\t0\nTotal\t3\t0\t0\n"),
                   "condition: found 'Total' beside other conditions"));
    CHECK(refusal_of_counts(totals + "all\t3\t0\t0\n").empty());
    CHECK(contains(refusal_of_counts(totals + "pen\t1\t0\t0\npen \t2\t0\t0\n"),
                   "line 3, condition: found 'pen ', expected a name without a space at its ends"));
    CHECK(contains(refusal_of_counts(head + "pen\tp1\xC2\xA0\tA\t1\t0\t0\n"), "line 2, participant: found '"));
    for (const char* name : {"NA", "null", "nan", "\"p1\""}) {
        CAPTURE(name);
        CHECK(contains(refusal_of_counts(head + "pen\t" + name + "\tA\t1\t0\t0\n"), "line 2, participant: found '"));
        CHECK(contains(refusal_of_counts(head + name + "\tp1\tA\t1\t0\t0\n"), "line 2, condition: found '"));
        CHECK(contains(refusal_of_counts(head + "pen\tp1\t" + name + "\t1\t0\t0\n"), "line 2, nodule: found '"));
    }
}
