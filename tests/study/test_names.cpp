#include <doctest/doctest.h>

#include "study/names.h"

using namespace palpa::study;

TEST_CASE("names: words for a missing value, quotes and tabs are refused, others taken") {
    for (const char* name :
         {"", "NA", "n/a", "N/A", "NaN", "nan", "null", "NULL", "None", "<NA>", "a\"b", "a\tb", "a\nb", " a", "a "}) {
        CAPTURE(name);
        CHECK_FALSE(is_name(name));
    }
    for (const char* name : {"none", "na", "pen", "2.25 kPa", "bare finger", "Zeh'n", "\xc3\xa4"}) {
        CAPTURE(name);
        CHECK(is_name(name));
    }
    for (const char* name : {"all", "Total", "SUM", "overall"}) CHECK(names_a_sum(name));
    for (const char* name : {"", "tota", "all pens"}) CHECK_FALSE(names_a_sum(name));
    for (const char* code : {"", "NA", "null", "nan", "None", "0 1", "sub-01", "\xc3\xa4"}) {
        CAPTURE(code);
        CHECK_FALSE(is_code(code));
    }
    for (const char* code : {"01", "P7", "sim0001", "na"}) CHECK(is_code(code));
}
