#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "study/report.h"
#include "study/table_dictionary.h"
#include "tests/close_to.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

// Twenty people, two nodules, two conditions: b finds one nodule more in half of the people.
Observations paired_study() {
    Observations seen;
    for (const char* name : {"a", "b"}) index_of(name, seen.conditions);
    for (const char* name : {"N1", "N2"}) index_of(name, seen.nodules);
    for (int person = 0; person < 20; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        for (int condition = 0; condition < 2; ++condition) {
            for (int nodule = 0; nodule < 2; ++nodule) {
                const bool hit = nodule == 0 ? person % 4 != 0 : (condition == 1 && person % 2 == 0);
                seen.rows.push_back({condition, person, nodule, 0, hit, !hit, 0});
            }
            seen.rows.push_back({condition, person, -1, 0, 0, 0, person == 3 ? 1 : 0});
            seen.trials.push_back({condition, person, 30.0 + person, 1.0, 2.0, std::nan("")});
        }
    }
    return seen;
}

}  // namespace

TEST_CASE("report: the paper's counts give its verdicts, and Holm's correction keeps three of five differences") {
    const Observations seen = read_counts(PALPA_SOURCE_DIR "/assets/counts/paper.tsv");
    const Json json = report_json(make_report(seen, {}));
    CHECK(json["conditions"].size() == 5);
    const Json& touchpad = json["conditions"]["Touchpad"];
    CHECK(touchpad["tp"] == 31);
    CHECK(touchpad["fn"] == 29);
    CHECK(touchpad["fp"] == 5);
    CHECK(touchpad["se_ci"][0].get<double>() == close_to(0.393078).epsilon(2e-6));
    CHECK(touchpad["ppv_ci"][1].get<double>() == close_to(0.939182).epsilon(2e-6));
    CHECK(touchpad["nodules"]["C"]["tp"] == 3);
    CHECK(json["pairs"].size() == 10);
    CHECK(json["ppv_pairs"].size() == 10);
    int significant = 0, corrected = 0;
    for (const Json& pair : json["pairs"]) {
        const Json& paper = pair["replication"];
        significant += paper["significant"].get<bool>();
        corrected += paper["p_holm"].get<double>() < 0.05;
        CHECK(paper["newcombe_ci"][0].get<double>() <= paper["delta"].get<double>());  // the sign of both is of a - b
        CHECK(paper["newcombe_ci"][1].get<double>() >= paper["delta"].get<double>());
        CHECK_FALSE(pair.contains("ignores_clustering"));  // the counts do not tell who was who
        CHECK(pair["p"].is_null());
        CHECK(pair["status"] == "cannot be computed, because the counts do not name their participants");
        if (pair["a"] != "S-pen" || pair["b"] != "Bare finger") continue;
        CHECK(paper["combined_interval"].get<double>() == close_to(0.119343).epsilon(5e-6));
        CHECK(paper["significant"] == false);
        CHECK(pair["higher"] == "S-pen");
    }
    CHECK(significant == 5);
    CHECK(corrected == 3);
}

TEST_CASE("report: people who did both conditions are compared in pairs, over participants") {
    const Report report = make_report(paired_study(), {});
    REQUIRE(report.conditions.size() == 2);
    CHECK(report.conditions[0].tp == 15);
    CHECK(report.conditions[1].tp == 25);
    CHECK(report.conditions[1].fp == 1);
    CHECK(report.conditions[0].participants == 20);
    CHECK(report.conditions[0].se->bootstrap);
    REQUIRE(report.pairs.size() == 1);
    const PairResult& pair = report.pairs[0];
    REQUIRE(pair.paired);
    CHECK(pair.paired->both == 15);
    CHECK(pair.paired->only_a == 0);
    CHECK(pair.paired->only_b == 10);
    CHECK(pair.paired->neither == 15);
    CHECK(pair.higher == "b");
    CHECK(pair.people.difference == close_to(-0.25));
    CHECK(pair.people.df == 19.0);
    // ten people differ by one half, ten do not
    CHECK(pair.people.t == close_to(-0.25 / std::sqrt(20.0 * 0.0625 / 19.0 / 20.0)));
    CHECK(pair.people.p_permutation == close_to(2.0 / 1024.0));
    CHECK(pair.replication->delta == close_to(-0.25));
    CHECK(pair.mcnemar_p == close_to(2.0 / 1024.0));
    CHECK(pair.replication->p > pair.mcnemar_p);  // independent samples see less
    REQUIRE(pair.bootstrap);
    CHECK(pair.bootstrap->high < 0.0);
    CHECK(pair.participants_in_both == 20);
    CHECK(report.conditions[0].duration_s->median == close_to(39.5));
    CHECK_FALSE(report.conditions[0].max_force_N);
    CHECK(contains(report_markdown(report), "| a | time_s | 20 | 39.500 |"));
}

