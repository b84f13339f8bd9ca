// palpa calibrate record with simulated pens and sensors, end to end.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <map>
#include <signal.h>
#include <string>
#include <thread>

#include "devices/simulators/process.h"
#include "files/folder_lock.h"
#include "files/json.h"
#include "files/table.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;
using palpa::devices::simulators::SimulatorProcess;

namespace {

const std::string kRecord = "timeout 100 " PALPA_PROGRAM " calibrate record ";
const std::string kHand = " --steps 20 --greatest-N 2.6 --period-s 4 ";
const std::string kPen = PALPA_PEN_SIMULATOR + kHand;

}  // namespace

TEST_CASE("record: pen and Net F/T give points until the curve is known; they fit, and both raw streams are kept") {
    const TemporaryFolder folder;
    const std::string session = (folder / "s").string();
    SimulatorProcess sensor(PALPA_NETFT_SIMULATOR, {"--rate-Hz", "2000", "--steps", "20", "--greatest-N", "2.6",
                                                    "--period-s", "4", "--noise-N", "0.002"});
    const std::string netft = " --sensor netft:127.0.0.1:" + sensor.port();
    const Called record = shell(kPen + "--seconds 60 | " + kRecord + "-o " + session + netft +
                                " --levels - --steady-s 0.1 --seconds 50 --json");
    CAPTURE(record.err);
    REQUIRE(record.status == 0);
    const Json json = parse_json(record.out, "stdout");
    CHECK(json["done"] == true);
    CHECK(json["repeats"].get<int>() >= 3);
    CHECK(json["sensor"]["health"]["lost"] == 0);
    CHECK(json["sensor"]["health"]["overflowed"] == 0);
    CHECK(std::abs(json["sensor"]["zero_N"].get<double>()) < 0.01);
    CHECK(contains(record.err, "1 of 3 repeats"));

    const Called fit = shell("timeout 60 " PALPA_PROGRAM " calibrate fit " + session + "/points.csv -o " +
                             (folder / "p.json").string() + " --json");
    REQUIRE(fit.status == 0);
    const Json fitted = parse_json(fit.out, "stdout");
    // the simulated pen: level = log(F / 0.05) / log(2.5 / 0.05)
    CHECK(fitted["median_relative_error"].get<double>() < 0.01);
    CHECK(fitted["force_at_full_N"].get<double>() == close_to(2.5).epsilon(0.05));
    const std::string forces = read_text(session + "/forces-01.tsv");
    CHECK(contains(forces, "t_host_s\tt_device_s\tforce_N\traw"));
    CHECK(std::count(forces.begin(), forces.end(), '\n') > 10000);
    CHECK(contains(read_text(session + "/levels-01.tsv"), "t_host_s\tt_device_s\tphase\tlevel"));

    const Called again = shell(kRecord + "-o " + session + netft + " --levels /dev/null");
    CHECK(again.status == 2);
    CHECK(contains(again.err, "--resume"));
}

