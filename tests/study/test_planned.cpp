#include <doctest/doctest.h>

#include "files/text.h"
#include "study/planned.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

Protocol two_conditions(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 3, "order": "fixed", "repeats": 2,
        "practice": {"trials": 1}, "conditions": [{"id": "a", "modality": "hand"}, {"id": "b", "modality": "hand"}]})");
    return read_protocol(folder / "p.json");
}

}  // namespace

TEST_CASE("planned: what is finished, interrupted, excluded and missing is counted by condition, without practice") {
    const TemporaryFolder folder;
    const Protocol protocol = two_conditions(folder);
    std::vector<std::string> notes;
    // the plan: practice, two tests of a, practice, two tests of b
    const std::vector<Logged> logged{{1, 0, true, true},  {2, 0, false, false}, {2, 0, false, true, true},
                                     {3, 0, false, true}, {4, 1, true, false},  {5, 1, false, true}};
    const auto rows = compare_with_plan(protocol, plan_participant(protocol, 1), "01", logged, notes);
    CHECK(notes.empty());
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].condition == "a");
    CHECK(rows[0].planned == 2);
    CHECK(rows[0].finished == 2);
    CHECK(rows[0].interrupted == 1);
    CHECK(rows[0].excluded == 1);
    CHECK(rows[0].missing() == 0);
    CHECK(rows[1].finished == 1);
    CHECK(rows[1].missing() == 1);
}

TEST_CASE("planned: trials that are not what the plan says are named once for a participant") {
    const TemporaryFolder folder;
    const Protocol protocol = two_conditions(folder);
    std::vector<std::string> notes;
    compare_with_plan(protocol, plan_participant(protocol, 1), "01", {{2, 1, false, true}, {3, 0, true, true}}, notes);
    REQUIRE(notes.size() == 1);
    CHECK(notes[0] ==
          "sub-01: trial 2 is 'b' (test) in the log, 'a' (test) in the plan of number 1; 1 more such trials");
}

TEST_CASE("planned: a seed that is not the plan's is named, and a comparison that is planned twice is no other pair") {
    const TemporaryFolder folder;
    const Protocol protocol = two_conditions(folder);
    const PlannedParticipant plan = plan_participant(protocol, 1);
    std::vector<std::string> notes;
    Logged own{2, 0, false, true}, other{3, 0, false, true};
    own.seed = plan.trials[1].seed;
    other.seed = plan_participant(protocol, 2).trials[2].seed;
    compare_with_plan(protocol, plan, "01", {own, other, other}, notes);
    REQUIRE(notes.size() == 1);
    CHECK(contains(notes[0], "sub-01: trial 3 has the seed " + std::to_string(other.seed) + " in the log"));
    CHECK(contains(notes[0], "; 1 more such trials"));
    write_text_atomically(folder / "c.json", R"({"name": "n", "version": "1", "seed": 3, "order": "fixed",
        "conditions": [{"id": "a", "modality": "hand"}],
        "choice": {"reference_kPa": 2, "comparisons_kPa": [3, 3], "repeats": 2}})");
    const Protocol twice = read_protocol(folder / "c.json");
    std::vector<Logged> choices;
    for (const PlannedTrial& trial : plan_participant(twice, 1).trials) {
        choices.push_back({trial.trial, 0, false, true});
        choices.back().comparison = 0;
        choices.back().reference_first = trial.reference_first;
    }
    notes.clear();
    compare_with_plan(twice, plan_participant(twice, 1), "01", choices, notes);
    CHECK(notes.empty());
}

TEST_CASE("planned: a seed tells whose plan a trial is of") {
    const TemporaryFolder folder;
    const Protocol protocol = two_conditions(folder);
    const std::int64_t seed = plan_participant(protocol, 3).trials[1].seed;
    CHECK(number_with_seed(protocol, 2, seed, 3, 1) == 3);
    CHECK(number_with_seed(protocol, 2, seed, 1, 5) == 3);
    CHECK_FALSE(number_with_seed(protocol, 2, seed, 1, 2));
    CHECK_FALSE(number_with_seed(protocol, 99, seed, 1, 5));
}
