// A study's trials in the app: what would be lost by closing asks first. The window is off screen.

#include <SDL.h>
#include <chrono>
#include <doctest/doctest.h>
#include <thread>

#include "app/study/study_run.h"
#include "files/text.h"
#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::app;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::test;

namespace {

struct StudyDesk : Desk {
    explicit StudyDesk(const TemporaryFolder& folder, const std::string& task) : Desk("") {
        write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 4, "order": "fixed",
            "conditions": [{"id": "pad", "modality": "touchpad", "scene": ")" PALPA_SOURCE_DIR
                                                 R"(/assets/scenes/block-screen.json"}], )" +
                                                     task + "}");
        app.keeper = nullptr;
        RunOptions options;
        options.protocol = (folder / "p.json").string();
        options.log = (folder / "log").string();
        options.participant = "01";
        load_study(options, app);
        step(BeginStep{});
    }
    StudyRun& run() { return *study_of(app.doing); }
    void step(std::optional<StudyWish> wish = {}) { follow_study(wish, window, gui, app); }
    void press() {
        sample(Phase::down);
        sample(Phase::up);
    }
    void finish() {
        act(Action::finish, window, app);
        step();
    }
    bool asks_to_quit() {
        Wishes wishes;
        wishes.quit = true;
        carry_out(wishes, window, gui, app);
        const bool asked = app.asked.has_value();
        CHECK(app.quit != asked);
        app.asked.reset();
        app.quit = false;
        return asked;
    }
};

double interrupted_at_s(const std::string& events) {
    const std::size_t at = events.find("\tinterrupted\t");
    REQUIRE(at != std::string::npos);
    return std::stod(events.substr(events.rfind('\n', at) + 1));
}

}  // namespace

TEST_CASE("trials: what nobody has touched is not touched where a device leads either, but for a simulated one") {
    Desk desk("");
    CHECK(not_touched(desk.app));
    desk.app.tactile.shown.emplace();
    desk.app.tactile.shown->arm_leads = true;
    CHECK(not_touched(desk.app));
    desk.app.options.simulate_devices = true;
    CHECK_FALSE(not_touched(desk.app));
    desk.app.options.simulate_devices = false;
    desk.app.session.trial.began = true;
    session::take_device_press({{0.0, 0.0}, 1e-3, 0.5}, 1.0, desk.app.session);
    CHECK_FALSE(not_touched(desk.app));
}

TEST_CASE("live: closing in the middle of a pair asks first, and Enter says that the surface is done") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("choice": {"reference_kPa": 10, "comparisons_kPa": [20], "repeats": 2})");
    REQUIRE(trial_goes_on(desk.run()));
    CHECK_FALSE(desk.asks_to_quit());  // nothing is lost yet
    const auto enter = [&] {
        tap(desk.window, SDLK_RETURN);
        std::vector<Sample> samples;
        desk.window.poll(0.0, samples);
        for (int i = 0; i < 3; ++i) carry_out(desk.show_frame(), desk.window, desk.gui, desk.app);  // down, up
        desk.step();
    };
    desk.show_frame();
    enter();
    CHECK(desk.app.notices.note == words::kTouchFirst);
    CHECK(desk.run().interval == 0);
    desk.press();
    CHECK(desk.asks_to_quit());
    enter();
    REQUIRE(trial_goes_on(desk.run()));
    CHECK(desk.run().interval == 1);
    CHECK(desk.asks_to_quit());  // the first surface was felt
    repeat_untouched(desk.run());
    REQUIRE(at<step::Device>(desk.run()));
    CHECK(desk.asks_to_quit());  // also while the second one waits to be repeated
    desk.step();
    desk.step(BeginStep{});
    desk.step();
    REQUIRE(trial_goes_on(desk.run()));
    desk.press();
    enter();
    REQUIRE(at<step::Question>(desk.run()));
    CHECK(desk.asks_to_quit());
    desk.show_frame();
    choose_softer(true, 9.0, desk.run());
    desk.step();
    CHECK_FALSE(desk.asks_to_quit());
}

