// Trials begin and end with a press held and a keeper that is busy; the window is off screen.

#include <SDL.h>
#include <doctest/doctest.h>
#include <set>

#include "app/screens/history_screen.h"
#include "app/screens/words.h"
#include "scene/advance.h"
#include "scene/mapping.h"
#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"
#include "tests/close_to.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::render;
using namespace palpa::study;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

// What a frame reads together belongs together.
void check_whole(const Session& session) {
    const Session& s = session;
    CHECK(s.state.display_ratio.has_value() == s.scene.display_ratio.has_value());
    CHECK(s.state.delay.has_value() == s.scene.delay.has_value());
    CHECK(s.state.tissue.index() == s.plan->tissue.index());
    CHECK(s.state.view.area.centre_m == s.plan->area.centre_m);
    CHECK_FALSE(s.state.pointer.has_value());
    CHECK_FALSE(s.state.touch.down);
    CHECK(avatar_at(s.scene, s.state, 1e3).p_m.allFinite());
}

}  // namespace

TEST_CASE("live: a scene is changed under a press while the keeper is busy") {
    Desk desk("");
    REQUIRE(desk.app.session.scene.display_ratio);
    desk.sample(Phase::down);
    desk.sample(Phase::move);
    REQUIRE(desk.app.session.state.touch.down);

    change_scene(desk.window, desk.gui, PALPA_SOURCE_DIR "/assets/scenes/delay.json", "", desk.app);
    CHECK(waits_for_keeper(desk.app));
    CHECK(desk.app.session.scene.delay.has_value());
    check_whole(desk.app.session);
    desk.show_frame();
    act(Action::finish, desk.window, desk.app);  // there is no trial yet that could be finished
    CHECK_FALSE(desk.app.session.trial.finished);

    desk.keeper.busy = false;
    begin_when_kept(desk.window, desk.gui, desk.app);
    CHECK_FALSE(waits_for_keeper(desk.app));
    check_whole(desk.app.session);
    desk.show_frame();
}

TEST_CASE("live: the tissue of a finished trial is changed while the keeper is busy") {
    Desk desk("");
    act(Action::finish, desk.window, desk.app);
    REQUIRE(std::holds_alternative<Reviewing>(desk.app.doing));

    SUBCASE("for another one") {
        change_scene(desk.window, desk.gui, PALPA_SOURCE_DIR "/assets/scenes/delay.json", "", desk.app);
    }
    SUBCASE("turned") {
        const Mapping before = desk.app.session.scene.mapping;
        turn_tissue(desk.window, desk.app);
        begin_anew(desk.window, desk.gui, desk.app);
        const Mapping& now = desk.app.session.scene.mapping;
        CHECK((now.rotate_deg != before.rotate_deg || now.flip != before.flip));
        const View view = make_view(now, desk.app.session.plan->area, desk.app.session.state.screen);
        CHECK(desk.app.session.state.view.axes == view.axes);
    }
    CHECK(std::holds_alternative<Palpating>(desk.app.doing));  // the verdict was on the tissue before
    check_whole(desk.app.session);
    desk.show_frame();
}

TEST_CASE("live: nothing cuts the trial that a replay gives: not R, not another scene, profile or mode") {
    Desk desk("");
    desk.keeper.busy = false;
    Wishes wishes;
    wishes.again = wishes.next = true;
    wishes.mode = TrialMode::test;
    wishes.scene = PALPA_SOURCE_DIR "/assets/scenes/delay.json";
    wishes.profile = PALPA_SOURCE_DIR "/assets/profiles/bamboo.json";
    desk.app.trace = platform::read_trace(default_trace());
    const int trials = desk.app.session.trials;
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(desk.app.session.trials == trials);
    CHECK_FALSE(desk.app.session.scene.delay);
    desk.app.trace.reset();
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(desk.app.session.trials > trials);
    CHECK(desk.app.session.scene.delay.has_value());
}

