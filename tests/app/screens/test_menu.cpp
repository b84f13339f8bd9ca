// The menu by keys alone: the arrows begin at the present choice. Off screen.

#include <doctest/doctest.h>

#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

struct OpenMenu {
    Desk desk{PALPA_SOURCE_DIR "/assets/scenes/delay.json"};

    OpenMenu() {
        desk.app.notices.scenes = {{"a", "a.json"}, {"b", desk.app.session.scene.file.string()}, {"c", "c.json"}};
        frames(desk, 5);
        desk.app.doing = Palpating{true};
        frames(desk, 8);
    }
    // Taps the keys, and returns the first wish that is more than the present page.
    Wishes after(std::initializer_list<int> keys) {
        for (const int key : keys) {
            tap(desk.window, key);
            std::vector<Sample> samples;
            for (int i = 0; i < 6; ++i) {
                desk.window.poll(0.0, samples);
                const Wishes wishes = desk.show_frame();
                if (wishes.scene || wishes.mode || wishes.left_handed || wishes.screen) return wishes;
            }
        }
        return {};
    }
};

}  // namespace

TEST_CASE("menu: arrows and Enter choose the scene before or after the present one") {
    CHECK(OpenMenu().after({SDLK_UP, SDLK_RETURN}).scene == "a.json");
    CHECK(OpenMenu().after({SDLK_DOWN, SDLK_RETURN}).scene == "c.json");
}

TEST_CASE("menu: the pages are reached by keys") {
    OpenMenu menu;
    const Wishes wishes = menu.after({SDLK_UP, SDLK_UP, SDLK_RIGHT, SDLK_RETURN, SDLK_DOWN, SDLK_RETURN});
    CHECK(menu.desk.app.view.menu_page != MenuPage::trial);
    CHECK((wishes.left_handed || wishes.screen));
}