TEST_CASE("report: nothing to find and nobody who marks leave no shares, and no pairs") {
    Observations seen;
    index_of("empty", seen.conditions);
    index_of("full", seen.conditions);
    seen.rows.push_back({0, -1, -1, 0, 0, 0, 2});
    seen.rows.push_back({1, -1, -1, 0, 0, 3, 0});
    const Json json = report_json(make_report(seen, {}));
    CHECK(json["conditions"]["empty"]["se"].is_null());
    CHECK(json["conditions"]["empty"]["ppv"] == 0.0);
    CHECK(json["conditions"]["full"]["ppv_ci"].is_null());
    CHECK(json["pairs"].empty());
    CHECK(json["ppv_pairs"].empty());
}

TEST_CASE("report: forced choices against chance, over people and over answers") {
    Observations seen;
    index_of("with", seen.conditions);
    for (int person = 0; person < 6; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        seen.choices.push_back({0, person, -1, 60 + person, 80});
    }
    const Report report = make_report(seen, {});
    REQUIRE(report.choices.size() == 1);
    const ChoiceResult& choice = report.choices[0];
    CHECK(choice.correct.x.k == 375);
    CHECK(choice.correct.x.n == 480);
    REQUIRE(choice.over_people);
    CHECK(choice.over_people->df == 5.0);
    CHECK(choice.over_people->difference == close_to(62.5 / 80.0 - 0.5));
    CHECK(choice.p_holm == close_to(choice.over_people->p));
    CHECK(report_json(report)["choices"][0]["t_over_participants"]["mean"].get<double>() == close_to(62.5 / 80.0));
    CHECK(choice.over_answers->df == 479.0);
    CHECK(choice.binomial_p < 1e-30);
    CHECK(contains(report_markdown(report), "| with | all | 375 | 480 |"));
}

TEST_CASE("report: two people with one right answer each give no number without variance") {
    Observations seen;
    index_of("with", seen.conditions);
    for (int person = 0; person < 2; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        seen.choices.push_back({0, person, -1, 1, 1});
    }
    const Json choice = report_json(make_report(seen, {}))["choices"][0];
    const Json& test = choice["t_over_participants"];
    CHECK(test["p"].is_null());
    CHECK(test["ci"][0].is_null());
    CHECK(test["status"] == "cannot be computed, because the shares of all 2 people are the same: no variance");
    CHECK(test["p_permutation"] == 0.5);
    CHECK(choice["t_over_answers"]["p"].is_null());
    CHECK(choice["share_bootstrap_ci"].is_null());
    CHECK(choice["share_ci_label"] == "over participants");
    CHECK_FALSE(contains(report_markdown(make_report(seen, {})), "e-"));  // no p value that is next to nothing
    CHECK(contains(report_markdown(make_report(seen, {})), "WARNING: fewer than 10 people: with (2)"));
}

TEST_CASE("report: more than twice the marks under one condition are warned of") {
    Observations seen;
    for (const char* name : {"clear", "vague"}) index_of(name, seen.conditions);
    for (int person = 0; person < 3; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        seen.rows.push_back({0, person, -1, 0, 2, 1, 0});
        seen.rows.push_back({1, person, -1, 0, 1, 2, 0});
    }
    const auto warns = [&] {
        return contains(report_markdown(make_report(seen, {})),
                        "WARNING: clear has 7 marks (hits and false ones, each nodule once), vague 3");
    };
    CHECK_FALSE(warns());  // six and three
    seen.rows.push_back({0, 0, -1, 1, 1, 0, 0});
    CHECK(warns());
    const auto says_unfit = [&] {
        return contains(report_markdown(make_report(seen, {})), "tests of PPV without a permutation: one side has");
    };
    CHECK(says_unfit());
    seen.rows.push_back({1, 0, -1, 1, 0, 0, 6});  // six false marks
    CHECK_FALSE(says_unfit());
}

TEST_CASE("report: a single trial has no standard deviation") {
    Observations seen;
    index_of("a", seen.conditions);
    seen.rows.push_back({0, -1, -1, 0, 1, 0, 0});
    seen.trials.push_back({0, 0, 30.0, 1.0, 2.0, 3.0});
    const Report report = make_report(seen, {});
    CHECK(report_json(report)["conditions"]["a"]["time_s"]["sd"].is_null());
    CHECK(contains(report_markdown(report), "| a | time_s | 1 | 30.000 | n/a |"));
}