TEST_CASE("live: a surface or a trial that nobody touches in its time is repeated, and counts for nothing") {
    for (const char* task :
         {R"("choice": {"reference_kPa": 10, "comparisons_kPa": [20], "repeats": 2})", R"("repeats": 2)"}) {
        CAPTURE(task);
        const TemporaryFolder log;
        StudyDesk desk(log, std::string(R"("time_limit_s": 0.3, )") + task);
        REQUIRE(trial_goes_on(desk.run()));
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        desk.step();
        REQUIRE(at<step::Device>(desk.run()));
        CHECK(std::get<step::Device>(desk.run().step).untouched);
        CHECK(desk.run().interval == 0);
        CHECK(desk.run().progress.finished.empty());
        desk.step();
        desk.show_frame();
        desk.step(BeginStep{});
        desk.step();
        REQUIRE(trial_goes_on(desk.run()));
        desk.press();
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        desk.step();
        CHECK_FALSE(at<step::Device>(desk.run()));
        CHECK(desk.run().interval + static_cast<int>(desk.run().progress.finished.size()) == 1);
        const auto first = read_text(
            log / "log/sub-01/beh" /
            ("sub-01_task-" + std::string(desk.run().interval > 0 ? "interval" : "palpation") + "_run-01_events.tsv"));
        CHECK(interrupted_at_s(first) >= 0.3);  // when the time was over, not when it began
    }
}

TEST_CASE(
    "live: a trial whose time goes by while the app sleeps or is out of sight is repeated, and counts for nothing") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("time_limit_s": 0.3, "repeats": 2)");
    REQUIRE(trial_goes_on(desk.run()));
    desk.press();
    const auto wait_ms = [](int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
    const auto out_of_sight = [&](bool hidden) { note_sight(hidden, now_of(desk.app, desk.window), desk.app); };
    SUBCASE("sleeps") { wait_ms(2500); }
    SUBCASE("out of sight, and back at once after the end") {
        out_of_sight(true);
        wait_ms(400);
        out_of_sight(false);
    }
    SUBCASE("out of sight, where frames go on") {
        out_of_sight(true);
        wait_ms(400);
    }
    desk.step();
    REQUIRE(at<step::Device>(desk.run()));
    CHECK(std::get<step::Device>(desk.run().step).unseen);
    CHECK(desk.run().progress.finished.empty());
    const auto events = read_text(folder / "log/sub-01/beh/sub-01_task-palpation_run-01_events.tsv");
    CHECK(contains(events, "\tinterrupted\t"));
    CHECK_FALSE(contains(events, "\tfinish\t"));
    CHECK_FALSE(contains(events, "\tdevice_gone\t"));
}

TEST_CASE("live: a trial that was out of sight and comes back before its end is finished by its limit") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("time_limit_s": 0.3, "repeats": 2)");
    REQUIRE(trial_goes_on(desk.run()));
    note_sight(true, now_of(desk.app, desk.window), desk.app);
    note_sight(false, now_of(desk.app, desk.window), desk.app);
    desk.press();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    desk.step();
    CHECK(desk.run().progress.finished.size() == 1);
}

TEST_CASE("live: what is kept beside a trial is of that trial alone, since the one before may be another person's") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("repeats": 2)");
    for (int trial = 1; trial <= 2; ++trial) {
        if (!trial_goes_on(desk.run())) desk.step(BeginStep{});
        REQUIRE(trial_goes_on(desk.run()));
        for (int k = 0; k < trial; ++k) desk.press();
        act(Action::mark, desk.window, desk.app);
        desk.app.frames += 100;  // drawn meanwhile
        desk.finish();
    }
    for (int trial = 1; trial <= 2; ++trial) {
        const Json kept = read_json(
            folder / ("log/sub-01/beh/sub-01_task-palpation_run-0" + std::to_string(trial) + "_performance.json"));
        CHECK(kept["trials"].size() == 1);
        CHECK(kept["trials"][0]["marks"].size() == 1);
        CHECK(kept["samples"] == 1 + 2 * trial + 2);  // where the tissue is, the presses, mark and finish
        CHECK(kept["frames"] == 100);
    }
    CHECK(result_of(desk.app)["trials"].size() >= 2);
}

