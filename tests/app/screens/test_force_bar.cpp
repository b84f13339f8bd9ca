#include <doctest/doctest.h>
#include <string>

#include "app/screens/force_bar.h"
#include "app/screens/words.h"

using namespace palpa::app;

TEST_CASE("force bar: a contact that did not settle is told to the experimenter, a limit of the tissue to everybody") {
    palpa::scene::Contact contact;
    contact.measured = true;
    CHECK(std::string(contact_note(contact, true)).empty());
    contact.inexact = true;
    CHECK(std::string(contact_note(contact, true)) == words::kNotSettled);
    CHECK(std::string(contact_note(contact, false)).empty());
    contact.saturated = true;
    CHECK(std::string(contact_note(contact, true)) == words::kBeyondKnownDepth);
    CHECK(std::string(contact_note(contact, false)) == words::kBeyondKnownDepth);
}
