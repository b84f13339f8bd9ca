#include <cmath>
#include <doctest/doctest.h>

#include "study/report.h"
#include "study/simulated_observer.h"
#include "tests/close_to.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

void add_stiffer(const std::vector<LevelAnswers>& levels, int condition, int participant, Observations& seen) {
    for (const LevelAnswers& level : levels) {
        seen.stiffer.push_back({condition, participant, StiffnessAxis::second_first, level.x, level.stiffer, level.n});
    }
}

// People whose sd is 0.6 under `off` and 0.2 under `on`.
Observations two_conditions(int people, std::uint64_t seed) {
    Random random(seed);
    Observations seen;
    for (const char* name : {"off", "on"}) index_of(name, seen.conditions);
    for (int person = 0; person < people; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        add_stiffer(draw_answers(paper_levels(), 80, {0.0, 0.6, 0.02}, random), 0, person, seen);
        add_stiffer(draw_answers(paper_levels(), 80, {0.0, 0.2, 0.02}, random), 1, person, seen);
    }
    return seen;
}

ReportOptions few_resamples() {
    ReportOptions options;
    options.bootstrap.resamples = 200;
    return options;
}

}  // namespace

TEST_CASE("psychometric report: all people and each person, by condition, and the ratio of JNDs") {
    constexpr std::uint64_t kSeed = 15;
    CAPTURE(kSeed);
    const Json json = report_json(make_report(two_conditions(12, kSeed), few_resamples()));
    const Json& curves = json["psychometric"];
    REQUIRE(curves.size() == 26);
    const Json& all = curves[0];
    CHECK(all["condition"] == "off");
    CHECK(all["participant"].is_null());
    CHECK(all["participants"] == 12);
    CHECK(all["n"] == 960);
    CHECK(all["axis"] == "second/first");
    CHECK(all["status"] == "ok");
    CHECK(all["intervals"] == "bootstrap over people");
    CHECK(all["sd"].get<double>() == close_to(0.6).epsilon(0.2));
    CHECK(all["sd_ci"][0].get<double>() < all["sd"].get<double>());
    const double percent = 100.0 * std::expm1(0.6744897501960817 * all["sd"].get<double>());
    CHECK(all["jnd_percent"].get<double>() == close_to(percent).epsilon(1e-12));
    for (const char* key : {"pse", "pse_ci", "jnd_percent_ci", "lapse", "deviance"}) CHECK(all.contains(key));
    CHECK(curves[1]["participant"] == "p0");
    CHECK(curves[1]["intervals"] == "profile likelihood");
    REQUIRE(json["psychometric_pairs"].size() == 1);
    const Json& pair = json["psychometric_pairs"][0];
    CHECK(pair["a"] == "off");
    CHECK(pair["b"] == "on");
    CHECK(pair["jnd_ratio"].get<double>() > 2.0);
    CHECK(pair["ci"][0].get<double>() > 1.5);
    REQUIRE(json["notes"].size() == 1);
    CHECK(contains(json["notes"][0].get<std::string>(), "of 12 people need at least"));  // more than 200 resamples
}

TEST_CASE("psychometric report: people who did one condition alone do not change the ratio of those who did both") {
    constexpr std::uint64_t kSeed = 16;
    CAPTURE(kSeed);
    Observations seen = two_conditions(8, kSeed);
    const Json both = report_json(make_report(seen, few_resamples()))["psychometric_pairs"][0];
    CHECK(both["left_out"] == 0);
    Random random(kSeed);
    for (int person = 8; person < 16; ++person) {  // they feel far smaller differences
        index_of("p" + std::to_string(person), seen.participants);
        add_stiffer(draw_answers(paper_levels(), 80, {0.0, 0.05, 0.02}, random), 0, person, seen);
    }
    const Json more = report_json(make_report(seen, few_resamples()))["psychometric_pairs"][0];
    CHECK(more["left_out"] == 8);
    CHECK(more["jnd_ratio"].get<double>() == close_to(both["jnd_ratio"].get<double>()).epsilon(1e-9));
    CHECK(more["ci"][0].get<double>() > 0.5 * both["ci"][0].get<double>());
}

