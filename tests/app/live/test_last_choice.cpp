// What the app opens with after a scene or a profile that was chosen last time is gone, or cannot be used. Off screen.

#include <doctest/doctest.h>
#include <filesystem>
#include <stdlib.h>

#include "app/scene_choices.h"
#include "app/screens/settings.h"
#include "files/text.h"
#include "tests/app/live/desk.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::app;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

const fs::path kShippedProfile = PALPA_SOURCE_DIR "/assets/profiles/s-pen.json";

// Folders of a person's own, and what the app opens with.
struct Person {
    TemporaryFolder folder;
    Person() {
        ::setenv("XDG_CONFIG_HOME", folder.path().c_str(), 1);
        ::setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
    }
    ~Person() {
        ::unsetenv("XDG_CONFIG_HOME");
        ::unsetenv("XDG_DATA_HOME");
    }
    void chose(const std::string& scene, const fs::path& profile) const {
        std::string problem;
        const Settings kept = load_settings(settings_file(), problem);
        Settings settings = kept;
        settings.scene = scene;
        settings.profile = profile.string();
        save_settings(settings, kept, settings_file());
    }
};

}  // namespace

TEST_CASE("last choice: a profile that is gone or cannot be read is told of, and the scene's own answers") {
    const Person person;
    const fs::path own = person.folder / "mine.json";
    fs::copy_file(kShippedProfile, own);
    person.chose("", own);
    {
        App app;
        load({}, app);
        CHECK(app.session.scene.profile == own);
        CHECK(app.notices.problems.empty());
    }
    files::write_text_atomically(own, "{\"a\":");
    for (const char* said : {"not valid JSON", "is gone"}) {
        App app;
        load({}, app);
        CHECK(app.session.scene.profile != own);
        CHECK(app.settings.profile.empty());
        REQUIRE(app.notices.problems.size() == 1);
        CHECK(contains(app.notices.problems[0], said));
        fs::remove(own);
    }
}

TEST_CASE("last choice: a scene named on the command line keeps its profile, and says so if another one was chosen") {
    const Person person;
    const fs::path own = person.folder / "mine.json";
    fs::copy_file(kShippedProfile, own);
    RunOptions named;
    named.scene = "delay";
    for (const bool chose_own : {true, false}) {
        person.chose("", chose_own ? own : fs::path());
        App app;
        load(named, app);
        CHECK(app.session.scene.profile.filename() == "s-pen.json");
        REQUIRE(app.notices.problems.size() == (chose_own ? 1u : 0u));
        if (chose_own) CHECK(contains(app.notices.problems[0], "profile, s-pen. Yours, mine, can be chosen"));
    }
}

TEST_CASE("last choice: a scene whose map is gone is told of, and the default scene opens") {
    const Person person;
    const fs::path scene = person.folder / "mine.json";
    files::write_text_atomically(scene, R"({"name": "mine", "tissue": {"map": "gone.map"}})");
    person.chose(scene.string(), "");
    App app;
    load({}, app);
    CHECK(app.session.scene.name == load_scene("").name);
    REQUIRE(app.notices.problems.size() == 1);
    CHECK(contains(app.notices.problems[0], "gone.map"));
}

TEST_CASE("last choice: a scene or profile that fails when it is chosen is not remembered") {
    const Person person;
    Desk desk("");
    Wishes wishes;
    wishes.scene = (person.folder / "no_such_scene.json").string();
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(desk.app.settings.scene.empty());
    wishes.scene.reset();
    const fs::path half = person.folder / "half.json";
    files::write_text_atomically(half, R"({"level": "pressure"})");
    wishes.profile = half.string();
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(desk.app.settings.profile.empty());
    CHECK(desk.app.notices.problems.size() == 2);
    wishes.profile.reset();
    wishes.scene = PALPA_SOURCE_DIR "/assets/scenes/delay.json";  // other scenes still open
    carry_out(wishes, desk.window, desk.gui, desk.app);
    CHECK(desk.app.settings.scene == *wishes.scene);
    CHECK(desk.app.notices.problems.size() == 2);
}
