// What goes wrong while the app runs is told on the screen, and nothing is lost: a scene file that breaks, a disk
// that is full, a pen that is unplugged in the middle of a press, a window of 200 x 100 px. Run it under
// tests/platform/xorg/with-xorg.

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <string>
#include <thread>

#include "files/json.h"
#include "files/text.h"
#include "tests/e2e/run_app.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

void copy_assets(const TemporaryFolder& folder) {
    std::filesystem::copy(PALPA_SOURCE_DIR "/assets", folder / "assets", std::filesystem::copy_options::recursive);
}

int run_with_copy(const TemporaryFolder& folder, const std::string& arguments, const std::function<void()>& meanwhile) {
    ::setenv("PALPA_ASSETS", (folder / "assets").c_str(), 1);
    return run_app(folder, arguments, meanwhile);
}

void play(const TemporaryFolder& folder, const std::string& rows) {
    std::ofstream(folder / "script.tsv") << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n" << rows;
    CHECK(play_script(folder) == 0);
}

std::string tap(double t_s, const char* x_px, const char* y_px) {
    const auto row = [&](double at_s, const char* phase, const char* pressure) {
        return std::to_string(at_s) + "\tpen\t0\t" + phase + "\t" + x_px + "\t" + y_px + "\t" + pressure + "\n";
    };
    return row(t_s, "hover", "0") + row(t_s + 0.05, "down", "0.3") + row(t_s + 0.13, "up", "0");
}

std::string key(double t_s, int code) {
    const std::string end = "\t0\t0\t0\n";
    return std::to_string(t_s) + "\tkey\t" + std::to_string(code) + "\tdown" + end + std::to_string(t_s + 0.05) +
           "\tkey\t" + std::to_string(code) + "\tup" + end;
}

}  // namespace

TEST_CASE("scene broken: choosing it says what is wrong, and the present scene goes on") {
    const TemporaryFolder folder;
    copy_assets(folder);
    const int status = run_with_copy(folder, "--quit-after-s 9", [&] {
        std::ofstream(folder / "assets/scenes/delay.json") << "{\"name\": \"broken\", \"tissue\": 3}";
        play(folder, tap(0.5, "58", "27") + tap(3.0, "360", "178"));  // the menu, its third scene
    });
    CHECK(status == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["scene"] == "Silicone phantom");
    REQUIRE(result["problems"].size() == 1);
    CHECK(contains(result["problems"][0], "delay.json: tissue: found 3"));
}

TEST_CASE("disk full: the trial stops in words, what was logged before is there, and the exit status says so") {
    const TemporaryFolder folder;
    copy_assets(folder);
    std::filesystem::create_directory(folder / "small");
    const std::string small = (folder / "small").string();
    if (shell("mount -t tmpfs -o size=1096k tmpfs " + small + " 2>/dev/null") != 0) {
        MESSAGE("no right to mount a small disk here: not tested");
        return;
    }
    std::ofstream(folder / "small/other") << std::string(1000 * 1024, 'x');
    std::string rows = "0\tpen\t0\thover\t760\t400\t0\n0.02\tpen\t0\tdown\t760\t400\t0.2\n";
    for (int i = 1; i < 2500; ++i) {
        rows += std::to_string(0.02 + 0.001 * i) + "\tpen\t0\tmove\t" + std::to_string(760 + 0.05 * i) + "\t400\t" +
                std::to_string(0.5 + 0.1 * ((i / 50) % 2)) + "\n";
    }
    rows += "3\tkey\t41\tdown\t0\t0\t0\n3.05\tkey\t41\tup\t0\t0\t0\n";  // F: finish
    const std::string run = (folder / "small/sub-01/beh/sub-01_task-palpation_run-0").string();
    bool scored = true;
    const int status = run_with_copy(folder, "--quit-after-s 12 --log " + small, [&] {
        std::thread somebody([&] {  // deletes other files once the disk is full
            for (int i = 0; i < 200 && std::filesystem::space(small).available > 0; ++i) sleep_s(0.1);
            sleep_s(2.0);
            scored = std::filesystem::exists(folder / ".local/share/palpa/history");
            std::filesystem::remove(folder / "small/other");
            std::ofstream(folder / "freed") << "yes";
        });
        play(folder, rows + "3.1\twait\t" + (folder / "freed").string() + "\n" + key(3.2, 27) + tap(4.0, "760", "400") +
                         key(5.0, 58) + key(6.0, 41));  // again, mark, finish
        somebody.join();
        sleep_s(2.0);
    });
    const std::string samples = read_text(run + "1_samples.tsv");
    const Json second = read_json(run + "2_performance.json");
    CHECK(shell("umount " + small) == 0);
    CHECK(status == 1);
    CHECK(contains(read_text(folder / "err.txt"),
                   "cannot be written any more, so the trial ends here (is the disk full, or the folder gone?)"));
    CHECK(std::count(samples.begin(), samples.end(), '\n') > 100);
    CHECK_FALSE(scored);                // no score of half a trial
    CHECK(second["problems"].empty());  // what stopped the first trial is not said of the next
}

