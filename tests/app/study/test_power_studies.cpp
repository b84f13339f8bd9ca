// Simulated studies in memory against the same studies in logs, and power runs that are stopped, shared and merged.

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>

#include "app/study/power_run.h"
#include "app/study/power_studies.h"
#include "app/study/simulate.h"
#include "files/text.h"
#include "study/read_logs.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::app;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

const fs::path kEffects = PALPA_SOURCE_DIR "/assets/protocols/effects.json";

study::Observations in_memory(const study::Protocol& protocol, int participants, const SimulatedEffect& effect) {
    const StudyScenes scenes = load_study_scenes(protocol);
    PowerSessions sessions(protocol.conditions.size());
    SimulatedEffect what = effect;
    what.reference = reference_of(protocol, scenes, "");
    return first_people(protocol, study_in_memory(protocol, scenes, participants, 7, what, 60.0, sessions),
                        participants);
}

PowerOptions small_run() {
    PowerOptions options;
    options.participants = {3, 4};
    options.runs = 4;
    options.quiet = true;
    options.report.bootstrap.resamples = 100;
    return options;
}

bool same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

TEST_CASE("power: a study in memory has the results that its logs have") {
    const study::Protocol protocol = study::read_protocol(kEffects);
    const TemporaryFolder folder;
    SimulateOptions options;
    options.participants = 4;
    options.seed = 7;
    options.output = folder / "log";
    options.samples = false;
    simulate_study(protocol, options);
    const study::Observations logged = study::read_study(folder / "log");
    const study::Observations seen = in_memory(protocol, 4, {1.0, 1.0});
    CHECK(seen.conditions == logged.conditions);
    CHECK(seen.participants == logged.participants);
    CHECK(seen.groups == logged.groups);
    CHECK(seen.group_of == logged.group_of);
    CHECK(seen.nodules == logged.nodules);
    REQUIRE(seen.rows.size() == logged.rows.size());
    int found = 0;
    for (std::size_t i = 0; i < seen.rows.size(); ++i) {
        CAPTURE(i);
        const study::Observation &a = seen.rows[i], &b = logged.rows[i];
        CHECK(a.condition == b.condition);
        CHECK(a.participant == b.participant);
        CHECK(a.nodule == b.nodule);
        CHECK(a.repeat == b.repeat);
        CHECK(a.tp == b.tp);
        CHECK(a.fn == b.fn);
        CHECK(a.fp == b.fp);
        found += static_cast<int>(a.tp);
    }
    CHECK(found > 0);
    REQUIRE(seen.judged.size() == logged.judged.size());
    for (std::size_t i = 0; i < seen.judged.size(); ++i) {
        CAPTURE(i);
        CHECK(seen.judged[i].id == logged.judged[i].id);
        CHECK(seen.judged[i].condition == logged.judged[i].condition);
        CHECK(seen.judged[i].reading.nl == logged.judged[i].reading.nl);
        CHECK(seen.judged[i].reading.ll == logged.judged[i].reading.ll);
        CHECK(seen.trials[i].path_m == close_to(logged.trials[i].path_m));
        CHECK(seen.trials[i].duration_s == close_to(logged.trials[i].duration_s));
        CHECK(seen.trials[i].max_force_N == close_to(logged.trials[i].max_force_N));
    }
    CHECK(seen.primary.has_value());
}

TEST_CASE(
    "power: without an effect every condition has the reference's trials, and the first people are a study of their "
    "own") {
    const study::Protocol protocol = study::read_protocol(kEffects);
    const StudyScenes scenes = load_study_scenes(protocol);
    CHECK(protocol.conditions[reference_of(protocol, scenes, "")].id == "display ratio");
    CHECK(protocol.conditions[reference_of(protocol, scenes, "off")].id == "off");
    CHECK(contains(message_of([&] { reference_of(protocol, scenes, "on"); }), "--reference: found 'on'"));
    const study::Observations null = in_memory(protocol, 6, {0.0, 1.0});
    const study::Observations full = in_memory(protocol, 6, {1.0, 1.0});
    const auto hits_without_law = [](const study::Observations& seen) {
        std::int64_t sum = 0;
        for (const study::Observation& row : seen.rows)
            sum += seen.conditions[static_cast<std::size_t>(row.condition)] == "off" ? row.tp : 0;
        return sum;
    };
    CHECK(hits_without_law(null) > 0);  // its tests show the display ratio
    CHECK(hits_without_law(full) == 0);
    const study::Observations few = in_memory(protocol, 3, {1.0, 1.0});
    const study::Observations first = first_people(protocol, full, 3);
    REQUIRE(few.rows.size() == first.rows.size());
    for (std::size_t i = 0; i < few.rows.size(); ++i) {
        CHECK(few.rows[i].tp == first.rows[i].tp);
        CHECK(few.rows[i].condition == first.rows[i].condition);
    }
    CHECK(few.group_of == first.group_of);
}

