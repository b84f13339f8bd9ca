// Who types a code never types into nothing. Off screen.

#include <doctest/doctest.h>

#include "tests/app/live/desk.h"
#include "tests/app/screens/typing.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::study;
using namespace palpa::app;
using namespace palpa::test;

TEST_CASE("study screen: the code's field has the letters again after Escape") {
    const TemporaryFolder folder;
    Desk desk("");
    desk.app.doing =
        open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json"), folder / "log", "");
    frames(desk, 5);
    CHECK(desk.app.view.study.code == "01");  // offered
    tap(desk.window, SDLK_ESCAPE);
    frames(desk, 5);
    tap(desk.window, SDLK_END);
    type(desk.window, 'x');
    frames(desk, 5);
    CHECK(desk.app.view.study.code.find('x') != std::string::npos);
}
