#include <doctest/doctest.h>

#include "files/text.h"
#include "study/protocol.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

const std::string kFind = R"({"id": "pen", "modality": "pen", "scene": "default.json"})";
const std::string kPairs = R"({"id": "pads", "modality": "hand"})";
const std::string kChoice = R"(, "choice": {"reference_kPa": 10, "comparisons_kPa": [12]})";
const std::string kSteps =
    R"(, "staircase": {"method": "quest-plus", "reference_kPa": 10, "comparisons_kPa": [11, 12, 14]})";

std::string refusal(const std::string& conditions, const std::string& rest) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", )"
                                             R"("conditions": [)" +
                                                 conditions + "]" + rest + "}");
    return message_of([&] { read_protocol(folder / "p.json"); });
}

std::string with_task(const std::string& task) {
    return R"({"id": "other", "modality": "hand", "task": ")" + task + "\"}";
}

std::string staircase(const std::string& keys) { return R"(, "staircase": {"reference_kPa": 10, )" + keys + "}"; }

}  // namespace

TEST_CASE("protocol: keys that would be ignored are refused") {
    CHECK(refusal(kPairs, kChoice).empty());
    CHECK(contains(refusal(kPairs, kChoice + R"(, "repeats": 3)"), "repeats: found a value, expected none"));
    CHECK(contains(refusal(kPairs, kChoice + R"(, "nodule_count_told": true)"), "nodule_count_told: found"));
    CHECK(contains(refusal(kPairs, kChoice + R"(, "turn_maps": true)"), "turn_maps: found"));
    CHECK(contains(refusal(kPairs, kChoice + R"(, "time_limit_s": 9)"), "time_limit_s: found"));
    CHECK(contains(refusal(kPairs, kChoice + R"(, "practice": {"trials": 1, "time_limit_s": 9})"),
                   "practice.time_limit_s: found"));
    CHECK(refusal(kPairs, kChoice + R"(, "practice": {"trials": 1})").empty());
    CHECK(contains(refusal(kFind, R"(, "assignment": "random")"), "assignment: found a value, expected none"));
    const std::string groups =
        R"(, "groups": [{"id": "a", "conditions": ["pen"]}, {"id": "b", "conditions": ["pen"]}])";
    CHECK(refusal(kFind, groups + R"(, "assignment": "random", "people_per_block": 3)").empty());
    CHECK(contains(refusal(kFind, groups + R"(, "people_per_block": 3)"), "people_per_block: found"));
    CHECK(contains(refusal(kFind + "," + R"({"id": "x", "modality": "hand"})", groups), "found 'x' in none of them"));
    CHECK(contains(refusal(R"({"id": "x", "modality": "hand", "profile": "p.json"})", ""), "profile: found 'p.json'"));
    CHECK(contains(refusal(R"({"id": "x", "modality": "hand", "nodules": ["A"]})", kChoice), "nodules: found names"));
    CHECK(contains(refusal(kFind, R"(, "demographics": [{"id": "consent", "text": "t"}])"), "found 'consent'"));
}

TEST_CASE("protocol: a consent without words is refused, since nobody would be asked") {
    CHECK(refusal(kFind, R"(, "consent": "You press on surfaces.")").empty());
    for (const char* empty : {"", " ", "\\n\\t "}) {
        CAPTURE(empty);
        CHECK(contains(refusal(kFind, std::string(R"(, "consent": ")") + empty + "\""), "consent: found '"));
    }
}

TEST_CASE("protocol: tasks and their settings belong together") {
    CHECK(refusal(kFind + "," + with_task("choice") + "," + R"({"id": "s", "modality": "hand", "task": "staircase"})",
                  kChoice + kSteps)
              .find("conditions[0]") == std::string::npos);
    CHECK(refusal(R"({"id": "p", "modality": "pen", "scene": "default.json", "task": "find"},)" + with_task("choice"),
                  kChoice)
              .empty());
    CHECK(contains(refusal(kFind + "," + with_task("staircase"), ""), "staircase: found nothing"));
    CHECK(contains(refusal(with_task("find"), kChoice), "choice: found settings, expected none"));
    CHECK(contains(refusal(with_task("look"), kChoice), "conditions[0].task: found 'look'"));
    const std::string in_turn =
        R"(, "choice": {"reference_kPa": 10, "comparisons_kPa": [12], "alternate_conditions": true})";
    CHECK(contains(refusal(kPairs, in_turn + R"(, "trial_order": "shuffled")"), "trial_order: found a value"));
    CHECK(contains(refusal(kPairs + "," + with_task("find"), in_turn), "choice.alternate_conditions: found true"));
}

TEST_CASE("protocol: the settings of a staircase are checked") {
    const std::string levels = R"("comparisons_kPa": [14, 11, 12])";
    CHECK(refusal(kPairs, staircase(levels + R"(, "method": "weighted-up-down", "start_kPa": 12)")).empty());
    CHECK(contains(refusal(kPairs, staircase(levels + R"(, "method": "binary")")), "staircase.method: found 'binary'"));
    CHECK(contains(refusal(kPairs, staircase(R"("comparisons_kPa": [9, 11, 12], "method": "weighted-up-down")")),
                   "found levels on both sides of the reference"));
    CHECK(refusal(kPairs, staircase(R"("comparisons_kPa": [9, 11, 12], "method": "quest-plus")")).empty());
    CHECK(contains(refusal(kPairs, staircase(levels + R"(, "method": "quest-plus", "start_kPa": 12)")),
                   "start_kPa: found a value, expected none"));
    CHECK(contains(refusal(kPairs, staircase(levels + R"(, "method": "weighted-up-down", "start_kPa": 13)")),
                   "expected one of comparisons_kPa"));
    CHECK(contains(refusal(kPairs, staircase(R"("comparisons_kPa": [11, 12], "method": "quest-plus")")),
                   "three or more"));
    CHECK(contains(refusal(kPairs, staircase(R"("comparisons_kPa": [11, 10, 12], "method": "quest-plus")")),
                   "values unlike the reference"));
    CHECK(contains(refusal(kPairs, staircase(R"("comparisons_kPa": [11, 11, 12], "method": "quest-plus")")),
                   "found 11 a second time"));
}