TEST_CASE("record: killed in the middle, all that was captured is there, and it is gone on with") {
    const TemporaryFolder folder;
    const std::string session = (folder / "s").string();
    SimulatorProcess sensor(PALPA_LOAD_CELL_SIMULATOR,
                            {"--rate-Hz", "200", "--steps", "20", "--greatest-N", "2.6", "--period-s", "4",
                             "--silent-s", "1.5", "--link", (folder / "cell").string()});
    const std::string serial = " --sensor serial:" + sensor.port() + " --N-per-count 2.5e-5 --levels - --steady-s 0.1 ";
    shell(kPen + "--seconds 8 | timeout -s KILL 7 " PALPA_PROGRAM " calibrate record -o " + session + serial);
    std::string before = read_text(session + "/points.csv");
    const auto had = std::count(before.begin(), before.end(), '\n') - 1;
    CHECK(had > 5);
    CHECK(before.back() == '\n');
    CHECK(std::count(before.begin(), before.end(), ',') == 4 * (had + 1));

    // as if the computer had been started anew since, its clock back near zero
    for (std::size_t line = before.find('\n'); line + 1 < before.size(); line = before.find('\n', line + 1))
        before.insert(line + 1, "9");
    write_text_atomically(session + "/points.csv", before);

    const Called other = shell(kRecord + "-o " + session + " --sensor serial:" + sensor.port() +
                               " --N-per-count 1e-3 --levels /dev/null --resume");
    CHECK(other.status == 2);
    CHECK(contains(other.err, "session.json: N_per_count"));
    // the cell is unplugged for a moment once its readings are written; the run needs one lift (4 s at most) for its zero
    std::jthread unplugs([&](const std::stop_token& stop) {
        const std::filesystem::path forces = session + "/forces-02.tsv";
        while (!stop.stop_requested() &&
               !(std::filesystem::exists(forces) && std::filesystem::file_size(forces) > 1000))
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        ::kill(sensor.pid(), SIGUSR1);
    });
    // a goal out of reach: the press in which the cell was unplugged may be the third, and would end the session
    const Called resumed =
        shell(kPen + "--seconds 12 | " + kRecord + "-o " + session + serial + "--resume --goal 0.001 --json");
    unplugs.request_stop();
    CAPTURE(resumed.err);
    REQUIRE(resumed.status == 0);
    const Json json = parse_json(resumed.out, "stdout");
    const std::string after = read_text(session + "/points.csv");
    CHECK(after.substr(0, before.size()) == before);
    CHECK(json["points"].get<long>() > had + 5);
    const Called fit = shell(PALPA_PROGRAM " calibrate fit " + session + "/points.csv -o " + session + "/p.json");
    CAPTURE(fit.err);
    CHECK(fit.status == 0);                                                        // times that rise all through
    CHECK(json["sensor"]["zero_N"].get<double>() == close_to(2.1).epsilon(0.01));  // 84,000 counts without load
    CHECK(json["sensor"]["health"]["stalls"].get<int>() >= 1);
    CHECK(contains(resumed.err, "has stopped"));
    CHECK(std::filesystem::exists(session + "/forces-02.tsv"));
    CHECK(std::filesystem::file_size(session + "/forces-01.tsv") > 1000);

    // the cell was turned round since
    SimulatorProcess pulls(PALPA_LOAD_CELL_SIMULATOR, {"--rate-Hz", "200", "--steps", "20", "--greatest-N", "2.6",
                                                       "--period-s", "4", "--counts-per-N", "-40000"});
    const Called turned =
        shell(kPen + "--seconds 9 | " + kRecord + "-o " + session + " --sensor serial:" + pulls.port() +
              " --N-per-count 2.5e-5 --levels - --steady-s 0.1 --resume --json");
    CAPTURE(turned.err);
    CHECK(contains(turned.err, "warning: the force was below zero in a press: reverse the sign of --N-per-count"));
    CHECK(read_text(session + "/points.csv") == after);
}

TEST_CASE("record: what a scale shows is typed in while the pen is held still") {
    for (const std::string field : {"pressure", "contact_area"}) {
        CAPTURE(field);
        const TemporaryFolder folder;
        const std::string session = (folder / "s").string();
        const std::string fifo = (folder / "levels").string();
        // one step: the pen is held at one level for 5 of 6 seconds
        const Called record =
            shell("mkfifo " + fifo + "; " PALPA_PEN_SIMULATOR " --steps 1 --period-s 6 --seconds 7 >" + fifo +
                  " & (echo abc; for i in 1 2 3 4 5 6 7 8 9 10 11 12; do sleep 0.5; echo 12; done; sleep 2) | " +
                  kRecord + "-o " + session + " --sensor typed --level " + field + " --levels " + fifo + " --json");
        CAPTURE(record.err);
        REQUIRE(record.status == 0);
        CHECK(contains(record.err, "found 'abc', expected what the scale shows"));
        CHECK(parse_json(record.out, "stdout")["points"].get<int>() >= 1);
        CHECK(contains(read_text(session + "/points.csv"), number_text(12 * 9.80665e-3)));
        CHECK(contains(read_text(session + "/forces-01.tsv"), "\t" + number_text(12 * 9.80665e-3) + "\t12\n"));
    }
}

TEST_CASE("record: the greatest contact area is in its range, whatever its width is rounded to") {
    const TemporaryFolder folder;
    const std::string fifo = (folder / "levels").string();
    const Called record = shell("mkfifo " + fifo + "; (for i in $(seq 200); do echo 1.0000; sleep 0.01; done) >" +
                                fifo + " & (sleep 1; echo 12; sleep 2) | " + kRecord + "-o " + (folder / "s").string() +
                                " --sensor typed --level contact_area --levels " + fifo + " --json");
    CAPTURE(record.err);
    REQUIRE(record.status == 0);
    CHECK_FALSE(contains(record.err, "no point follows"));
    CHECK(parse_json(record.out, "stdout")["points"].get<int>() >= 1);
}

