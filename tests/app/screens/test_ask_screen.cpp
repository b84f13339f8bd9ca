// What would throw away marks is asked about first; the question drawn is in test_screens.cpp.

#include <doctest/doctest.h>

#include "app/screens/screens.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::session;
using namespace palpa::app;

TEST_CASE("ask: everything that ends a trial waits for an answer, a mark of the same frame does not") {
    const auto wish = [](auto set) {
        Wishes wishes;
        set(wishes);
        return wishes;
    };
    const Wishes ending[] = {wish([](Wishes& w) { w.studies = true; }),
                             wish([](Wishes& w) { w.again = true; }),
                             wish([](Wishes& w) { w.next = true; }),
                             wish([](Wishes& w) { w.quit = true; }),
                             wish([](Wishes& w) { w.scene = "delay.json"; }),
                             wish([](Wishes& w) { w.profile = ""; }),
                             wish([](Wishes& w) { w.mode = TrialMode::test; }),
                             wish([](Wishes& w) { w.above_finger = true; }),
                             wish([](Wishes& w) { w.px_per_mm = kMissing; })};
    for (Wishes wishes : ending) {
        wishes.action = Action::mark;
        std::optional<Wishes> asked;
        const Wishes now = ask_first(wishes, asked);
        REQUIRE(asked);
        CHECK(now.action == Action::mark);
        const bool nothing_else = !now.again && !now.next && !now.quit && !now.scene && !now.profile && !now.mode &&
                                  !now.above_finger && !now.px_per_mm && !now.studies;
        CHECK(nothing_else);
        wishes = *asked;
        CHECK_FALSE(wishes.action);
        wishes.sure = true;
        asked.reset();
        ask_first(wishes, asked);
        CHECK_FALSE(asked);  // it was answered
    }
}

TEST_CASE("ask: what leaves the trial as it is needs no answer") {
    std::optional<Wishes> asked;
    Wishes wishes;
    wishes.action = Action::finish;
    wishes.screen = Screen::scale;
    wishes.full_screen = true;
    wishes.left_handed = true;
    const Wishes now = ask_first(wishes, asked);
    CHECK_FALSE(asked);
    CHECK(now.screen == Screen::scale);
    CHECK(now.action == Action::finish);
}

TEST_CASE("ask: a note goes by itself, and a new one has its time") {
    Notices notices;
    notices.note = "first";
    age_note(10.0, notices);
    age_note(17.0, notices);
    CHECK(notices.note == "first");
    notices.note = "second";
    age_note(19.0, notices);
    CHECK(notices.note == "second");
    age_note(28.0, notices);
    CHECK(notices.note.empty());
}
