#include <cmath>
#include <doctest/doctest.h>
#include <type_traits>

#include "files/table.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("table: rows, missing values, CRLF, byte order mark, blank lines, no newline at the end") {
    Table table("\xef\xbb\xbfx,y\r\n1,2\r\n\r\n,n/a\r\n3,-4e-1", "t.csv", ',');
    CHECK(table.columns() == std::vector<std::string>{"x", "y"});
    REQUIRE(table.next());
    CHECK(table.number(1) == 2.0);
    REQUIRE(table.next());
    CHECK(std::isnan(table.number(0)));
    CHECK(std::isnan(table.number(1)));
    CHECK(table.line() == 4);
    REQUIRE(table.next());
    CHECK(table.number(1) == -0.4);
    CHECK_FALSE(table.next());
}

TEST_CASE("table: fields in quotes hold separators and quotes, and are numbers without them") {
    Table table("\"x, mm\",\"a \"\"b\"\"\",note\r\n\"1.5\",\"\",\"left, \"\"soft\"\"\"\r\n2,5\" pen,\"\"\n", "t.csv",
                ',');
    CHECK(table.columns() == std::vector<std::string>{"x, mm", "a \"b\"", "note"});
    REQUIRE(table.next());
    CHECK(table.number(0) == 1.5);
    CHECK(table.field(1) == "");
    CHECK(table.field(2) == "left, \"soft\"");
    REQUIRE(table.next());
    CHECK(table.field(1) == "5\" pen");  // a quote inside is one
    CHECK(table.field(2) == "");
    CHECK_FALSE(table.next());

    Table tabs("x\ty\n\"1\t2\"\n", "t.tsv", '\t');
    REQUIRE(tabs.next());
    CHECK(tabs.field(0) == "\"1");
}

TEST_CASE("table: a quote that nothing closes, or that closes too early, is refused by line") {
    const auto said = [](const char* text) {
        return message_of([&] {
            Table table(text, "t.csv", ',');
            while (table.next()) {
            }
        });
    };
    CHECK(said("x,y\n1,\"2\"\n") == "");
    CHECK(contains(said("x,y\n1,\"2\n3\",4\n"), "t.csv: line 2: found a quote that opens the field '\"2'"));
    CHECK(contains(said("x,y\n1,\"2\"3\n"), "expected one that closes it, at the end of the field"));
    CHECK(contains(said("\"x,y\n1,2\n"), "line 1: found a quote that opens the field"));
}

TEST_CASE("table: text in another encoding than UTF-8 is refused by line") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "d.tsv", "condition\ttp\nM\xc3\xbcller\t1\n");
    Table table = read_tsv(folder / "d.tsv");
    REQUIRE(table.next());
    CHECK(table.field(0) == "M\xc3\xbcller");
    write_text_atomically(folder / "d.tsv", "condition\ttp\nMeier\t1\nM\xfcller\t1\n");
    CHECK(contains(message_of([&] { read_tsv(folder / "d.tsv"); }), "line 3: found 'M"));
    CHECK(contains(message_of([&] { read_tsv(folder / "d.tsv"); }), "expected text in UTF-8"));
}

TEST_CASE("table: it stays where it is, as its fields point into its own text") {
    static_assert(!std::is_copy_constructible_v<Table> && !std::is_move_constructible_v<Table>);
    static_assert(!std::is_copy_assignable_v<Table> && !std::is_move_assignable_v<Table>);
    const auto opened = [] { return Table("x,y\n1,2", "t.csv", ','); };
    Table table = opened();  // made in its place
    REQUIRE(table.next());
    CHECK(table.field(1) == "2");
}

TEST_CASE("hard case 31: ragged, non-numeric and locale-comma tables are refused by line and column") {
    const auto said = [](const char* text) {
        return message_of([&] {
            Table table(text, "t.csv", ',');
            while (table.next()) table.finite_number(table.column("force_N"));
        });
    };
    CHECK(said("point,force_N\n1,2\n") == "");
    CHECK(said("point,force_N\n1,2,3\n") ==
          "t.csv: line 2: found 3 fields, expected 2 as in the header (a decimal comma? numbers need a point)");
    CHECK(contains(said("point,force_N\n1\n"), "line 2: found 1 fields, expected 2"));
    CHECK(contains(said("point,force_N\n1,two\n"), "line 2, force_N: found 'two', expected a finite number"));
    CHECK(contains(said("point,force_N\n1,inf\n"), "found 'inf'"));
    CHECK(contains(said("point,force_N\n1,\n"), "expected a finite number"));
    CHECK(contains(said("point,depth\n1,2\n"), "found the columns 'point' 'depth', expected a column 'force_N'"));
    CHECK(contains(said("force_N,force_N\n1,2\n"), "twice"));
    CHECK(contains(said(""), "expected a header line"));
    const auto tsv = message_of([] {
        Table table("t\tforce_N\n0\t1,5\n", "t.tsv", '\t');
        table.next();
        table.number(1);
    });
    CHECK(contains(tsv, "found '1,5', expected a number with a decimal point"));
}