TEST_CASE("record: a pipe of levels that nobody writes into does not keep the session from its end") {
    const TemporaryFolder folder;
    const std::string fifo = (folder / "levels").string();
    const Called none = shell("mkfifo " + fifo + "; " + kRecord + "-o " + (folder / "s").string() +
                              " --sensor typed --seconds 0.5 --levels " + fifo + " </dev/null");
    CHECK(none.status == 1);
    CHECK(contains(none.err, "no point was recorded"));
}

TEST_CASE("record: a session without points is begun again without --resume") {
    const TemporaryFolder folder;
    const std::string record =
        kRecord + "-o " + (folder / "s").string() + " --sensor typed --levels /dev/null </dev/null";
    for (int i = 0; i < 2; ++i) {
        const Called none = shell(record);
        CHECK(none.status == 1);
        CHECK(contains(none.err, "no point was recorded"));
    }
    CHECK(std::filesystem::exists(folder / "s/levels-02.tsv"));
    const Called levels =
        shell(kRecord + "-o " + (folder / "t").string() + " --sensor typed --levels " + folder.path().string());
    CHECK(levels.status == 2);
    CHECK(contains(levels.err, "found a folder, expected a file or a pipe"));
    const Called other =
        shell(kRecord + "-o " + (folder / "t").string() + " --sensor typed --baud 9600 --levels /dev/null");
    CHECK(other.status == 2);
    CHECK(contains(other.err, "--baud: found --sensor typed, expected --sensor serial:"));
}

TEST_CASE("record: two recordings at once do not share a folder") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "levels", "0\n");
    const std::string record =
        kRecord + "-o " + folder.path().string() + " --sensor typed --levels " + (folder / "levels").string();
    {
        const FolderLock other(folder.path(), "");
        const Called refused = shell(record);
        CHECK(refused.status == 2);
        CHECK(contains(refused.err, "found another recording into it, expected a folder of its own for each"));
        CHECK_FALSE(std::filesystem::exists(folder / "levels-01.tsv"));
    }
    CHECK(shell(record).status == 1);  // without a point, but let in
}

TEST_CASE("record: the command that it names for the fit has what was said about the levels") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "levels", "0\n");
    // continues a session that has a point, since there is nothing to fit without
    const auto next = [&](const std::string& session, const std::string& levels) {
        std::string name = session;
        std::erase(name, '"');
        std::filesystem::create_directories(folder / name);
        write_text_atomically(folder / (name + "/points.csv"), "time_s,level,force_N,repeat,phase\n1,0.5,1,0,press\n");
        return shell(kRecord + "-o " + (folder / session).string() + " --resume --sensor typed --levels " +
                     (folder / "levels").string() + levels)
            .out;
    };
    CHECK(contains(next("a", ""), "a/points.csv -o PROFILE.json\n"));
    CHECK(contains(next("\"it's here\"", ""), "/it'\\''s here/points.csv' -o PROFILE.json\n"));
    CHECK(contains(next("b", " --level pressure_raw --level-range 0 8191"),
                   "-o PROFILE.json --level pressure_raw --level-range 0 8191\n"));
    CHECK(contains(next("c", " --level contact_area --full-contact-area-px2 4000"),
                   "-o PROFILE.json --level contact_area --full-contact-area-px2 4000\n"));
}

TEST_CASE("record: what cannot work is said at once, or after five seconds of silence") {
    const TemporaryFolder folder;
    const std::string session = (folder / "s").string();
    const auto refused = [&](const std::string& arguments, int status, const char* word) {
        const Called called = shell(kRecord + "-o " + session + " " + arguments);
        CAPTURE(called.err);
        CHECK(called.status == status);
        CHECK(contains(called.err, word));
    };
    refused("--sensor usb:x --levels /dev/null", 2, "netft:HOST[:PORT], serial:PATH or typed");
    refused("--sensor serial:/dev/null --levels /dev/null", 2, "--N-per-count");
    refused("--sensor serial:/dev/null --N-per-count 1 --levels /dev/null", 1, "not a serial port");
    refused("--sensor serial:/dev/null --N-per-count 1 --baud 12345 --levels /dev/null", 2, "--baud: found 12345");
    refused("--sensor netft:127.0.0.1:0 --levels /dev/null", 2, "netft:HOST:PORT");
    refused("--sensor typed --levels -", 2, "standard input is for the typed numbers");
    refused("--sensor typed --resume --levels /dev/null", 2, "the session to resume");
    refused("--sensor typed --level pressure_raw --levels /dev/null", 2, "--level-range");
    refused("--sensor typed --full-contact-area-px2 100 --levels /dev/null", 2, "expected --level contact_area");
    const Called window =
        shell("env -u DISPLAY -u WAYLAND_DISPLAY " + kRecord + "-o " + session + " --sensor netft:127.0.0.1:9");
    CHECK(window.status == 1);
    CHECK(contains(window.err, "--levels FILE"));
    CHECK_FALSE(std::filesystem::exists(session));
    write_text_atomically(folder / "levels", "0\n0.5\nhalf\n");
    refused("--sensor typed --levels " + (folder / "levels").string() + " </dev/null", 2,
            "line 3: found 'half', expected a level >= 0");
    const Called silent = shell(PALPA_PEN_SIMULATOR " --seconds 8 | " + kRecord + "-o " + session +
                                "2 --sensor netft:127.0.0.1:9 --levels -");
    CHECK(silent.status == 1);
    CHECK(contains(silent.err, "no reading in 5 s"));
}

