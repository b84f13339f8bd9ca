#include <doctest/doctest.h>

#include "files/text.h"
#include "study/protocol.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

Protocol with_primary(const std::string& primary, const std::string& more = "") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "x", "modality": "hand"}, {"id": "y", "modality": "hand"}],
        "groups": [{"id": "I", "conditions": ["x", "y"]}, {"id": "II", "conditions": ["x"]}],)" +
                                                 more + R"("analysis": {"primary": )" + primary + "}}");
    return read_protocol(folder / "p.json");
}

std::string refusal_of_primary(const std::string& primary, const std::string& more = "") {
    return message_of([&] { with_primary(primary, more); });
}

}  // namespace

TEST_CASE("primary: two conditions, or two groups under one condition") {
    const auto pair = with_primary(R"({"quantity": "ppv", "conditions": ["y", "x"]})").primary;
    REQUIRE(pair);
    CHECK(pair->quantity == Quantity::ppv);
    CHECK(pair->sides[0] == "y");
    CHECK(pair->test == PrimaryTest::t);
    const auto groups = with_primary(R"({"quantity": "sensitivity", "groups": ["I", "II"], "condition": "x",
        "test": "permutation"})")
                            .primary;
    REQUIRE(groups);
    CHECK(groups->of_groups);
    CHECK(groups->condition == "x");
    CHECK(groups->test == PrimaryTest::permutation);
}

TEST_CASE("primary: what the protocol does not define is refused with its key") {
    CHECK(contains(refusal_of_primary(R"({"quantity": "sensitivity", "conditions": ["x", "z"]})"),
                   "analysis.primary.conditions: found 'z', expected an id that this protocol defines"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "sensitivity", "conditions": ["x", "x"]})"), "'x' twice"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "sensitivity", "conditions": ["x"]})"), "an array of two ids"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "sensitivity", "groups": ["I", "II"], "condition": "I"})"),
                   "analysis.primary.condition: found 'I'"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "sensitivity", "groups": ["I", "II"], "condition": "y"})"),
                   "analysis.primary.condition: found 'y', expected a condition of both groups, also of 'II'"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "correct", "conditions": ["x", "y"]})"), "people find nodules"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "ppv", "conditions": ["x", "y"]})",
                                      R"("choice": {"reference_kPa": 1, "comparisons_kPa": [2]},)"),
                   "people choose"));
    CHECK(contains(refusal_of_primary(R"({"quantity": "sensitivity", "conditions": ["x", "y"], "alpha": 0.05})"),
                   "alpha"));
}

TEST_CASE(
    "primary: in a protocol of several tasks the conditions that are compared decide which quantities they have") {
    const auto with = [](const std::string& primary) {
        const TemporaryFolder folder;
        write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
            "choice": {"reference_kPa": 1, "comparisons_kPa": [2]},
            "staircase": {"method": "quest-plus", "reference_kPa": 1, "comparisons_kPa": [2, 3, 4]},
            "conditions": [
                {"id": "f", "modality": "hand", "task": "find"}, {"id": "g", "modality": "hand", "task": "find"},
                {"id": "c", "modality": "hand", "task": "choice"}, {"id": "d", "modality": "hand"},
                {"id": "s", "modality": "hand", "task": "staircase"}],
            "analysis": {"primary": )" + primary + "}}");
        return read_protocol(folder / "p.json").primary;
    };
    CHECK(with(R"({"quantity": "sensitivity", "conditions": ["f", "g"]})")->quantity == Quantity::sensitivity);
    CHECK(with(R"({"quantity": "correct", "conditions": ["c", "d"]})")->quantity == Quantity::correct);
    const auto refusal = [&](const std::string& primary) { return message_of([&] { with(primary); }); };
    CHECK(contains(refusal(R"({"quantity": "ppv", "conditions": ["f", "c"]})"), "correct: people choose under 'c'"));
    CHECK(contains(refusal(R"({"quantity": "correct", "conditions": ["c", "g"]})"), "people find nodules under 'g'"));
    CHECK(contains(refusal(R"({"quantity": "correct", "conditions": ["c", "s"]})"),
                   "the method sets the share of right answers under 's'"));
}
