#include <doctest/doctest.h>

#include "files/text.h"
#include "study/comparisons.h"
#include "study/preregistration.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

Protocol protocol_with(const std::string& more) {
    const TemporaryFolder folder;
    palpa::files::write_text_atomically(
        folder / "p.json",
        R"({"name": "n", "version": "2", "seed": 5, "order": "fixed", "repeats": 3, "conditions": [
            {"id": "a", "modality": "hand"}, {"id": "b", "modality": "hand"}])" +
            more + "}");
    return read_protocol(folder / "p.json");
}

const std::string kAll =
    R"(, "analysis": {"primary": {"quantity": "sensitivity", "conditions": ["a", "b"]}, "participants": 7,
        "stopping_rule": "seven finished"},
       "dataset": {"authors": ["A", "B"], "funding": ["F"], "ethics_approvals": ["E 1"], "license": "CC0", "registration": "doi"})";

}  // namespace

TEST_CASE("preregistration: design, orders, primary test, stopping rule and hash stand in the sheet") {
    const Protocol protocol = protocol_with(kAll);
    const std::string sheet = preregistration_sheet(protocol, {0, "palpa 1", {{{"map_sha256", "abc"}}, {}}});
    for (const std::string& part :
         {std::string("| SHA-256 of the protocol | " + protocol.sha256), std::string("| authors | A; B |"),
          std::string("sensitivity, conditions a - b"), std::string("two-sided t test"), std::string("map_sha256 abc"),
          std::string("| planned participants | 7 |"), std::string("| stopping rule | seven finished |"),
          std::string("| 7 | all | 1 | a x 3, b x 3 |"), std::string("as the experimenter types them in"),
          std::string(kHolmFamilies)}) {
        CAPTURE(part);
        CHECK(contains(sheet, part));
    }
    CHECK_FALSE(contains(sheet, "NOT STATED"));
    CHECK_FALSE(contains(sheet, "| 8 | all"));
    CHECK(missing_statements(protocol).empty());
    CHECK(contains(sheet, "| participants who count | all who finished a test of both sides;"));
    Protocol grouped = protocol;
    grouped.primary->of_groups = true;
    grouped.primary->sides = {"I", "II"};
    grouped.primary->condition = "a";
    CHECK(contains(preregistration_sheet(grouped, {0, "palpa 1", {}}), "all in I and II who finished a test under a;"));
    Protocol between = protocol;
    between.groups = {{"I", {0}}, {"II", {1}}};
    CHECK(contains(preregistration_sheet(between, {0, "palpa 1", {}}), "all who finished a test of one of the sides;"));
}

TEST_CASE("preregistration: what the protocol does not state is named first, with its key") {
    const Protocol protocol = protocol_with("");
    const std::string sheet = preregistration_sheet(protocol, {2, "palpa 1", {}});
    CHECK(missing_statements(protocol).size() == 7);
    CHECK(contains(sheet, "- analysis.stopping_rule: when the study ends"));
    CHECK(contains(sheet, "| stopping rule | NOT STATED |"));
    CHECK(contains(sheet, "| 2 | all"));
    CHECK_FALSE(contains(sheet, "| 3 | all"));
}

TEST_CASE("preregistration: staircases promise thresholds, and no share of right answers") {
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/threshold.json");
    const std::string sheet = preregistration_sheet(protocol, {0, "palpa 1", {}});
    CHECK(contains(sheet, "| staircases | threshold and JND"));
    CHECK(contains(sheet, "`palpa study power` takes no staircases"));
    CHECK_FALSE(contains(sheet, "against one half"));
}

TEST_CASE("preregistration: power is promised only where it can be computed") {
    for (const auto& [name, power] :
         {std::pair{"effects", "`palpa study power`, with its output"}, std::pair{"effects", "8 mm of its axis"},
          std::pair{"tactile", "takes no choices that are felt through a scene"}}) {
        const Protocol protocol = read_protocol(std::string(PALPA_SOURCE_DIR "/assets/protocols/") + name + ".json");
        CHECK(contains(preregistration_sheet(protocol, {0, "palpa 1", {}}), power));
    }
    Protocol hand = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/effects.json");
    for (Condition& condition : hand.conditions) {
        condition.modality = Modality::hand;
        condition.typed_in = true;
        condition.scene.clear();
    }
    const std::string sheet = preregistration_sheet(hand, {0, "palpa 1", {}});
    CHECK(contains(sheet, "takes no conditions by hand only"));
    CHECK(contains(sheet, "as the experimenter types them in"));
    CHECK_FALSE(contains(sheet, "8 mm of its axis"));
}
