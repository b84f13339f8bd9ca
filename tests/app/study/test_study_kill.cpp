// A simulated study is killed at random moments: no finished trial is lost, every file can be read, and it goes on.

#include <chrono>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "files/json.h"
#include "files/text.h"
#include "study/random.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

constexpr int kParticipants = 20;
constexpr double kPatience_s = 200.0;  // sanitizers are slow
constexpr int kTrials = 3 * kParticipants;
const std::string kProtocol = PALPA_SOURCE_DIR "/assets/protocols/effects.json";

pid_t start_study(const fs::path& log) {
    const pid_t child = fork();
    if (child != 0) return child;
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
    const std::string people = std::to_string(kParticipants);
    execl(PALPA_PROGRAM, PALPA_PROGRAM, "study", "simulate", kProtocol.c_str(), "--participants", people.c_str(),
          "--seed", "3", "-o", log.c_str(), "-j", "2", nullptr);
    _exit(127);
}

// Kills it after the delay. True if it was done before.
bool run_and_kill(const fs::path& log, double delay_s, int& status) {
    const pid_t child = start_study(log);
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(delay_s);
    while (std::chrono::steady_clock::now() < until) {
        if (waitpid(child, &status, WNOHANG) == child) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    return false;
}

// Bytes of the events of every finished trial. Reads every file on the way.
std::map<std::string, std::string> finished(const fs::path& log) {
    std::map<std::string, std::string> out;
    if (!fs::exists(log)) return out;
    for (const auto& entry : fs::recursive_directory_iterator(log)) {
        if (!entry.is_regular_file()) continue;
        const std::string name = entry.path().filename().string();
        if (name.find(".part-") != std::string::npos) continue;  // was never given its name
        CAPTURE(entry.path().string());
        const std::string text = read_text(entry.path());
        if (entry.path().extension() == ".json") CHECK_NOTHROW(parse_json(text, name));
        if (name.find("_events.tsv") == std::string::npos) continue;
        std::vector<std::string> notes;
        RunLog run;
        CHECK_NOTHROW(run = read_run(entry.path(), notes));
        if (run.finished) out[fs::relative(entry.path(), log).string()] = text;
    }
    return out;
}

Json results_of(const fs::path& log) {
    Json json = report_json(make_report(read_study(log), {}));
    json.erase("interrupted_trials");
    json.erase("notes");
    for (Json& row : json["plan"]) row.erase("interrupted");
    return json;
}

}  // namespace

TEST_CASE("command study: killed at random moments it loses no finished trial, and ends as if nothing had happened") {
    const char* asked = std::getenv("PALPA_KILLS");
    const int kills = asked != nullptr ? std::atoi(asked) : 10;
    constexpr std::uint64_t kSeed = 99;
    CAPTURE(kSeed);
    Random random(kSeed);
    const TemporaryFolder folder;
    int status = 0;
    const auto began = std::chrono::steady_clock::now();
    REQUIRE(run_and_kill(folder / "whole", kPatience_s, status));
    const double whole_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    REQUIRE(status == 0);
    const Json expected = results_of(folder / "whole");
    int killed = 0, studies = 0, interrupted = 0;
    while (killed < kills) {
        const fs::path log = folder / ("log-" + std::to_string(++studies));
        std::map<std::string, std::string> before;
        // a study that came to its end by itself begins anew
        for (bool done = false; !done && killed < kills;) {
            done = run_and_kill(log, random.uniform(0.0, 0.7 * whole_s), status);
            killed += done ? 0 : 1;
            CAPTURE(killed);
            const auto after = finished(log);
            for (const auto& [name, text] : before) {
                CAPTURE(name);
                REQUIRE(after.count(name) == 1);
                CHECK(after.at(name) == text);
            }
            before = after;
        }
        REQUIRE(run_and_kill(log, kPatience_s, status));
        CHECK(status == 0);
        CHECK(finished(log).size() == kTrials);
        const Observations seen = read_study(log);
        interrupted += static_cast<int>(seen.interrupted_trials);
        CHECK(results_of(log) == expected);
        fs::remove_all(log);
    }
    CHECK(interrupted > 0);  // else the kills hit nothing
    MESSAGE("", killed, " kills in ", studies, " studies, ", interrupted, " trials interrupted and repeated");
}
