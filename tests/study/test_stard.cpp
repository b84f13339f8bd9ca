#include <doctest/doctest.h>

#include "study/observations.h"
#include "study/preregistration.h"
#include "study/stard.h"
#include "tests/error_message.h"

using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("STARD checklist: all 30 items and those of simulations stand there, filled in as far as counts know") {
    const Report report = make_report(read_counts(PALPA_SOURCE_DIR "/assets/counts/paper.tsv"), {});
    const std::string form = stard_checklist(report, nullptr);
    for (const char* item : {"1",   "2",   "3",  "4",  "5",  "6",  "7",  "8",  "9",  "10a", "10b", "11", "12a", "12b",
                             "13a", "13b", "14", "15", "16", "17", "18", "19", "20", "21a", "21b", "22", "23",  "24",
                             "25",  "26",  "27", "28", "29", "30", "S1", "S2", "S3", "S4",  "S5",  "S6", "S7"}) {
        CAPTURE(item);
        CHECK(contains(form, "\n| " + std::string(item) + " | "));
    }
    CHECK(contains(form, "Touchpad: 31 nodules found, 29 missed"));
    CHECK(contains(form, "Touchpad: sensitivity 0.5167"));
    CHECK(contains(form, "Wilson, ignores clustering)"));
    CHECK(contains(form, "| 13a | what those who did the index test knew of the reference | TO BE FILLED IN |"));
    for (const char* of_logs : {"performance.json", "settings.json", "participants.tsv", "withdrew", "interrupted"})
        CHECK_FALSE(contains(form, of_logs));
}

TEST_CASE("STARD checklist: it describes the trials that the study has") {
    const Protocol softer = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    Report report;
    report.forced_choices = 40;
    report.choices.emplace_back();
    const std::string choices = stard_checklist(report, &softer);
    for (const char* other : {"nodule", "a mark", "pairs.tsv", "Settings of every trial"})
        CHECK_FALSE(contains(choices, other));
    CHECK(contains(choices, "none: one of both surfaces is chosen"));
    CHECK(contains(choices, "choices: choices.tsv"));
    const Protocol displays = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/four-displays.json");
    const std::string form = stard_checklist({}, &displays);
    CHECK(contains(form, "8 mm of its axis"));
    CHECK(contains(form, "answers typed in: what the experimenter took for found: TO BE FILLED IN"));
    CHECK(contains(form, "answers typed in: the experimenter, who judges and types"));
}

TEST_CASE("STARD checklist: the protocol answers what it states, and simulated people are called so") {
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/effects.json");
    Report report;
    report.simulated = true;
    report.participants = 11;
    report.people_without = 4;
    report.withdrawn_people = report.excluded_people = report.replaced_people = 1;
    const std::string form = stard_checklist(report, &protocol);
    CHECK(contains(form, "the number of nodules was not told"));
    CHECK(contains(form, "display ratio: pen, scene display-ratio.json; delay: pen"));  // no device is stated
    CHECK(contains(form,
                   "15 took part, 11 are analysed (1 withdrew their data, 1 left out by the experimenter, 1 replaced, "
                   "1 without a finished test)"));
    CHECK(contains(form, "NO PERSON TOOK PART"));
    CHECK_FALSE(contains(form, "have no trial"));
    report.people_without_trial = 2;
    CHECK(contains(stard_checklist(report, &protocol),
                   "17 agreed or gave their code, 2 of whom have no trial; 15 took part, 11 are"));
    CHECK(contains(form, "tests of at most 60 s"));
}

TEST_CASE("STARD checklist and preregistration: bars and line breaks of a protocol's texts stay in their cells") {
    Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/effects.json");
    protocol.conditions[0].id = "only | one";
    protocol.conditions[0].title = "with\ntwo lines";
    protocol.stopping_rule = "1 | done";
    const std::string form = stard_checklist(Report{}, &protocol), sheet = preregistration_sheet(protocol, {});
    CHECK(contains(form, "only \\| one: pen"));
    CHECK(contains(form, "Rule for stopping: 1 \\| done"));
    CHECK(contains(sheet, "| only \\| one | with two lines | "));
    CHECK(contains(sheet, "1 \\| done"));
    CHECK(contains(sheet, "no test: it needs several trials"));
    protocol.planned_participants = 1;
    protocol.repeats = 2;
    const std::string other = preregistration_sheet(protocol, {});
    CHECK(contains(other, "`palpa study power` takes no single participant"));
    CHECK(contains(other, "Obuchowski and Rockette"));
    protocol.groups = {{"a", {0}}, {"b", {1}}};
    CHECK(
        contains(preregistration_sheet(protocol, {}), "no test: it needs people who take part under every condition"));
    protocol.groups[1].conditions = {0, 1, 2};
    CHECK(contains(preregistration_sheet(protocol, {}), "Obuchowski and Rockette"));
    protocol.groups = {{"all", {0, 1, 2}}};
    protocol.conditions[1].typed_in = protocol.conditions[2].typed_in = true;
    CHECK(contains(preregistration_sheet(protocol, {}), "no test: it needs several conditions"));
    CHECK(contains(preregistration_sheet(protocol, {}), "false marks that are typed in"));
}