TEST_CASE("unplugged: a pen that goes in the middle of a press ends it, and another one is taken") {
    const TemporaryFolder folder;
    copy_assets(folder);
    const int status = run_with_copy(folder, "--quit-after-s 7", [&] {
        play(folder,
             "0\tpen\t0\thover\t760\t400\t0\n0.05\tpen\t0\tdown\t760\t400\t0.2\n0.1\tpen\t0\tmove\t770\t400\t0.6\n");
        CHECK(shell("timeout 10 " PALPA_XORG_PEN " --disable pen") == 0);
        sleep_s(1.5);
        CHECK(shell("timeout 10 " PALPA_XORG_PEN " --enable pen") == 0);
        std::ofstream(folder / "touch.tsv")
            << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n0\ttouch\t0\tdown\t700\t300\t0.3\n"
               "0.1\ttouch\t0\tmove\t720\t300\t0.6\n0.3\ttouch\t0\tup\t720\t300\t0\n";
        CHECK(shell("timeout 10 " PALPA_XORG_PEN " " + (folder / "touch.tsv").string()) == 0);
    });
    CHECK(status == 0);
    const std::string trace = read_text(folder / "t.tsv");
    const auto last_pen = trace.rfind("\tpen\t");
    REQUIRE(last_pen != std::string::npos);
    const std::string end = trace.substr(last_pen, 12);
    const bool ended = contains(end, "\tpen\tup") || contains(end, "\tpen\tcancel") || contains(end, "\tpen\thover");
    CHECK(ended);
    CHECK(contains(trace, "\tfinger\tmove"));
}

TEST_CASE("gone: a log's folder that is removed is told, and the exit status says so after the next trial too") {
    const TemporaryFolder folder;
    copy_assets(folder);
    const std::filesystem::path log = folder / "log";
    const int status = run_with_copy(folder, "--quit-after-s 10 --practice --log " + log.string(), [&] {
        std::filesystem::remove_all(log);
        play(folder, tap(0.0, "760", "400") + key(0.5, 58) + key(1.5, 41) + key(3.0, 57));  // mark, finish, next
    });
    CHECK(status == 1);
    CHECK(contains(read_text(folder / "err.txt"), "cannot be written any more"));
}

TEST_CASE("hangup: a terminal that closes ends the app as SIGTERM does, with its trial logged as interrupted") {
    const TemporaryFolder folder;
    copy_assets(folder);
    const std::string log = (folder / "log").string();
    run_with_copy(folder, "--quit-after-s 30 --log " + log, [&] {
        play(folder, tap(0.0, "760", "400") + "0.5\tkey\t58\tdown\t0\t0\t0\n0.6\tkey\t58\tup\t0\t0\t0\n");
        end_program(folder, "HUP");
    });
    const std::string stem = log + "/sub-01/beh/sub-01_task-palpation_run-01";
    CHECK(contains(read_text(stem + "_events.tsv"), "\tmark\t"));
    CHECK(contains(read_text(stem + "_events.tsv"), "\tinterrupted\t"));
    CHECK(std::filesystem::exists(stem + "_performance.json"));
}

TEST_CASE("tiny: a window of 200 x 100 px has no room for controls, and the keys still mark and finish") {
    const TemporaryFolder folder;
    copy_assets(folder);
    const int status = run_with_copy(folder, "--quit-after-s 7 --width-px 200 --height-px 100 --test", [&] {
        play(folder,
             "0\tkey\t65\tdown\t0\t0\t0\n1.2\tkey\t65\tup\t0\t0\t0\n1.5\tkey\t58\tdown\t0\t0\t0\n1."
             "6\tkey\t58\tup\t0\t0\t0\n"
             "2.0\tkey\t41\tdown\t0\t0\t0\n2.1\tkey\t41\tup\t0\t0\t0\n");
    });
    CHECK(status == 0);
    const Json result = read_json(folder / "out.json");
    REQUIRE(result["trials"].size() == 1);
    CHECK(result["trials"][0]["finished"] == true);
    CHECK(result["trials"][0]["marks"].size() == 1);
}
