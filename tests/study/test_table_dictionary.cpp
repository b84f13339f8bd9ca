#include <doctest/doctest.h>
#include <set>

#include "study/observations.h"
#include "study/table_dictionary.h"
#include "tests/error_message.h"

using namespace palpa::study;
using palpa::test::contains;

namespace {

// A study with every kind of table: nodules, rated marks, choices at levels, answers, a plan, and groups.
Observations study_with_everything() {
    Observations seen;
    seen.from_logs = true;
    seen.conditions = {"a", "b"};
    seen.groups = {"I", "II"};
    seen.nodules = {"N1", "N2"};
    seen.comparisons = {"2 kPa"};
    for (int person = 0; person < 12; ++person) {
        seen.participants.push_back("p" + std::to_string(person));
        seen.group_of.push_back(person % 2);
        for (int c = 0; c < 2; ++c) {
            JudgedCase one{c, person, "t", {"N1", "N2"}, {}, true};
            for (int nodule = 0; nodule < 2; ++nodule) {
                const bool hit = (person + nodule + c) % 3 != 0;
                seen.rows.push_back({c, person, nodule, 0, hit, !hit, 0});
                one.reading.ll.push_back(hit ? 3.0 : kUnmarked);
            }
            one.reading.nl.push_back(1.0 + person % 3);
            seen.judged.push_back(one);
            seen.rows.push_back({c, person, -1, 0, 0, 0, 1});
            seen.trials.push_back({c, person, 30.0 + person, 1.0, 2.0, 3.0});
            for (int level = -2; level <= 2; ++level) {
                seen.choices.push_back({c, person, 0, (person + level + c) % 4 != 0 ? 1 : 0, 1});
                seen.stiffer.push_back({c, person, StiffnessAxis::second_first, 0.2 * level, level > 0 ? 1 : 0, 1});
            }
            seen.answers.push_back({seen.conditions[static_cast<std::size_t>(c)], "effort", "3", person});
            seen.progress.push_back({seen.participants.back(), "I", seen.conditions[static_cast<std::size_t>(c)]});
        }
        seen.staircases.push_back({});
        seen.staircases.back().condition = "a";
        seen.staircases.back().participant = seen.participants.back();
    }
    seen.displays = {{seen.conditions[0], "pen", false}, {seen.conditions[1], "tangible", true}};
    PrimaryComparison primary;
    primary.sides = {"a", "b"};
    seen.primary = primary;
    seen.exclusions.push_back({"p1", std::nullopt, "ill"});
    return seen;
}

}  // namespace

TEST_CASE("table dictionary: every column of every table of a report has a description") {
    const Report report = make_report(study_with_everything(), {});
    std::set<std::string> seen;
    for (const ReportTable& table : report_tables(report)) {
        CAPTURE(table.name);
        seen.insert(table.name);
        const auto dictionary = dictionary_of(table);
        CHECK(dictionary.size() == table.columns.size());
        for (const std::string& column : table.columns) {
            CAPTURE(column);
            CHECK(dictionary[column]["Description"].get<std::string>() != column);
        }
    }
    for (const std::string& name : table_names()) {
        CAPTURE(name);
        CHECK(seen.count(name) == 1);
    }
}

TEST_CASE("table dictionary: a table's own meaning of a column comes before the general one") {
    const auto text = [](const char* table, const char* column) {
        return dictionary_of({table, "", {column}, {}})[column]["Description"].get<std::string>();
    };
    CHECK(contains(text("pairs", "difference"), "mean over participants"));
    CHECK(contains(text("ppv_pairs", "difference"), "pooled ratios"));  // which a mean of each person's is not
    CHECK(contains(text("ppv_pairs", "t"), "jackknife"));
    CHECK(text("psychometric", "sd") != text("trials", "sd"));
    CHECK(text("groups", "a") != text("pairs", "a"));
    CHECK(text("pairs", "none") == "none");
    CHECK(dictionary_of({"psychometric", "", {"jnd_percent"}, {}})["jnd_percent"]["Units"] == "%");
}
