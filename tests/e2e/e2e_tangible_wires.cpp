// palpa tangible run on the plant program: real protocols on pseudo-terminals, both programs as people start them.

#include <cmath>
#include <csignal>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <functional>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "devices/force_sensor.h"
#include "devices/simulators/process.h"
#include "files/json.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::test;
using devices::simulators::SimulatorProcess;

namespace {

#ifdef __SANITIZE_ADDRESS__  // a step of the strip takes two periods of the loop there
constexpr const char* kFidelity = R"(, "fidelity": "linear")";
#else
constexpr const char* kFidelity = "";
#endif

void nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

bool within(double seconds, const std::function<bool()>& done) {
    for (const double until_s = devices::steady_s() + seconds; devices::steady_s() < until_s; nap(0.01)) {
        if (done()) return true;
    }
    return false;
}

void end(pid_t program) {
    ::kill(program, SIGKILL);
    ::waitpid(program, nullptr, 0);
}

struct PlantRow {
    double host_s = 0.0, depth_mm = 0.0, force_N = 0.0, left_N = 0.0;
    bool relaxed = false;
};

// The plant program with the strip, and a scene on it.
struct Bench {
    explicit Bench(std::vector<std::string> more = {},
                   const std::string& device = PALPA_SOURCE_DIR "/assets/devices/strip.json") {
        files::write_text_atomically(folder / "scene.json",
                                     R"({"name": "spring", "tissue": {"force_curve": {"stiffness_N_per_mm": 0.1,
            "greatest_depth_mm": 8}}, "mapping": {"kind": "direct"}, "tangible": {"device": ")" +
                                         device + "\"" + kFidelity + "}}");
        std::vector<std::string> arguments{device,
                                           "--nodes",
                                           "6",
                                           "--pause-s",
                                           "0.2",
                                           "--links",
                                           folder.path().string(),
                                           "--truth",
                                           (folder / "truth.tsv").string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        plant = std::make_unique<SimulatorProcess>(PALPA_PLANT, arguments);
    }

    // `palpa tangible run` for so many seconds; its JSON goes to out.json.
    pid_t start(int seconds, bool logs = false) const {
        const std::string scene = (folder / "scene.json").string(), out = (folder / "out.json").string();
        const std::string motors = "motors=" + (folder / "motors").string();
        const std::string sensor = "sensor=" + (folder / "sensor").string(), length = std::to_string(seconds);
        const pid_t program = ::fork();
        if (program != 0) return program;
        const int file = ::open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
        ::dup2(file, STDOUT_FILENO);
        const std::string log = (folder / "log").string();
        ::execl(PALPA_PROGRAM, "palpa", "tangible", "run", scene.c_str(), "--port", motors.c_str(), "--port",
                sensor.c_str(), "--seconds", length.c_str(), "--json", logs ? "--log" : nullptr, log.c_str(), nullptr);
        ::_exit(127);
    }

    std::vector<PlantRow> truth() const {
        std::string text = files::read_text(folder / "truth.tsv");
        text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));
        std::vector<PlantRow> rows;
        bool head = true;
        for (const std::string_view line : files::fields_of(text, '\n')) {
            std::array<double, 6> number{};
            const auto fields = files::fields_of(line, '\t');
            if (!std::exchange(head, false) && fields.size() == 6) {
                for (std::size_t i = 0; i < 6; ++i) files::parse_number(fields[i], number[i]);
                rows.push_back({number[0], number[1], number[2], number[3], number[5] == 1.0});
            }
        }
        return rows;
    }
    bool pressed() const {  // the device is driven, and pushes back
        const auto rows = truth();
        return !rows.empty() && !rows.back().relaxed && rows.back().force_N > 0.1;
    }
    bool relaxed() const {
        const auto rows = truth();
        return !rows.empty() && rows.back().relaxed;
    }
    std::string out_of_range() {
        ::kill(plant->pid(), SIGTERM);
        return plant->line();
    }

    TemporaryFolder folder;
    std::unique_ptr<SimulatorProcess> plant;
};

}  // namespace

