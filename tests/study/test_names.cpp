#include <doctest/doctest.h>

#include "study/names.h"

using namespace palpa::study;

TEST_CASE("names: words for a missing value, quotes and tabs are refused, others taken") {
    for (const char* name :
         {"", "NA", "n/a", "N/A", "NaN", "nan", "null", "NULL", "None", "<NA>", "a\"b", "a\tb", "a\nb"}) {
        CAPTURE(name);
        CHECK_FALSE(is_name(name));
    }
    for (const char* name : {"none", "na", "pen", "2.25 kPa", "bare finger", "Zeh'n", "\xc3\xa4"}) {
        CAPTURE(name);
        CHECK(is_name(name));
    }
    for (const char* code : {"", "NA", "null", "nan", "None", "0 1", "sub-01", "\xc3\xa4"}) {
        CAPTURE(code);
        CHECK_FALSE(is_code(code));
    }
    CHECK(names_a_sum("Total"));
    CHECK_FALSE(is_code("all"));
    CHECK_FALSE(names_a_sum("total force"));
    CHECK(has_outer_space(" a"));
    CHECK(has_outer_space("a\xC2\xA0"));
    CHECK_FALSE(has_outer_space("a b"));
    for (const char* code : {"01", "P7", "sim0001", "na"}) CHECK(is_code(code));
}