TEST_CASE("record: a sensor that was away gets its zero anew, and no point has the old one") {
    const TemporaryFolder folder;
    const std::string session = (folder / "s").string();
    const std::string link = (folder / "cell").string();
    const std::string cell = PALPA_LOAD_CELL_SIMULATOR
                             " --rate-Hz 200 --steps 4 --greatest-N 2.6 --period-s 4 --link " +
                             link + " --seconds ";
    // the second cell shows 0.4 N more without load
    const Called record = shell("( " + cell + "8; " + cell +
                                "12 --zero 100000 ) >/dev/null & sleep 0.5; " PALPA_PEN_SIMULATOR
                                " --steps 4 --greatest-N 2.6 --period-s 4 --seconds 18 | " +
                                kRecord + "-o " + session + " --sensor serial:" + link +
                                " --N-per-count 2.5e-5 --levels - --steady-s 0.1 --seconds 17 --json");
    CAPTURE(record.err);
    REQUIRE(record.status == 0);
    CHECK(contains(record.err, "is back: lift the pen"));
    const Json json = parse_json(record.out, "stdout");
    CHECK(json["sensor"]["zero_N"].get<double>() == close_to(2.5).epsilon(0.01));
    std::map<double, std::vector<double>> forces_N;  // by level
    Table points = read_csv(session + "/points.csv");
    const std::size_t level = points.column("level"), force_N = points.column("force_N");
    while (points.next()) forces_N[points.finite_number(level)].push_back(points.finite_number(force_N));
    for (const auto& [at, forces] : forces_N) {
        CAPTURE(at);
        const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
        CHECK(*most - *least < 0.01);
    }
}

TEST_CASE("record: a sensor that is overloaded gives no points, and a warning") {
    const TemporaryFolder folder;
    SimulatorProcess sensor(PALPA_NETFT_SIMULATOR, {"--rate-Hz", "500", "--status", "2147614720"});
    const Called record =
        shell(kPen + "--seconds 8 | " + kRecord + "-o " + (folder / "s").string() +
              " --sensor netft:127.0.0.1:" + sensor.port() + " --levels - --steady-s 0.1 --seconds 7");
    CHECK(record.status == 1);
    CHECK(contains(record.err, "says that its forces are invalid"));
    CHECK(contains(record.err, "no reading in 5 s that the sensor calls valid"));
}

TEST_CASE("record: levels outside the range are named, since no point can follow from them") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "levels", "0\n2048\n2048\n2049\n");
    const Called raw = shell("sleep 2 | " + kRecord + "-o " + (folder / "s").string() + " --sensor typed --levels " +
                             (folder / "levels").string() + " --json");
    CAPTURE(raw.err);
    CHECK(raw.status == 1);  // no point came of it
    CHECK(contains(raw.err, "found level 2048, expected 0 to 1: no point follows from it; --level-range says"));
    CHECK(parse_json(raw.out, "stdout")["outside_range"] == 3);
}

TEST_CASE("record: a sensor that sends nothing is told, and no fit of no points is proposed") {
    const TemporaryFolder folder;
    const Called silent = shell(kPen + "--seconds 3 | " + kRecord + "-o " + (folder / "s").string() +
                                " --sensor netft:127.0.0.1:1 --levels - --seconds 2");
    CHECK(silent.status == 1);
    CHECK(contains(silent.err, "netft:127.0.0.1:1: it sent nothing"));
    CHECK_FALSE(contains(silent.out, "calibrate fit"));
    const Called zero = shell(kRecord + "-o " + (folder / "t").string() +
                              " --sensor serial:/dev/null --N-per-count 0 --levels /dev/null");
    CHECK(zero.status == 2);
    CHECK(contains(zero.err, "--N-per-count: found 0 or nothing"));
}
