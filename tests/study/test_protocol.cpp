#include <doctest/doctest.h>

#include "files/sha256.h"
#include "files/text.h"
#include "study/order.h"
#include "study/protocol.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

const std::string kProtocols = PALPA_SOURCE_DIR "/assets/protocols/";

std::string refusal_of_protocol(const std::string& text) {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json", text);
    return message_of([&] { read_protocol(folder / "p.json"); });
}

// A protocol with `conditions` and whatever else.
std::string with(const std::string& conditions, const std::string& rest = "") {
    return R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", "conditions": [)" + conditions + "]" + rest +
           "}";
}

const std::string kPen = R"({"id": "pen", "modality": "pen", "scene": "default.json"})";

}  // namespace

TEST_CASE("protocol: the shipped ones read as they are meant") {
    const Protocol paper = read_protocol(kProtocols + "paper.json");
    CHECK(paper.conditions.size() == 5);
    REQUIRE(paper.groups.size() == 2);
    CHECK(paper.groups[1].conditions == std::vector<std::size_t>{2, 3, 4});
    CHECK(paper.conditions[0].modality == Modality::hand);
    CHECK(paper.time_limit_s == 60.0);
    CHECK(paper.practice_trials == 1);
    CHECK_FALSE(paper.count_told);
    CHECK(paper.demographics.size() == 6);
    CHECK(paper.sha256 == sha256_hex(read_text(kProtocols + "paper.json")));
    const Protocol softer = read_protocol(kProtocols + "softer.json");
    CHECK(softer.task == TaskKind::choice);
    CHECK(softer.choice.comparisons_kPa.size() == 5);
    CHECK(read_protocol(kProtocols + "effects.json").groups.size() == 1);
}

TEST_CASE(
    "protocol: tactile.json is the paper's 80 choices with ten times its moduli, and people practise before them") {
    const Protocol tactile = read_protocol(kProtocols + "tactile.json");
    REQUIRE(tactile.conditions.size() == 2);
    for (const Condition& condition : tactile.conditions) {
        CHECK(condition.modality == Modality::shape_display);
        CHECK_FALSE(condition.scene.empty());  // driven
    }
    CHECK(tactile.trial_order == TrialOrder::interleaved);
    const ChoiceTask& choice = tactile.choice;
    CHECK(choice.comparisons_kPa.size() * 2 * static_cast<std::size_t>(choice.repeats) == 80);
    const double paper_kPa[] = {1.875, 2.0, 2.25, 2.75, 3.75};
    for (std::size_t i = 0; i < std::size(paper_kPa); ++i)
        CHECK(choice.comparisons_kPa[i] / choice.reference_kPa == close_to(paper_kPa[i] / 1.75));
    CHECK(tactile.practice_trials > 0);
    // either surface is first equally often, and either condition begins equally often
    int first = 0, begins = 0;
    for (int number = 1; number <= 2; ++number) {
        const PlannedParticipant who = plan_participant(tactile, number);
        std::size_t before = 2;
        for (const PlannedTrial& trial : who.trials) {
            if (trial.practice) continue;
            if (before == 2) begins += trial.condition == 0 ? 1 : 0;
            CHECK(trial.condition != before);  // in alternation
            before = trial.condition;
            first += trial.reference_first ? 1 : 0;
        }
    }
    CHECK(first == 80);
    CHECK(begins == 1);
}

TEST_CASE("protocol: three-displays.json keeps the reference on pins and arm, with comparisons on both sides of it") {
    const Protocol three = read_protocol(kProtocols + "three-displays.json");
    REQUIRE(three.choice.reference_on == 0u);
    CHECK(three.conditions[0].id == "pins and arm");
    CHECK(three.conditions[2].modality == Modality::pen);
    int softer = 0;
    for (const double kPa : three.choice.comparisons_kPa) softer += kPa < three.choice.reference_kPa ? 1 : 0;
    CHECK(2 * softer == static_cast<int>(three.choice.comparisons_kPa.size()));
    CHECK(three.practice_trials > 0);
}

TEST_CASE("protocol: forced choices may keep the reference under one condition") {
    const TemporaryFolder folder;
    const std::string two = R"({"id": "hand", "modality": "hand"}, )" + kPen;
    const std::string choice = R"(, "choice": {"reference_kPa": 1, "comparisons_kPa": [2])";
    write_text_atomically(folder / "p.json", with(two, choice + R"(, "reference_on": "pen"})"));
    CHECK(read_protocol(folder / "p.json").choice.reference_on == 1u);
    write_text_atomically(folder / "q.json", with(two, choice + "}"));
    CHECK_FALSE(read_protocol(folder / "q.json").choice.reference_on);
    write_text_atomically(folder / "r.json", with(two, choice + R"(, "alternate_conditions": true})"));
    CHECK(read_protocol(folder / "r.json").trial_order == TrialOrder::interleaved);
}

