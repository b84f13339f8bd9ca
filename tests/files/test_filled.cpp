#include <doctest/doctest.h>

#include "files/filled.h"

using namespace palpa;
using namespace palpa::files;

TEST_CASE("filled: patterns are filled in order, each gap once") {
    CHECK(filled("{} of {}", {"3", "8"}) == "3 of 8");
    CHECK(filled("{}", {"{}"}) == "{}");
    CHECK(filled("nothing", {}) == "nothing");
    CHECK(filled("", {}).empty());
}