TEST_CASE("report: groups stand in every table, below the rows of all people") {
    Observations seen = paired_study();
    for (const char* name : {"I", "II"}) index_of(name, seen.groups);
    for (int person = 0; person < 20; ++person) seen.group_of.push_back(person % 2);
    seen.answers.push_back({"a", "effort", "3", 1});
    const Report report = make_report(seen, {});
    REQUIRE(report.groups.size() == 2);
    CHECK(report.groups[0].participants == 10);
    CHECK(report.groups[0].conditions[1].tp == 5 + 10);  // the even ones find the second nodule
    CHECK(report.groups[1].conditions[1].tp == 10);
    CAPTURE(report.groups[0].mixed.status);
    CAPTURE(report.groups[1].mixed.status);
    const std::string last_model = report.groups[1].mixed.status.empty() ? "II" : "I";
    for (const ReportTable& table : report_tables(report)) {
        CAPTURE(table.name);
        CHECK(table.columns.back() == "group");
        CHECK(table.rows.front().back() == "all");
        const bool model = table.name.rfind("mixed", 0) == 0;  // the nodule that the first finds is found by all of II
        if (table.name != "groups") CHECK(table.rows.back().back() == (model ? last_model : "II"));
    }
    if (last_model == "I")
        CHECK(contains(report_markdown(report), "The mixed logistic model of group II cannot be computed"));
    const Json json = report_json(report);
    CHECK(json["groups"]["I"]["conditions"]["b"]["tp"] == 15);
    CHECK(json["group_comparisons"].size() == 5);
    CHECK(contains(report_markdown(report), "| sensitivity | a | b | I | II | between | 10 | 10 |"));
}

TEST_CASE("report: p_holm is corrected within the families that report.md and the dictionaries name") {
    Observations seen = paired_study();
    for (const char* name : {"I", "II"}) index_of(name, seen.groups);
    for (int person = 0; person < 20; ++person) {
        seen.group_of.push_back(person < 8 ? 0 : 1);
        for (int condition = 0; condition < 2; ++condition)
            seen.choices.push_back({condition, person, -1, (person * 7 + condition * 5) % 11, 12});
    }
    const Report report = make_report(seen, {});
    for (const Quantity quantity : {Quantity::sensitivity, Quantity::ppv, Quantity::correct}) {
        for (const bool interaction : {false, true}) {
            std::vector<double> p, p_holm;
            for (const GroupResult& one : report.group_comparisons) {
                if (one.quantity != quantity || one.condition_b.empty() == interaction) continue;
                p.push_back(one.people.p);
                p_holm.push_back(one.p_holm);
            }
            CHECK(p.size() == (!interaction ? 2u : quantity == Quantity::ppv ? 0u : 1u));
            const std::vector<double> corrected = holm_of_known(p);
            for (std::size_t i = 0; i < p.size(); ++i) CHECK((std::isnan(p[i]) || p_holm[i] == close_to(corrected[i])));
        }
    }
    for (const Report& group : report.groups) CHECK(group.choice_pairs[0].p_holm == group.choice_pairs[0].people.p);
    const std::string text = report_markdown(report);
    CHECK(contains(text, std::string("p_holm = corrected by Holm ") + kHolmFamilies));
    CHECK(contains(text, "Interactions of PPV are not tested"));
    CHECK_FALSE(contains(report_markdown(make_report(paired_study(), {})), "Interactions"));
    CHECK(contains(report_json(report)["methods"]["p_holm"].get<std::string>(), kHolmFamilies));
    const auto family = [](const char* table) {
        return dictionary_of({table, "", {"p_holm"}, {}})["p_holm"]["Description"].get<std::string>();
    };
    CHECK(contains(family("groups"), "of the same quantity; those with minus_condition apart"));
    CHECK(contains(family("choice_pairs"), "over all pairs of conditions; the rows of each group by themselves"));
    CHECK(contains(family("choices"), "over all conditions, and apart from them over all single comparisons"));
    CHECK(contains(family("free_response_tests"), "of the same figure"));
}