TEST_CASE("live: the press that a trial ends with does not begin the next one") {
    Desk desk("");
    desk.keeper.busy = false;
    SDL_Event event{};
    const auto push = [&](Uint32 type) {
        event.type = type;
        event.button.windowID = SDL_GetWindowID(desk.window.sdl());
        event.button.button = SDL_BUTTON_LEFT;
        event.button.state = type == SDL_MOUSEBUTTONDOWN ? SDL_PRESSED : SDL_RELEASED;
        event.button.x = 400;
        event.button.y = 200;
        SDL_PushEvent(&event);
    };
    std::vector<Sample> samples;
    const auto poll = [&] {
        samples.clear();
        desk.window.poll(0.02, samples);
        for (const Sample& sample : samples) take_sample(sample, desk.app.session);
    };
    push(SDL_MOUSEBUTTONDOWN);
    poll();
    REQUIRE(desk.app.session.state.pointer.has_value());

    begin_anew(desk.window, desk.gui, desk.app);
    for (int i = 0; i < 3; ++i) poll();  // the button is still held
    CHECK_FALSE(desk.app.session.state.pointer.has_value());
    push(SDL_MOUSEBUTTONUP);
    poll();
    push(SDL_MOUSEBUTTONDOWN);
    poll();
    CHECK(desk.app.session.state.pointer.has_value());
}

TEST_CASE("live: nothing is taken back and nothing is said of a mark while there is none") {
    Desk desk("");
    const auto samples = [&] { return desk.app.session.state.counters.samples; };
    const auto before = samples();
    act(Action::undo, desk.window, desk.app);
    act(Action::confidence_3, desk.window, desk.app);
    act(Action::mark, desk.window, desk.app);
    CHECK(samples() == before);  // no row, no event
    desk.sample(Phase::down);
    desk.sample(Phase::move);
    act(Action::mark, desk.window, desk.app);
    act(Action::confidence_3, desk.window, desk.app);
    REQUIRE(desk.app.session.trial.marks.size() == 1);
    CHECK(desk.app.session.trial.marks[0].confidence == 3);
    act(Action::undo, desk.window, desk.app);
    CHECK(desk.app.session.trial.marks.empty());
}

TEST_CASE("live: a scene that cannot be read leaves the present one") {
    Desk desk("");
    const std::string name = desk.app.session.scene.name;
    change_scene(desk.window, desk.gui, "no_such_scene.json", "", desk.app);
    CHECK(desk.app.session.scene.name == name);
    CHECK(desk.app.notices.problems.size() == 1);
    check_whole(desk.app.session);
}

TEST_CASE("live: while the clock is stopped nothing is marked or finished, and then the trial goes on") {
    Desk desk("");
    const auto& trial = desk.app.session.trial;
    desk.sample(Phase::down);
    desk.sample(Phase::move);
    act(Action::pause, desk.window, desk.app);
    CHECK(trial.paused_at_s.has_value());
    CHECK_FALSE(desk.app.session.state.pointer.has_value());  // a press does not outlive the pause
    act(Action::mark, desk.window, desk.app);
    act(Action::finish, desk.window, desk.app);
    CHECK(trial.marks.empty());
    CHECK_FALSE(trial.finished);
    desk.show_frame();
    act(Action::resume, desk.window, desk.app);
    CHECK_FALSE(trial.paused_at_s.has_value());
    act(Action::mark, desk.window, desk.app);
    CHECK(trial.marks.size() == 1);
    act(Action::finish, desk.window, desk.app);
    CHECK(trial.finished);
}

TEST_CASE("live: a trial that was stopped because its log cannot be written is neither marked, finished nor kept") {
    const TemporaryFolder folder;
    Desk desk("");
    desk.app.history_folder = folder / "history";
    desk.sample(Phase::down);
    desk.sample(Phase::move);
    desk.app.course = TrialStopped{"the disk is full", desk.app.session.trial.now_s};
    act(Action::mark, desk.window, desk.app);
    act(Action::finish, desk.window, desk.app);
    CHECK(desk.app.session.trial.marks.empty());
    CHECK_FALSE(desk.app.session.trial.finished);
    CHECK_FALSE(std::filesystem::exists(desk.app.history_folder));
    CHECK_FALSE(work_at_stake(desk.app));
    desk.show_frame();
}