TEST_CASE("plant: the strip renders a spring over its wires, and is relaxed afterwards") {
    constexpr int kAttempts = 5;  // a busy computer may be silent for 100 ms, and the guard relaxes the device for good
    for (int attempt = 1; attempt <= kAttempts; ++attempt) {
        Bench bench;
        const pid_t program = bench.start(9);
        int status = -1;
        ::waitpid(program, &status, 0);
        CHECK(status == 0);
        const files::Json report = files::read_json(bench.folder / "out.json");
        MESSAGE("report ", report.dump());
        CHECK(within(60.0, [&] { return bench.relaxed(); }));
        CHECK(bench.out_of_range() == "out_of_range 0");
        if (attempt < kAttempts && report["relaxed_ms"].get<double>() > 0.0) continue;
        CHECK(report["ticks"].get<int>() > 300);
        double worst_N = 0.0, greatest_N = 0.0;
        for (const PlantRow& row : bench.truth()) {
            if (row.relaxed) continue;
            greatest_N = std::max(greatest_N, row.force_N);
            worst_N = std::max(worst_N, std::abs(row.force_N - 0.1 * row.depth_mm));
        }
        MESSAGE("greatest force ", greatest_N, " N, worst error ", worst_N, " N");
        CHECK(greatest_N > 0.4);
        CHECK(greatest_N < 0.8);
        return;
    }
}

TEST_CASE("plant: Ctrl-C ends a run with its report and a whole log") {
    Bench bench;
    const pid_t program = bench.start(60, true);
    CHECK(within(60.0, [&] { return std::filesystem::exists(bench.folder / "log/ticks.tsv"); }));
    nap(2.0);
    ::kill(program, SIGINT);
    int status = -1;
    ::waitpid(program, &status, 0);
    CHECK(status == 0);
    const files::Json report = files::read_json(bench.folder / "out.json");
    CHECK(contains(report["notes"].dump(), "stopped by a signal before the press was over"));
    const std::string ticks = files::read_text(bench.folder / "log/ticks.tsv");
    CHECK(std::count(ticks.begin(), ticks.end(), '\n') == report["ticks"].get<int>() + 1);
    CHECK(files::read_json(bench.folder / "log/performance.json") == report);
}

TEST_CASE("plant: unplugged, garbage, SIGKILL: relaxed each time, and never a command out of range") {
    Bench bench({"--silent-s", "1", "--garbage-s", "1"});
    for (const int way : {SIGUSR1, SIGUSR2, SIGKILL}) {
        CAPTURE(way);
        pid_t program = -1;
        bool pressed = false;                      // the hand goes up and down: seen once is enough
        for (int i = 0; i < 5 && !pressed; ++i) {  // a busy computer may stop it before
            if (program > 0) end(program);
            program = bench.start(60);
            pressed = within(20.0, [&] { return bench.pressed(); });
        }
        CHECK(pressed);
        ::kill(way == SIGKILL ? program : bench.plant->pid(), way);
        CHECK(within(20.0, [&] { return bench.relaxed(); }));
        nap(1.5);  // plugged in again, and no more garbage: nobody has released it
        CHECK(bench.relaxed());
        end(program);
    }
    CHECK(bench.out_of_range() == "out_of_range 0");
}

TEST_CASE("plant: what a range of the wires takes away from the drives is counted and told") {
    const TemporaryFolder folder;
    std::string device = files::read_text(PALPA_SOURCE_DIR "/assets/devices/strip.json");
    for (const std::string range = R"("range_N": [0, 5.5])"; device.find(range) != std::string::npos;)
        device.replace(device.find(range), range.size(), R"("range_N": [0, 0.3])");
    files::write_text_atomically(folder / "careful.json", device);
    Bench bench({}, (folder / "careful.json").string());
    int status = -1;
    ::waitpid(bench.start(2), &status, 0);
    CHECK(status == 0);
    const files::Json report = files::read_json(bench.folder / "out.json");
    MESSAGE("report ", report.dump());
    CHECK(report["guard"]["limited_values"].get<int>() > 0);  // at rest the strip is held by 0.56 N
    CHECK(report["guard"]["limited_values"].get<int>() <= 2 * report["guard"]["commands"].get<int>());
    CHECK(report["notes"].dump().find("the drives got less than ticks.tsv says") != std::string::npos);
}
