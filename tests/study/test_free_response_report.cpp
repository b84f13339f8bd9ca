#include <chrono>
#include <doctest/doctest.h>
#include <random>

#include "study/observations.h"
#include "study/report.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/study/froc_sets.h"

using namespace palpa::study;
using namespace palpa::test;
using palpa::files::Json;

namespace {

// The stored set as a reader of logs or tables hands it over.
Observations observed(const FreeResponse& data) {
    Observations seen;
    seen.conditions = data.conditions;
    seen.participants = data.participants;
    for (std::size_t i = 0; i < data.conditions.size(); ++i) {
        for (std::size_t j = 0; j < data.participants.size(); ++j) {
            for (std::size_t k = 0; k < data.cases.size(); ++k) {
                seen.judged.push_back({static_cast<int>(i), static_cast<int>(j), data.cases[k].id,
                                       data.cases[k].lesions, *data.at(i, j, k), true});
            }
        }
    }
    return seen;
}

Json report_of(const Observations& seen) {
    Json json;
    add_free_response(free_response_report(seen, 0.95), json);
    return json.is_null() ? Json() : json["free_response"];
}

}  // namespace

TEST_CASE("free-response report: figures and tests of a stored set as JSON") {
    const Json stored = froc_json("froc_small.json");
    const Json json = report_of(observed(froc_set(stored)));
    REQUIRE(json["figures"].size() == 6);
    CHECK(json["figures"][0]["wafroc"].get<double>() == close_to(0.875));
    CHECK(json["figures"][0]["max_llf"].get<double>() == close_to(6.0 / 7.0));
    CHECK(json["figures"][0]["max_nlf"].get<double>() == close_to(0.625));
    REQUIRE(json["tests"].size() == 4);
    const Json& test = json["tests"][0];
    CHECK(test["figure"] == "wafroc");
    CHECK(test["a"] == "A");
    CHECK(test["f"].get<double>() == close_to(3.246506).epsilon(1e-6));
    CHECK(test["ddf"].get<double>() == close_to(2.0));
    CHECK(test["se"].get<double>() == close_to(.127187173).epsilon(1e-8));
    CHECK(json["cases_without_lesions"] == 4);
    CHECK(json["notes"].empty());
}

TEST_CASE(
    "free-response report: incomplete crossing leaves people out of the tests and names what they did not judge") {
    Observations seen = observed(froc_set(froc_json("froc_small.json")));
    seen.judged.erase(seen.judged.begin());
    const Json json = report_of(seen);
    CHECK(json["participants_tested"] == 2);
    CHECK(contains(json["notes"][0].get<std::string>(), "p1 (case c1 under A)"));
    CHECK(json["figures"].size() == 6);
    std::erase_if(seen.judged, [](const JudgedCase& one) { return one.condition == 1 && one.id == "c2"; });
    const Json none = report_of(seen)["tests"][0];
    CHECK(contains(none["status"].get<std::string>(), "nobody judged every case"));
    CHECK(none["f"].is_null());
    CHECK(none["p"].is_null());
}

TEST_CASE("free-response report: no lesion-free case leaves wafroc1 alone, and marks without ratings leave nothing") {
    Observations seen = observed(froc_set(froc_json("froc_small.json")));
    std::erase_if(seen.judged, [](const JudgedCase& one) { return one.lesions.empty(); });
    const Json json = report_of(seen);
    REQUIRE(json["tests"].size() == 1);
    CHECK(json["tests"][0]["figure"] == "wafroc1");
    CHECK(json["figures"][0]["wafroc"].is_null());
    CHECK(contains(json["notes"][0].get<std::string>(), "No case is without lesions"));
    seen.judged[3].rated = false;
    const Json none = report_of(seen);
    CHECK(none["figures"].empty());
    CHECK(contains(none["notes"][0].get<std::string>(), "1 of 24 judged cases have marks without one"));
    CHECK(report_of(Observations()).is_null());
}

TEST_CASE("free-response report: conditions whose answers are typed in are named as left out") {
    Observations seen = observed(froc_set(froc_json("froc_small.json")));
    CHECK(report_of(seen)["notes"].empty());
    seen.conditions.emplace_back("hand");
    seen.displays = {{"A", "pen", false}, {"hand", "hand", true}, {"nobody's", "hand", true}};
    seen.rows.push_back({static_cast<int>(seen.conditions.size()) - 1, 0, -1, 0, 1, 1, 0});
    const Json notes = report_of(seen)["notes"];
    REQUIRE(notes.size() == 1);
    CHECK(notes[0] == "Answers that were typed in have no marks, and no free-response figures: hand");
}

TEST_CASE("free-response report: a condition without any lesion is named, and keeps no other from the tests") {
    Observations seen = observed(froc_set(froc_json("froc_small.json")));
    std::erase_if(seen.judged, [](const JudgedCase& one) { return one.lesions.empty(); });
    const Json before = report_of(seen);
    const auto empty = static_cast<int>(seen.conditions.size());
    seen.conditions.push_back("plain");
    for (int j = 0; j < 3; ++j) seen.judged.push_back({empty, j, "plain", {}, {}, true});
    const Json json = report_of(seen);
    REQUIRE(json["tests"].size() == 1);
    CHECK(json["tests"] == before["tests"]);
    CHECK(json["participants_tested"] == 3);
    CHECK(contains(json["notes"][0].get<std::string>(), "No case under plain has a lesion"));
}

TEST_CASE("free-response report: with one lesion type, in one case, the jackknife cannot be computed and says so") {
    Observations seen = observed(froc_set(froc_json("froc_small.json")));
    std::string with;
    std::erase_if(seen.judged, [&](const JudgedCase& one) {
        if (with.empty() && !one.lesions.empty()) with = one.id;
        return !one.lesions.empty() && one.id != with;
    });
    const Json json = report_of(seen);
    CHECK(json["cases_with_lesions"] == 1);
    CHECK(json["figures"][0]["wafroc"].is_number());
    CHECK(contains(json["tests"][0]["status"].get<std::string>(), "the jackknife needs two cases of each kind"));
    CHECK(json["tests"][0]["p"].is_null());
}

TEST_CASE("free-response report: twenty people, 200 cases, two conditions") {
    constexpr std::uint32_t kSeed = 2;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> rating(0, 5);
    Observations seen;
    seen.conditions = {"a", "b"};
    for (int j = 0; j < 20; ++j) seen.participants.push_back("p" + std::to_string(j));
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 20; ++j) {
            for (int k = 0; k < 200; ++k) {
                JudgedCase one{i, j, "c" + std::to_string(k), {}, {}, true};
                if (const int z = rating(random); z > 2) one.reading.nl.push_back(z - 2);
                for (int l = 0; k % 2 == 0 && l < 1 + k % 3; ++l) {
                    one.lesions.push_back("l" + std::to_string(l));
                    const int z = rating(random);
                    one.reading.ll.push_back(z == 0 ? kUnmarked : z);
                }
                seen.judged.push_back(one);
            }
        }
    }
    const auto begin = std::chrono::steady_clock::now();
    const Json json = report_of(seen);
    MESSAGE("took ", std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), " s");
    CHECK(json["tests"][0]["status"] == "computed");
}