TEST_CASE("power: one process, two threads, parts that are merged and a run that goes on give the same results") {
    const study::Protocol protocol = study::read_protocol(kEffects);
    const TemporaryFolder folder;
    PowerOptions options = small_run();
    const PowerOutcome alone = measure_power(protocol, options);
    REQUIRE(alone.complete);
    REQUIRE_FALSE(alone.results.empty());
    options.output = folder / "power";
    options.jobs = 2;
    options.runs = 2;
    CHECK(measure_power(protocol, options).computed == 2);
    options.runs = 4;
    options.parts = 2;
    options.part = 2;
    const PowerOutcome part = measure_power(protocol, options);
    CHECK(part.computed == 1);
    CHECK(part.already_there == 2);
    CHECK_FALSE(part.complete);
    options.parts = options.part = 1;
    options.merge = true;
    CHECK(contains(message_of([&] { measure_power(protocol, options); }),
                   "3 of 4 studies (3 is the first that is missing), expected all of them before --merge"));
    options.merge = false;
    const PowerOutcome rest = measure_power(protocol, options);
    CHECK(rest.computed == 1);
    CHECK(rest.complete);
    REQUIRE(rest.results.size() == alone.results.size());
    for (std::size_t i = 0; i < alone.results.size(); ++i) {
        CAPTURE(i);
        CHECK(rest.results[i].what.quantity == alone.results[i].what.quantity);
        CHECK(rest.results[i].what.method == alone.results[i].what.method);
        CHECK(rest.results[i].what.b == alone.results[i].what.b);
        CHECK(rest.results[i].rejections.hits == alone.results[i].rejections.hits);
        CHECK(rest.results[i].coverage.hits == alone.results[i].coverage.hits);
        CHECK(same_number(rest.results[i].mean_estimate, alone.results[i].mean_estimate));
    }
}

TEST_CASE("power: parts of two power runs in one folder are refused, and say which") {
    const study::Protocol protocol = study::read_protocol(kEffects);
    const TemporaryFolder folder;
    PowerOptions options = small_run();
    options.runs = 2;
    options.participants = {2};
    options.effects = {0.0};
    options.output = folder / "power";
    measure_power(protocol, options);
    options.seed = 2;
    CHECK(contains(message_of([&] { measure_power(protocol, options); }),
                   "power_run.json: seed: found 1, expected 2: two power runs never share a folder"));
    options.seed = 1;
    fs::copy_file(fs::directory_iterator(folder / "power/runs")->path(),
                  folder / "power/runs/run-00009-0123456789ab.tsv");
    CHECK(contains(message_of([&] { measure_power(protocol, options); }), "a study of another power run"));
}

TEST_CASE("power: what cannot be simulated in memory is refused with its condition") {
    for (const char* name : {"threshold", "tactile"}) {
        CAPTURE(name);
        const study::Protocol protocol =
            study::read_protocol(std::string(PALPA_SOURCE_DIR "/assets/protocols/") + name + ".json");
        CHECK(contains(message_of([&] { check_power_protocol(protocol, load_study_scenes(protocol)); }),
                       "nothing else is simulated in memory"));
    }
    const study::Protocol softer = study::read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    const study::Observations null = in_memory(softer, 2, {0.0, 1.0});
    CHECK(null.choices.size() == null.stiffer.size());
    CHECK(null.choices.size() == 2 * softer.conditions.size() * 5 * 8);
}