TEST_CASE("report: nodules that are not known are counted, and named as the reason why there is no mixed model") {
    Observations seen = paired_study();
    const auto left_out = [&] {
        return contains(report_markdown(make_report(seen, {})),
                        "The tables of nodules (nodules, pairs_ignoring_clustering) leave out 2 of 80 hits and misses, "
                        "because the counts do not name their nodules");
    };
    CHECK_FALSE(left_out());
    for (Observation& row : seen.rows) {
        if (row.participant == 4 && row.condition == 1) row.nodule = -1;
    }
    CHECK(left_out());
    CHECK(contains(report_markdown(make_report(seen, {})),
                   "The mixed logistic model cannot be computed, because the nodule of 2 of 80 hits and misses is not "
                   "known."));
    seen.from_logs = true;
    CHECK(contains(report_json(make_report(seen, {}))["notes"].back().get<std::string>(),
                   "because their logs have no settings that name the nodules"));
}

TEST_CASE("report: a level that needs more resamples than there are is warned of, the default never") {
    const auto warning = [](double level, int resamples) {
        ReportOptions options;
        options.bootstrap.level = level;
        options.bootstrap.resamples = resamples;
        const Json json = report_json(make_report(paired_study(), options));
        for (const Json& note : json["notes"]) {
            if (contains(note.get<std::string>(), "resamples")) return note.get<std::string>();
        }
        return std::string();
    };
    CHECK(warning(0.95, 2000).empty());
    CHECK(
        contains(warning(0.95, 100), "WARNING: bootstrap intervals at 95 % of 20 people need at least 630 resamples"));
    CHECK(contains(warning(0.99, 2000), "of 20 people need"));
    CHECK(contains(warning(0.99, 2000), "; of 2000 too few lie beyond the limits"));
    CHECK(warning(0.99, 100'000).empty());
    CHECK(contains(warning(0.9999, 1'000'000),
                   "need more than the 1000000 resamples that can be asked for, so choose a lower level"));
    Observations few = paired_study();
    std::erase_if(few.rows, [](const Observation& row) { return row.participant >= 3; });
    for (const std::string& note : make_report(few, {}).notes) CHECK_FALSE(contains(note, "resamples"));
}

TEST_CASE("report: tables have a value in every column, and Markdown keeps its bars") {
    Observations seen = paired_study();
    seen.conditions[0] = "a|b";
    seen.simulated = true;
    const Report report = make_report(seen, {});
    for (const ReportTable& table : report_tables(report)) {
        CAPTURE(table.name);
        for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
    }
    CHECK(contains(report_markdown(report), "a\\|b"));
    CHECK(contains(report_markdown(report), "SIMULATED"));
    CHECK(report_json(report)["simulated"] == true);
}

TEST_CASE("report: pairs of very many conditions are not compared, and the report says so") {
    Observations seen;
    for (int condition = 0; condition < 300; ++condition) {
        index_of("c" + std::to_string(condition), seen.conditions);
        for (int person = 0; person < 3; ++person) {
            if (condition == 0) index_of("p" + std::to_string(person), seen.participants);
            seen.rows.push_back({condition, person, -1, 0, person, 3 - person, 0});
        }
    }
    const Report report = make_report(seen, {});
    CHECK(report.conditions.size() == 300);
    CHECK(report.pairs.empty());
    REQUIRE(report.notes.size() == 2);
    CHECK(contains(report.notes[0], "all pairs of 300 conditions are not compared"));
    CHECK(contains(report.notes[1], "c19 (3) and 280 others"));
}

TEST_CASE("report: rows in any order give the same report") {
    Observations seen = paired_study();
    const Json expected = report_json(make_report(seen, {}));
    std::reverse(seen.rows.begin(), seen.rows.end());
    CHECK(report_json(make_report(seen, {})) == expected);
}

TEST_CASE("report: conditions on different displays stand in one table, also those that nobody has done yet") {
    Observations seen = paired_study();
    seen.displays = {{"a", "pen", false}, {"b", "tangible", false}, {"cast", "hand", true}};
    const Report report = make_report(seen, {});
    const ReportTable table = report_tables(report).front();
    REQUIRE(table.name == "displays");
    REQUIRE(table.rows.size() == 3);
    for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
    CHECK(table.rows[0][1] == "pen");
    CHECK(table.rows[0][4] == "0.3750");  // 15 of 40
    CHECK(table.rows[1][4] == "0.6250");
    CHECK(table.rows[2][2] == "typed in");
    CHECK(table.rows[2][4] == "n/a");
    const Json json = report_json(report);
    REQUIRE(json["displays"].size() == 3);
    CHECK(json["displays"][0]["sensitivity"].get<double>() == close_to(0.375));
    CHECK(json["displays"][0]["sensitivity_ci"][0].get<double>() < 0.375);
    CHECK(json["displays"][2]["sensitivity"].is_null());
    for (ConditionDisplay& one : seen.displays) one.display = "pen";
    CHECK(make_report(seen, {}).displays.empty());  // nothing to compare
}