TEST_CASE("live: a study's trial whose touches lack what the profile reads is repeated, and counts for nothing") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("repeats": 2)");
    REQUIRE(trial_goes_on(desk.run()));
    scene::Plan plan = *desk.app.session.plan;
    plan.profile.level = calibration::LevelField::contact_area;  // the pen of these tests has none
    plan.profile.full_contact_area_px2 = 4000.0;
    desk.app.session.plan = std::make_shared<const scene::Plan>(std::move(plan));
    desk.press();
    SUBCASE("at its end, however few they are") { desk.finish(); }
    SUBCASE("as soon as they are many") {
        for (int k = 0; k < 40; ++k) desk.press();
        desk.step();
    }
    REQUIRE(at<step::Device>(desk.run()));
    CHECK(std::get<step::Device>(desk.run().step).no_level);
    CHECK(desk.run().progress.finished.empty());
    const std::string events = read_text(folder / "log/sub-01/beh/sub-01_task-palpation_run-01_events.tsv");
    CHECK(contains(events, "\tno_level\t"));
    CHECK(contains(events, "\tinterrupted\t"));
    CHECK_FALSE(contains(events, "\tfinish\t"));
}

TEST_CASE("live: finishing a study's trial that nobody has touched asks to press first, also in practice") {
    for (const char* task : {R"("repeats": 2)", R"("repeats": 2, "practice": {"trials": 1})"}) {
        CAPTURE(task);
        const TemporaryFolder folder;
        StudyDesk desk(folder, task);
        REQUIRE(trial_goes_on(desk.run()));
        desk.finish();
        CHECK(trial_goes_on(desk.run()));
        CHECK(desk.app.notices.note == words::kTouchFirst);
        CHECK(desk.run().progress.finished.empty());
        desk.press();
        desk.step();
        CHECK(desk.app.notices.note.empty());
        desk.finish();
        CHECK_FALSE(trial_goes_on(desk.run()));
    }
}

TEST_CASE("live: who has finished is told where the trials are, if a keeper knows") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("repeats": 1)");
    desk.keeper.busy = false;
    desk.app.keeper = &desk.keeper;
    REQUIRE(trial_goes_on(desk.run()));
    CHECK(desk.run().where.empty());
    desk.press();
    desk.finish();
    REQUIRE(at<step::Done>(desk.run()));
    CHECK(desk.run().where == "The trials of 01 are here.");
}

TEST_CASE("live: a trial that is closed is interrupted when it is closed, not at its last touch") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("repeats": 2)");
    desk.press();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    close_study(desk.window, desk.gui, desk.app);
    CHECK(interrupted_at_s(read_text(folder / "log/sub-01/beh/sub-01_task-palpation_run-01_events.tsv")) >= 0.3);
}

TEST_CASE("live: closing a study's trial that was touched asks first, with or without marks") {
    const TemporaryFolder folder;
    StudyDesk desk(folder, R"("repeats": 2)");
    REQUIRE(trial_goes_on(desk.run()));
    CHECK_FALSE(desk.asks_to_quit());
    desk.press();
    CHECK(desk.asks_to_quit());
    desk.finish();
    CHECK_FALSE(trial_goes_on(desk.run()));
    CHECK_FALSE(desk.asks_to_quit());
}

TEST_CASE("live: ratings of conditions whose trials are mixed are refused before a study begins") {
    const TemporaryFolder folder;
    const auto load = [&](const std::string& order) {
        const std::string pad =
            R"("modality": "touchpad", "scene": ")" PALPA_SOURCE_DIR R"(/assets/scenes/block-screen.json"})";
        write_text_atomically(folder / "p.json",
                              R"({"name": "n", "version": "1", "seed": 4, "order": "fixed", "repeats": 2,
            "conditions": [{"id": "a", )" +
                                  pad + R"(, {"id": "b", )" + pad + R"(], "trial_order": ")" + order + R"(",
            "ratings": [{"id": "effort", "text": "It was tiring.", "from": 1, "to": 7}]})");
        Desk desk("");
        RunOptions options;
        options.protocol = (folder / "p.json").string();
        options.log = (folder / order).string();
        load_study(options, desk.app);
    };
    CHECK(contains(message_of([&] { load("interleaved"); }),
                   "ratings: found ratings of conditions whose trials are mixed"));
    CHECK_FALSE(std::filesystem::exists(folder / "interleaved"));
    CHECK(message_of([&] { load("blocked"); }) == "");
}