TEST_CASE("psychometric report: nobody named, so the answers count as independent") {
    Observations seen;
    for (const char* name : {"off", "on"}) index_of(name, seen.conditions);
    Random random(16);
    add_stiffer(draw_answers(paper_levels(), 240, {0.0, 0.6, 0.02}, random), 0, -1, seen);
    add_stiffer(draw_answers(paper_levels(), 240, {0.0, 0.2, 0.02}, random), 1, -1, seen);
    const Report report = make_report(seen, few_resamples());
    REQUIRE(report.psychometrics.curves.size() == 2);
    CHECK(report.psychometrics.curves[0].method == IntervalMethod::profile);
    CHECK(report.psychometrics.curves[0].participants == 0);
    REQUIRE(report.psychometrics.pairs.size() == 1);
    CHECK(report.psychometrics.pairs[0].ci.closed());
    CHECK(contains(report_markdown(report), "| off | all | 240 | second/first |"));
}

TEST_CASE("psychometric report: a curve that hardly rises has no difference in per cent, of dozens of digits or any") {
    Observations seen;
    index_of("flat", seen.conditions);
    add_stiffer({{-0.5, 100, 200}, {0.5, 101, 200}}, 0, -1, seen);
    const Json json = report_json(make_report(seen, few_resamples()));
    CHECK(json["psychometric"][0]["sd"].get<double>() > 10.0);
    CHECK(json["psychometric"][0]["jnd_percent"].is_null());
}

TEST_CASE("psychometric report: answers at chance, at a step and at one level have nulls and say why") {
    Observations seen;
    for (const char* name : {"chance", "step", "one level"}) index_of(name, seen.conditions);
    add_stiffer({{-0.5, 10, 20}, {0.5, 10, 20}}, 0, -1, seen);
    add_stiffer({{-0.5, 0, 20}, {0.5, 20, 20}}, 1, -1, seen);
    add_stiffer({{0.5, 15, 20}}, 2, -1, seen);
    const Report report = make_report(seen, few_resamples());
    const Json json = report_json(report);
    CHECK(json["psychometric"][0]["status"] == "open");
    CHECK(json["psychometric"][0]["sd"].is_null());
    CHECK(json["psychometric"][1]["status"] == "separated");
    CHECK(json["psychometric"][1]["jnd_percent"].is_null());
    CHECK(json["psychometric"][1]["sd_ci"][0].is_null());
    CHECK(json["psychometric"][2]["status"] == "open");
    CHECK(json["psychometric"][2]["deviance"].is_null());
    REQUIRE(json["notes"].size() == 1);
    CHECK(contains(json["notes"][0].get<std::string>(), "condition 'one level': all answers are at one level"));
    for (const Json& pair : json["psychometric_pairs"]) CHECK(pair["jnd_ratio"].is_null());
    for (const ReportTable& table : report_tables(report)) {
        CAPTURE(table.name);
        for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
    }
}

TEST_CASE("psychometric report: few people are named as few; without choices there is nothing") {
    const Report few = make_report(two_conditions(3, 17), few_resamples());
    REQUIRE(few.notes.size() == 3);
    CHECK(contains(few.notes[0], "draws from 3 people"));
    CHECK(contains(few.notes[2], "of 3 people need"));  // more than 200 resamples
    CHECK_FALSE(report_json(make_report({}, {})).contains("psychometric"));
}

TEST_CASE("psychometric report: no lapse if none is allowed") {
    ReportOptions options = few_resamples();
    options.greatest_lapse = 0.0;
    const Report report = make_report(two_conditions(2, 18), options);
    for (const PsychometricResult& curve : report.psychometrics.curves) CHECK(curve.fit.lapse == 0.0);
}

TEST_CASE("psychometric report: a ratio has its limit also where one condition is answered by chance") {
    constexpr std::uint64_t kSeed = 16;
    CAPTURE(kSeed);
    Observations seen = two_conditions(8, kSeed);
    for (StifferAnswers& answers : seen.stiffer) {
        if (answers.condition != 0) continue;
        const int rise =
            answers.participant < 4 ? 1 : -2;  // together the answers fall with x; of some resamples they rise
        answers.stiffer = answers.n / 2 + (answers.x > 0.0 ? rise : 0);
    }
    const Json json = report_json(make_report(seen, few_resamples()));
    CHECK(json["psychometric"][0]["sd"].is_null());
    REQUIRE(json["psychometric_pairs"].size() == 1);
    const Json& pair = json["psychometric_pairs"][0];
    CHECK(pair["a"] == "off");
    CHECK(pair["jnd_ratio"].is_null());
    REQUIRE(pair["ci"][0].is_number());
    CHECK(pair["ci"][0].get<double>() > 1.0);
    CHECK(pair["ci"][1].is_null());  // the flat curve's JND is above any other
}
