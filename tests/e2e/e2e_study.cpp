// A study with a person, on a real X server: instructions, a trial by pen, a trial typed in, the thanks; and the same
// after the program was killed in the middle of a trial. Run it under tests/platform/xorg/with-xorg.

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <string>

#include "files/folder_lock.h"
#include "files/json.h"
#include "files/text.h"
#include "scene/mapping.h"
#include "study/read_logs.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::study;
using namespace palpa::test;

namespace {

enum Key {
    kEnter = 36,
    kT = 28,
    kM = 58,
    kF = 41,
    k4 = 13,
    k0 = 19,
    k7 = 16,
    kBackspace = 22,
    kMenuKey = 76,
    kC = 54,
    k1 = 10,
    k2 = 11
};

class Script {
  public:
    explicit Script(const std::filesystem::path& file) : out_(file) {
        out_ << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    }
    void wait(double seconds) { t_s_ += seconds; }
    // Until `file` is there with `text` in it; then a person takes a moment.
    void wait(const std::filesystem::path& file, const std::string& text = "") {
        out_ << t_s_ << "\twait\t" << file.string() << '\t' << text << '\n';
        wait(0.5);
    }
    void key(int code) {
        row("key", code, "down", 0, 0, 0.0);
        wait(0.06);
        row("key", code, "up", 0, 0, 0.0);
        wait(0.3);
    }
    // A press that strokes from left to right in the middle of the tissue and stays there if it is not lifted.
    void stroke(double seconds, bool lift) {
        press(600, 400, 0.6, 0.0001, 300.0, seconds);
        if (lift) row("pen", 0, "up", 900, 400, 0.0);
        wait(0.2);
    }
    // A press on one place, with a pressure that rises by `rise` in each sample.
    void press_at(double x_px, double y_px, double pressure, double rise, double seconds) {
        press(x_px, y_px, pressure, rise, 0.0, seconds);
        row("pen", 0, "up", x_px, y_px, 0.0);
        wait(0.3);
    }
    double close() {
        out_.close();
        return t_s_;
    }
    double now_s() const { return t_s_; }

  private:
    void press(double x_px, double y_px, double pressure, double rise, double way_px, double seconds) {
        row("pen", 0, "hover", x_px, y_px, 0.0);
        wait(0.05);
        row("pen", 0, "down", x_px, y_px, 0.2);
        const int n = static_cast<int>(seconds / 0.004);
        for (int i = 0; i <= n; ++i) {
            wait(0.004);
            row("pen", 0, "move", x_px + way_px * i / n, y_px, pressure + rise * i);
        }
    }
    void row(const char* kind, int id, const char* phase, double x_px, double y_px, double pressure) {
        out_ << t_s_ << '\t' << kind << '\t' << id << '\t' << phase << '\t' << x_px << '\t' << y_px << '\t' << pressure
             << '\n';
    }
    std::ofstream out_;
    double t_s_ = 0.0;
};

void write_protocol(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json",
                          R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", "turn_maps": false,
        "time_limit_s": 60, "instructions": "Find what is harder.", "conditions": [
        {"id": "pen", "modality": "pen", "scene": ")" PALPA_SOURCE_DIR R"(/assets/scenes/default.json"},
        {"id": "hand", "modality": "hand", "nodules": ["A"]}]})");
}

std::string study_arguments(const TemporaryFolder& folder, const std::string& rest) {
    return "study run " + (folder / "p.json").string() + " --log " + (folder / "log").string() +
           " --participant 07 --json " + rest;
}

void plug(const char* way) { CHECK(shell(std::string("timeout 10 " PALPA_XORG_PEN " ") + way + " pen") == 0); }

template <class Condition>
bool wait_for(const Condition& condition) {
    for (int i = 0; i < 400 && !condition(); ++i) sleep_s(0.05);
    return condition();
}

std::string step_now(const TemporaryFolder& folder) {
    const auto file = folder / "log/sub-07/now.json";
    return std::filesystem::exists(file) ? read_json(file)["step"].get<std::string>() : "";
}

std::string text_of(const std::filesystem::path& file) { return std::filesystem::exists(file) ? read_text(file) : ""; }

// One script after the other plays on devices of its own: each device takes one client.
int play(const std::filesystem::path& script) { return shell("timeout 100 " PALPA_XORG_PEN " " + script.string()); }