TEST_CASE("live: results are kept unless the person does not want it, none of the guided start, and are deleted") {
    const TemporaryFolder folder;
    Desk desk("");
    desk.keeper.busy = false;
    desk.app.history_folder = folder / "history";
    const auto kept = [&] {
        std::vector<std::string> problems;
        const std::size_t count = read_history(history_files(desk.app.history_folder, problems), problems).size();
        CHECK(problems.empty());
        return count;
    };
    act(Action::finish, desk.window, desk.app);
    CHECK(kept() == 1);
    begin_anew(desk.window, desk.gui, desk.app);
    desk.app.settings.keep_results = false;
    act(Action::finish, desk.window, desk.app);
    CHECK(kept() == 1);
    desk.app.settings.keep_results = true;

    desk.app.settings.test_mode = true;
    begin_guided(desk.window, desk.gui, desk.app);
    REQUIRE(is_guided(desk.app.doing));
    CHECK(desk.app.session.trial.mode == TrialMode::practice);
    desk.show_frame();
    act(Action::finish, desk.window, desk.app);
    CHECK(kept() == 1);
    REQUIRE(std::holds_alternative<Reviewing>(desk.app.doing));
    CHECK(is_guided(desk.app.doing));
    desk.show_frame();
    leave_guided(desk.window, desk.gui, desk.app);
    CHECK(std::holds_alternative<Palpating>(desk.app.doing));
    CHECK_FALSE(is_guided(desk.app.doing));
    CHECK(desk.app.settings.guided_done);

    open_screen(Screen::history, desk.window, desk.app);
    REQUIRE(std::holds_alternative<BrowsingHistory>(desk.app.doing));
    CHECK(desk.app.view.history->trials.size() == 1);
    desk.show_frame();
    Wishes wishes;
    wishes.delete_results = true;
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(kept() == 0);
    CHECK(desk.app.view.history->trials.empty());
    desk.show_frame();
}

TEST_CASE("live: the guided start is done when the program is quit at its result, and not when in its middle") {
    Desk desk("");
    desk.keeper.busy = false;
    begin_guided(desk.window, desk.gui, desk.app);
    Wishes wishes;
    wishes.quit = true;
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK_FALSE(desk.app.settings.guided_done);
    act(Action::finish, desk.window, desk.app);
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(desk.app.settings.guided_done);
}

TEST_CASE("live: the guided start that is skipped leaves its trial as it is") {
    Desk desk("");
    desk.keeper.busy = false;
    begin_guided(desk.window, desk.gui, desk.app);
    desk.sample(Phase::down);
    desk.sample(Phase::move);
    act(Action::mark, desk.window, desk.app);
    leave_guided(desk.window, desk.gui, desk.app);
    CHECK(desk.app.session.trial.marks.size() == 1);
    CHECK(std::holds_alternative<Palpating>(desk.app.doing));
    CHECK_FALSE(is_guided(desk.app.doing));
}

TEST_CASE("live: the key that closes the list of keys does not leave the guided start") {
    Desk desk("");
    desk.keeper.busy = false;
    begin_guided(desk.window, desk.gui, desk.app);
    frames(desk, 3);
    desk.app.view.help = true;
    frames(desk, 2);
    std::vector<Sample> samples;
    const auto escape_leaves = [&] {
        tap(desk.window, SDLK_ESCAPE);
        bool leaves = false;
        for (int i = 0; i < 4; ++i) {
            desk.window.poll(0.0, samples);
            leaves = leaves || desk.show_frame().guided == std::optional<bool>(false);
        }
        return leaves;
    };
    CHECK_FALSE(escape_leaves());
    CHECK_FALSE(desk.app.view.help);
    CHECK(escape_leaves());
}

TEST_CASE(
    "live: what a finished trial reveals follows the controls to the other side, and its samples stay as they were") {
    Desk desk("");
    desk.keeper.busy = false;
    frames(desk, 2);
    desk.sample(Phase::down);
    desk.sample(Phase::up);
    act(Action::finish, desk.window, desk.app);
    REQUIRE(std::holds_alternative<Reviewing>(desk.app.doing));
    const scene::State& state = desk.app.session.state;
    const double before_px = state.screen.x_px;
    const double before_mm = 1e3 * tissue_of_px(state.view, {state.screen.x_px, 0.0}).x();
    const std::int64_t samples = state.counters.samples;
    desk.app.settings.left_handed = true;
    note_resize(desk.window, desk.gui, desk.app);
    CHECK(state.screen.x_px < before_px - 10.0);
    CHECK(1e3 * tissue_of_px(state.view, {state.screen.x_px, 0.0}).x() == close_to(before_mm));
    CHECK(state.counters.samples == samples);
}