TEST_CASE("protocol: what is wrong is named with its key") {
    CHECK(refusal_of_protocol(with(kPen)).empty());
    CHECK(contains(refusal_of_protocol(with("")), "conditions: found nothing, expected one condition"));
    CHECK(contains(refusal_of_protocol(with(kPen + "," + kPen)), "conditions[1].id: found 'pen' a second time"));
    CHECK(contains(refusal_of_protocol(with(R"({"id": "all", "modality": "pen", "scene": "x.json"})")),
                   "conditions[0].id: found 'all', expected a name that no row of sums has"));
    CHECK(contains(refusal_of_protocol(with(kPen + R"(], "practice": {"trials": 0, "time_limit_s": 5}, "ratings": [)")),
                   "practice.time_limit_s: found a value, expected none: there are no practice trials"));
    CHECK(contains(refusal_of_protocol(with(R"({"id": "x", "modality": "nose", "scene": "s"})")),
                   "conditions[0].modality: found 'nose'"));
    CHECK(
        contains(refusal_of_protocol(with(R"({"id": "x", "modality": "pen"})")), "conditions[0].scene: found nothing"));
    CHECK(contains(refusal_of_protocol(with(R"({"id": "x", "modality": "hand", "scene": "s.json"})")),
                   "a real phantom has no scene"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "groups": [{"id": "g", "conditions": ["pin"]}])")),
                   "groups[0].conditions: found 'pin'"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "groups": [{"id": "g", "conditions": ["pen", "pen"]}])")),
                   "found 'pen' a second time"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "time_limit": 3)")), "time_limit: found an unknown key"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "seed": 2)")), "seed: found the key twice"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "choice": {"reference_kPa": 1, "comparisons_kPa": [1]})")),
                   "values unlike the reference"));
    CHECK(contains(refusal_of_protocol(with(
                       kPen, R"(, "choice": {"reference_kPa": 1, "comparisons_kPa": [2], "reference_on": "pin"})")),
                   "choice.reference_on: found 'pin', expected the id of a condition"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "choice": true)")), "choice: found true"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "ratings": [{"id": "a", "text": "t", "low": "never"}])")),
                   "low: found no scale, expected it beside from and to"));
    CHECK(contains(refusal_of_protocol(with(kPen, R"(, "ratings": [{"id": "a", "text": "t", "from": 5, "to": 1}])")),
                   "ratings[0].to: found 1"));
    CHECK(contains(
        refusal_of_protocol(with(kPen, R"(, "ratings": [{"id": "a", "text": "t", "choices": ["yes", "no", "yes"]}])")),
        "ratings[0].choices: found 'yes' a second time, expected each text once"));
    CHECK(contains(
        refusal_of_protocol(with(R"({"id": "x", "modality": "pen", "scene": "s.json", "device": "S-pen\tof 2014"})")),
        "conditions[0].device: found 'S-pen?of 2014', expected a name without tabs"));
    CHECK(contains(refusal_of_protocol("{"), "line 1, column"));
}

TEST_CASE("protocol: names that tables take for a missing value, or that break their fields, are refused") {
    for (const char* name : {"NA", "n/a", "nan", "null", "a\\\"b", "a\\tb"}) {
        CAPTURE(name);
        const std::string id = name;
        CHECK(contains(refusal_of_protocol(with(R"({"id": ")" + id + R"(", "modality": "pen", "scene": "s.json"})")),
                       "conditions[0].id: found '"));
        CHECK(
            contains(refusal_of_protocol(with(kPen, R"(, "groups": [{"id": ")" + id + R"(", "conditions": ["pen"]}])")),
                     "groups[0].id: found '"));
        CHECK(contains(refusal_of_protocol(with(R"({"id": "x", "modality": "hand", "nodules": [")" + id + R"("]})")),
                       "conditions[0].nodules: found '"));
        CHECK(contains(refusal_of_protocol(with(kPen, R"(, "ratings": [{"id": ")" + id + R"(", "text": "t"}])")),
                       "ratings[0].id: found '"));
    }
    CHECK(contains(refusal_of_protocol(with(R"({"id": "x", "modality": "pen", "scene": "s.json", "device": "a\tb"})")),
                   "conditions[0].device: found '"));
    CHECK(
        refusal_of_protocol(with(R"({"id": "none", "modality": "pen", "scene": "s.json", "device": "n/a"})")).empty());
}

TEST_CASE("protocol: four-displays.json has one phantom on a screen, a soft device, pins and arm, and as a cast") {
    const Protocol four = read_protocol(kProtocols + "four-displays.json");
    REQUIRE(four.conditions.size() == 4);
    CHECK(four.task == TaskKind::find);
    CHECK(four.conditions[0].modality == Modality::pen);
    CHECK(four.conditions[1].modality == Modality::tangible);
    CHECK(four.conditions[2].modality == Modality::shape_display);
    CHECK(four.conditions[3].modality == Modality::hand);
    CHECK(four.conditions[3].cast_of == 0);
    for (std::size_t i = 0; i < 3; ++i) CHECK_FALSE(four.conditions[i].scene.empty());
}

TEST_CASE("protocol: a cast is of a condition that has a scene, is felt by hand, and has no names of its own") {
    const auto refused = [](const std::string& conditions, const std::string& rest = "") {
        return refusal_of_protocol(with(conditions, rest));
    };
    const std::string cast = R"({"id": "cast", "modality": "hand", "cast_of": )";
    CHECK(contains(refused(kPen + ", " + cast + R"("nobody"})"),
                   "cast_of: found 'nobody', expected the id of a condition of this protocol that has a scene"));
    CHECK(contains(refused(cast + R"("cast"})"), "cast_of: found 'cast', expected the id of a condition"));
    CHECK(contains(refused(kPen + ", " + cast + R"("pen", "nodules": ["A"]})"), "nodules: found names, expected none"));
    CHECK(contains(refused(R"({"id": "a", "modality": "pen", "scene": "default.json", "cast_of": "a"})"),
                   "cast_of: found a value, expected none: only a phantom felt by hand is a cast"));
    CHECK(contains(
        refused(kPen + ", " + cast + R"("pen"})", R"(, "choice": {"reference_kPa": 10, "comparisons_kPa": [20]})"),
        "cast_of: found a value, expected none: two surfaces are compared"));
}
