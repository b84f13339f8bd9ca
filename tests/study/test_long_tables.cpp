#include <cmath>
#include <doctest/doctest.h>

#include "study/long_tables.h"

using namespace palpa::study;

namespace {

using Cells = std::vector<std::string>;

Observations logged_study() {
    Observations seen;
    seen.from_logs = true;
    seen.conditions = {"a", "b"};
    seen.participants = {"01", "02"};
    seen.groups = {"I"};
    seen.group_of = {0, -1};
    seen.nodules = {"N1", "N2"};
    seen.comparisons = {"30 kPa"};
    for (int repeat = 0; repeat < 2; ++repeat) {
        seen.rows.push_back({1, 0, 0, repeat, 1, 0, 0});
        seen.rows.push_back({1, 0, 1, repeat, repeat, 1 - repeat, 0});
        seen.rows.push_back({1, 0, -1, repeat, 0, 0, 3});
        seen.trials.push_back({1, 0, 12.5 + repeat, 0.25, 1.5, std::nan("")});
    }
    return seen;
}

}  // namespace

TEST_CASE("long tables: each nodule and each trial is a row that names what it depends on") {
    const Observations seen = logged_study();
    const auto tables = long_tables(seen);
    REQUIRE(tables.size() == 2);
    CHECK(tables[0].table.name == "nodules_long");
    REQUIRE(tables[0].table.rows.size() == 4);
    CHECK(tables[0].table.rows[1] == Cells{"01", "I", "b", "N2", "1", "0", "1"});
    CHECK(tables[0].table.rows[3] == Cells{"01", "I", "b", "N2", "2", "1", "0"});
    REQUIRE(tables[1].table.rows.size() == 2);
    CHECK(tables[1].table.rows[0] == Cells{"01", "I", "b", "1", "12.5", "250", "1.5", "n/a", "1", "1", "3"});
    CHECK(tables[1].table.rows[1] == Cells{"01", "I", "b", "2", "13.5", "250", "1.5", "n/a", "2", "0", "3"});
}

TEST_CASE("long tables: choices of logs have both lists in one row, staircases and counts what is known") {
    Observations seen = logged_study();
    seen.choices.push_back({0, 1, 0, 1, 1});
    seen.stiffer.push_back({0, 1, StiffnessAxis::second_first, 0.5, 1, 1});
    CHECK(choices_long(seen).table.rows[0] == Cells{"02", "n/a", "a", "30 kPa", "1", "1", "second/first", "0.5", "1"});
    seen.stiffer.push_back({1, 1, StiffnessAxis::comparison_reference, -0.5, 0, 1});  // of a staircase
    const auto rows = choices_long(seen).table.rows;
    REQUIRE(rows.size() == 2);
    CHECK(rows[1] == Cells{"02", "n/a", "b", "n/a", "n/a", "1", "comparison/reference", "-0.5", "0"});
    seen.stiffer.clear();
    seen.choices[0].participant = seen.choices[0].comparison = -1;
    CHECK(choices_long(seen).table.rows[0] == Cells{"n/a", "n/a", "a", "n/a", "1", "1", "n/a", "n/a", "n/a"});
}

TEST_CASE("long tables: the dictionary explains every column, and every row has a cell in each") {
    Observations seen = logged_study();
    seen.choices.push_back({0, 1, 0, 1, 1});
    const auto tables = long_tables(seen);
    REQUIRE(tables.size() == 3);
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const LongTable& one = tables[i];
        CHECK(one.table.name == long_table_names()[i]);
        CHECK(one.dictionary.size() == one.table.columns.size());
        for (const std::string& column : one.table.columns) CHECK(one.dictionary.contains(column));
        for (const auto& row : one.table.rows) CHECK(row.size() == one.table.columns.size());
    }
}