TEST_CASE(
    "live: in the question before marks are lost Enter presses the button that a ring shows, else ends the trial") {
    for (const bool ring : {false, true}) {
        CAPTURE(ring);
        Desk desk("");
        frames(desk, 2);
        desk.sample(Phase::down);
        desk.sample(Phase::up);
        act(Action::mark, desk.window, desk.app);
        Wishes close;
        close.quit = true;
        carry_out(close, desk.window, desk.gui, desk.app);
        REQUIRE(desk.app.asked);
        const auto shown = [&](int count) {
            std::vector<Sample> samples;
            for (int i = 0; i < count; ++i) {
                desk.window.poll(0.0, samples);
                carry_out(desk.show_frame(), desk.window, desk.gui, desk.app);
            }
        };
        shown(3);
        if (ring)
            tap(desk.window, SDLK_LEFT);  // the ring shows on the continuation, where a second Enter loses nothing
        shown(4);
        REQUIRE(desk.app.asked);
        CHECK(desk.gui.shows_focus() == ring);
        tap(desk.window, SDLK_RETURN);
        shown(6);
        CHECK_FALSE(desk.app.asked);
        CHECK(desk.app.quit == !ring);
        CHECK(desk.app.session.trial.marks.size() == 1);
    }
}

TEST_CASE("live: a test of parts does not turn them, since it hides nothing") {
    Desk desk(PALPA_SOURCE_DIR "/assets/scenes/toothbrush.json");
    turn_tissue(desk.window, desk.app);
    CHECK(desk.app.session.scene.mapping.rotate_deg == 0);
    CHECK_FALSE(desk.app.session.scene.mapping.flip);
    turn_tissue(desk.window, desk.app);
    CHECK(desk.app.session.scene.mapping.rotate_deg == 0);
}

TEST_CASE("live: in a scene with a random turn the next one cannot be told from this one, and is another") {
    Desk desk(PALPA_SOURCE_DIR "/assets/scenes/random-turn.json");
    const auto turn = [&] {
        const Mapping& mapping = desk.app.session.scene.mapping;
        return mapping.rotate_deg / 90 + (mapping.flip ? 4 : 0);
    };
    std::set<int> steps;
    for (int i = 0; i < 200; ++i) {
        const int before = turn();
        turn_tissue(desk.window, desk.app);
        steps.insert((turn() - before + 8) % 8);
    }
    CHECK(steps == std::set<int>{1, 2, 3, 4, 5, 6, 7});
}

TEST_CASE("live: a scene with a random turn is drawn in all eight, another one stays as it is") {
    Scene scene = load_scene(PALPA_SOURCE_DIR "/assets/scenes/random-turn.json");
    REQUIRE(scene.mapping.random_turn);
    std::set<int> turns;
    for (int i = 0; i < 400; ++i) {
        draw_turn(scene);
        turns.insert(scene.mapping.rotate_deg + (scene.mapping.flip ? 1 : 0));
    }
    CHECK(turns.size() == 8);
    Scene plain = load_scene("");
    draw_turn(plain);
    CHECK(plain.mapping.rotate_deg == 0);
    CHECK_FALSE(plain.mapping.flip);
}

TEST_CASE("live: a finger without a sensor is named as soon as its press shows it") {
    Desk desk("");
    Sample sample;
    sample.tool = Tool::finger;
    sample.pressure = 1.0;
    for (int i = 0; i < 100; ++i) {
        sample.phase = i == 0 ? Phase::down : Phase::move;
        sample.t_host_s = 0.02 * i;
        watch(sample, desk.app.pressure);
    }
    note_devices(desk.window, desk.app);
    REQUIRE(desk.app.notices.pressure_notes.size() == 1);
    CHECK(desk.app.notices.pressure_notes[0] == words::filled(words::kReportsConstant, {"finger"}));
    CHECK(desk.app.notices.offer_hold);
}

TEST_CASE("live: what the command line asks for is for this run and is not kept as the person's choice") {
    const TemporaryFolder folder;
    const char* before = std::getenv("XDG_CONFIG_HOME");
    const std::string config = before == nullptr ? "" : before;
    setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
    RunOptions options;
    options.left_handed = options.test = true;
    options.width_px = 900;
    App app;
    load(options, app);
    CHECK(app.settings.left_handed);
    CHECK(app.settings.test_mode);
    app.settings.text_percent = 120;  // chosen in the menu
    keep_settings(app);
    std::string problem;
    const Settings kept = load_settings(app.settings_path, problem);
    CHECK(problem.empty());
    CHECK(kept.text_percent == 120);
    CHECK_FALSE(kept.left_handed);
    CHECK_FALSE(kept.test_mode);
    CHECK(kept.width_px == Settings{}.width_px);
    before == nullptr ? unsetenv("XDG_CONFIG_HOME") : setenv("XDG_CONFIG_HOME", config.c_str(), 1);
}