// A pen that always sends the same, in touches too short for a verdict or for so long that there is one, is refused, until a
// press on the panel itself shows that it measures.
void try_constant_pen(bool taps) {
    const TemporaryFolder folder;
    write_protocol(folder);
    const std::string stem = (folder / "log/sub-07/beh/sub-07_task-palpation_run-0").string();
    const auto now = folder / "log/sub-07/now.json";
    Script script(folder / "script.tsv");
    script.wait(3.0);
    script.key(kEnter);  // begin; nobody has tried the pen
    script.wait(stem + "1_events.tsv");
    // it always sends the same, in touches that are too short for a verdict, or for so long that there is one
    for (int tap = 0; taps && tap < 4; ++tap) script.press_at(600, 400, 0.5, 0.0, 0.03);
    if (taps) script.key(kF);
    if (!taps) script.press_at(600, 400, 0.5, 0.0, 1.5);
    script.wait(now, "\"device\"");
    script.key(kEnter);                          // not now
    script.press_at(640, 500, 0.3, 0.002, 0.7);  // in the middle of the panel
    script.key(kEnter);
    script.wait(1.0);
    script.stroke(0.4, true);
    script.key(kF);
    const std::string arguments = study_arguments(folder, "--quit-after-s " + std::to_string(script.close() + 6.0));
    CHECK(run_program(folder, arguments, now, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const std::string first = text_of(stem + "1_events.tsv");
    CHECK(first.find("\tno_pressure\t") != std::string::npos);
    CHECK(first.find("\tinterrupted\t") != std::string::npos);
    CHECK(first.find("\tfinish\t") == std::string::npos);
    CHECK(text_of(stem + "2_events.tsv").find("\tfinish\t") != std::string::npos);
    CHECK(read_json(folder / "out.json")["finished"] == 1);
}

}  // namespace

TEST_CASE("study: a person goes through it by pen and keys, and the menu stays closed") {
    const TemporaryFolder folder;
    write_protocol(folder);
    Script script(folder / "script.tsv");
    script.wait(3.0);
    script.key(kEnter);  // begin
    script.wait(1.0);
    script.key(kMenuKey);
    script.key(kC);  // no cost table either
    script.stroke(0.6, true);
    script.key(kM);
    script.key(k4);
    script.key(kF);
    script.wait(0.5);
    script.key(kEnter);  // the trial by hand
    script.key(kT);
    script.wait(3.0);
    script.key(kT);
    script.key(kEnter);  // keep: A missed
    script.wait(0.5);
    const std::string seconds = std::to_string(script.close() + 5.0);
    const std::string arguments =
        study_arguments(folder, "--quit-after-s " + seconds + " --screenshot " + (folder / "p.png").string());
    REQUIRE(run_program(folder, arguments, folder / "log/sub-07/now.json", [&] { CHECK(play_script(folder) == 0); }) ==
            0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["finished"] == 2);
    CHECK(result["step"] == "done");
    CHECK(result["overflow"] == "");
    const Observations seen = read_study(folder / "log");
    CHECK(seen.notes.empty());
    REQUIRE(seen.trials.size() == 2);
    CHECK(seen.trials[0].path_m > 0.01);
    CHECK(seen.trials[1].duration_s > 0.9);  // a busy computer may take the first T two seconds late
    CHECK(read_text(folder / "log/sub-07/beh/sub-07_task-palpation_run-01_marks.tsv").find("\t4\t") !=
          std::string::npos);
    const Json settings = read_json(folder / "log/sub-07/beh/sub-07_task-palpation_run-01_settings.json");
    CHECK(settings["study"]["map_sha256"]["normal_N.npy"].get<std::string>().size() == 64);
    CHECK(settings["tissue_area_px"][0].get<double>() > 100.0);  // beside the panel, not the whole window
}

TEST_CASE("killed: the interrupted trial comes again, and its samples up to the kill are on the disk") {
    const TemporaryFolder folder;
    write_protocol(folder);
    Script script(folder / "script.tsv");
    script.wait(3.0);
    script.key(kEnter);
    script.wait(1.0);
    script.stroke(4.0, true);  // killed meanwhile
    script.wait(8.0);          // and started again
    script.key(kEnter);        // it is the same person
    script.key(kEnter);        // begin
    script.wait(1.0);
    script.stroke(0.5, true);
    script.key(kF);
    script.wait(0.5);
    script.close();
    std::thread hand([&] {
        for (int i = 0; i < 200 && !std::filesystem::exists(folder / "log/sub-07/now.json"); ++i) sleep_s(0.05);
        sleep_s(1.5);
        CHECK(play_script(folder) == 0);
    });
    const std::filesystem::path samples = folder / "log/sub-07/beh/sub-07_task-palpation_run-01_samples.tsv";
    std::string at_kill;
    std::thread killer([&] {
        const auto size = [&] {
            std::error_code error;
            const auto bytes = std::filesystem::file_size(samples, error);
            return error ? std::uintmax_t{0} : bytes;
        };
        for (int i = 0; i < 600 && size() < 30000; ++i) sleep_s(0.02);  // in the middle of the stroke
        shell("pkill -KILL -f '" PALPA_PROGRAM " study run " + (folder / "p.json").string() + "'");
        // the last sample that is in the file against the system's steady clock, which the samples carry
        const std::string text = read_text(samples);
        const auto last = text.rfind('\n', text.rfind('\n') - 1) + 1;
        const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
        at_kill = text.substr(last, text.find('\t', last) - last) + " " + std::to_string(now_s);
    });
    CHECK(run_program(folder, study_arguments(folder, "--quit-after-s 60"), folder / "log/sub-07/now.json", [] {}) !=
          0);
    killer.join();
    // the shell that was killed too is gone before the program is
    REQUIRE(wait_for([&] { return !is_folder_locked(folder / "log/sub-07"); }));
    const std::string arguments = study_arguments(folder, "--quit-after-s 14");
    const int status = run_program(folder, arguments, folder / "log/sub-07/now.json", [] {});
    hand.join();
    INFO(text_of(folder / "err.txt"));
    REQUIRE(status == 0);
    CAPTURE(at_kill);
    const Observations seen = read_study(folder / "log");
    CHECK(seen.interrupted_trials == 1);
    CHECK(seen.trials.size() == 1);
    CHECK(read_json(folder / "out.json")["finished"] == 1);
    const double sample_s = std::stod(at_kill);
    const double killed_s = std::stod(at_kill.substr(at_kill.find(' ')));
    MESSAGE("last sample on the disk " << 1e3 * (killed_s - sample_s) << " ms before the kill was over");
    CHECK(killed_s > sample_s);
}

TEST_CASE("typed: a code that is not taken is typed again, and Enter twice begins the first trial") {
    const TemporaryFolder folder;
    write_protocol(folder);
    Script script(folder / "script.tsv");
    script.wait(3.0);
    for (int i = 0; i < 3; ++i) script.key(kBackspace);  // what is offered
    script.key(kEnter);                                  // no code
    script.wait(0.5);
    script.key(k0);  // without touching the field
    script.key(k7);
    script.key(kEnter);
    script.wait(1.0);    // a slow machine shows the instructions first
    script.key(kEnter);  // begin
    const std::string arguments = "study run " + (folder / "p.json").string() + " --log " + (folder / "log").string() +
                                  " --json --quit-after-s " + std::to_string(script.close() + 6.0) + " --screenshot " +
                                  (folder / "p.png").string();
    REQUIRE(run_program(folder, arguments, folder / "log/study.json", [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["participant"] == "07");
    CHECK(result["step"] == "trial");
    CHECK(std::filesystem::exists(folder / "log/sub-07/beh/sub-07_task-palpation_run-01_events.tsv"));
}

TEST_CASE("missing: a pen's trial does not begin before there is a pen") {
    const TemporaryFolder folder;
    write_protocol(folder);
    plug("--disable");
    Script script(folder / "script.tsv");
    script.wait(3.0);
    script.key(kEnter);  // begin: not without a pen
    script.key(kEnter);
    script.wait(8.0);  // which comes meanwhile
    script.key(kEnter);
    script.wait(1.0);
    script.key(kF);  // not yet: nothing was touched
    script.stroke(0.4, true);
    script.key(kF);
    const std::string arguments = study_arguments(folder, "--quit-after-s " + std::to_string(script.close() + 5.0));
    const auto first = folder / "log/sub-07/beh/sub-07_task-palpation_run-01_events.tsv";
    std::thread hand([&] {
        CHECK(wait_for([&] { return step_now(folder) == "device"; }));
        sleep_s(1.0);
        CHECK_FALSE(std::filesystem::exists(first));
        plug("--enable");
    });
    CHECK(run_program(folder, arguments, folder / "log/sub-07/now.json", [&] { CHECK(play_script(folder) == 0); }) ==
          0);
    hand.join();
    CHECK(text_of(first).find("\tfinish\t") != std::string::npos);
    CHECK(read_json(folder / "out.json")["finished"] == 1);
}

TEST_CASE("pressure: a pen that measures nothing is refused, and freed by a press on the panel") {
    try_constant_pen(false);
}

TEST_CASE("taps: a pen that measures nothing gives no counted trial by short taps either") { try_constant_pen(true); }

TEST_CASE("left: a trial that its pen leaves is interrupted with its marks, never a miss, and begins anew") {
    const TemporaryFolder folder;
    write_protocol(folder);
    Script keys(folder / "script.tsv");
    keys.wait(3.0);
    keys.key(kEnter);  // begin
    keys.wait(5.0);    // the pen's stroke
    keys.key(kM);
    keys.wait(12.0);   // the pen goes, and comes back
    keys.key(kEnter);  // begin anew
    keys.wait(1.0);
    keys.key(kF);  // not yet: nothing was touched
    const std::string arguments = study_arguments(folder, "--quit-after-s " + std::to_string(keys.close() + 5.0));
    Script pen(folder / "pen.tsv");
    pen.wait(0.2);
    pen.stroke(0.5, true);
    pen.close();
    const std::string stem = (folder / "log/sub-07/beh/sub-07_task-palpation_run-01").string();
    std::thread hand([&] {
        CHECK(wait_for([&] { return std::filesystem::exists(stem + "_events.tsv"); }));
        sleep_s(1.0);
        CHECK(play(folder / "pen.tsv") == 0);
        CHECK(wait_for([&] { return text_of(stem + "_events.tsv").find("\tmark\t") != std::string::npos; }));
        plug("--disable");
        CHECK(wait_for([&] { return step_now(folder) == "device"; }));
        plug("--enable");
    });
    CHECK(run_program(folder, arguments, folder / "log/sub-07/now.json", [&] { CHECK(play_script(folder) == 0); }) ==
          0);
    hand.join();
    CHECK(text_of(stem + "_events.tsv").find("\tdevice_gone\t") != std::string::npos);
    CHECK(text_of(stem + "_events.tsv").find("\tinterrupted\t") != std::string::npos);
    const std::string marks = text_of(stem + "_marks.tsv");
    CHECK(std::count(marks.begin(), marks.end(), '\n') == 2);
    const Observations seen = read_study(folder / "log");
    CHECK(seen.interrupted_trials == 2);  // and the one begun anew, by the end of the program
    CHECK(seen.trials.empty());
}

TEST_CASE("consent: a person agrees by a key of its own, practises a pair, and goes through a staircase") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "p.json",
                          R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", "turn_maps": false,
        "consent": "You press on surfaces for some minutes. Your answers are kept under a code.",
        "practice": {"trials": 1}, "instructions": "Say which one is softer.",
        "staircase": {"method": "weighted-up-down", "reference_kPa": 10, "comparisons_kPa": [12, 15, 20], "trials": 2},
        "conditions": [{"id": "pen", "modality": "pen", "scene": ")" PALPA_SOURCE_DIR
                          R"(/assets/scenes/default.json"}]})");
    const std::filesystem::path now = folder / "log/sub-01/now.json";
    const std::string stem = (folder / "log/sub-01/beh/sub-01_task-interval_run-0").string();
    const std::string study = "study run " + (folder / "p.json").string() + " --log " + (folder / "log").string();
    // nothing moves on the consent page, and its window closes in time all the same
    const std::string home = folder.path().string();
    REQUIRE(shell("HOME=" + home + " timeout 60 " PALPA_PROGRAM " " + study + " --participant 01 --quit-after-s 1 >" +
                  home + "/closed.txt") == 0);
    // who leaves at the consent page leaves nothing
    REQUIRE(run_program(folder, study + " --participant 01", now, [&] { end_program(folder, "TERM"); }) == 0);
    CHECK_FALSE(std::filesystem::exists(folder / "log/sub-01"));
    Script script(folder / "script.tsv");
    script.wait(now, R"("step": "consent")");
    script.key(kEnter);  // does not agree for anybody
    script.key(k1);
    script.wait(now, R"("step": "instructions")");
    script.key(kEnter);  // begin the practice
    for (int interval = 0; interval < 6; ++interval) {
        script.wait(stem + std::to_string(interval + 1) + "_events.tsv");
        script.stroke(0.4, true);
        script.key(kF);
        if (interval % 2 == 0) continue;
        script.wait(now, R"("step": "question")");
        script.key(interval == 3 ? k2 : k1);
        if (interval > 1) continue;
        script.wait(now, R"("step": "told")");
        script.key(kEnter);
        script.wait(now, R"("step": "instructions")");
        script.key(kEnter);  // begin the tests
    }
    script.close();
    REQUIRE(run_study_to("done", folder,
                         study + " --participant 01 --json --screenshot " + (folder / "p.png").string()) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["finished"] == 3);
    CHECK(result["step"] == "done");
    CHECK(result["overflow"] == "");
    CHECK(text_of(folder / "log/sub-01/beh/sub-01_task-ratings_beh.tsv").find("\tconsent\tgiven\n") !=
          std::string::npos);
    const Observations seen = read_study(folder / "log");
    CHECK(seen.practice_trials == 1);
    REQUIRE(seen.staircases.size() == 1);
    CHECK(seen.staircases[0].estimate.trials == 2);
}
