#include <cmath>
#include <doctest/doctest.h>
#include <set>
#include <stdexcept>

#include "accuracy/accuracy.h"
#include "accuracy/mechanics.h"
#include "accuracy/timing.h"
#include "files/table.h"
#include "files/text.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::accuracy;
using mechanics::Element;

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSlow = true;  // instrumented: the larger meshes are left out
#else
constexpr bool kSlow = false;
#endif

constexpr Effort kLeast{true, 0.0, 0.0};

const SlabReference& reference() {
    static const SlabReference made = slab_reference(0.45, kSlow ? std::vector{12} : std::vector{16, 12});
    return made;
}

}  // namespace

TEST_CASE("quantile: the value that a share of the calls stays under") {
    const Timing timing{{5.0, 1.0, 4.0, 2.0, 3.0}};
    CHECK(quantile_us(timing, 0.0) == 1.0);
    CHECK(quantile_us(timing, 0.5) == 3.0);
    CHECK(quantile_us(timing, 0.99) == 5.0);
    CHECK(quantile_us({{7.0}}, 0.5) == 7.0);
    CHECK(time_calls(3, 9, 0.0, [](int) {}).us.size() == 3);
    CHECK(time_calls(3, 9, 1e9, [](int) {}).us.size() == 9);
}

TEST_CASE("CSV: every row has every column, commas do not split, what is unknown is n/a") {
    AccuracyRow row{.group = "g", .series = "s, t", .choice = "c"};
    row.error_percent = -1.5;
    const test::TemporaryFolder folder;
    write_text_atomically(folder / "a.csv", accuracy_csv({row, row}));
    Table table = read_csv(folder / "a.csv");
    for (const char* name : {"group", "choice", "nodes", "dofs", "error_percent", "reference", "offline_s",
                             "per_step_us", "per_step_p99_us", "memory_MB"})
        CHECK(table.has_column(name));
    CHECK(table.next());
    CHECK(table.field(table.column("series")) == "s; t");
    CHECK(table.number(table.column("error_percent")) == -1.5);
    CHECK(std::isnan(table.number(table.column("memory_MB"))));
    CHECK(table.next());
    CHECK(!table.next());
}

TEST_CASE("a measurement that fails is listed with its reason, and the others go on") {
    const std::vector<AccuracyRow> rows =
        run_measurements({{"broken", 1.0, [](auto&) { throw std::runtime_error("no memory"); }},
                          {"good", 1.0, [](std::vector<AccuracyRow>& out) { out.push_back({.group = "g"}); }}});
    REQUIRE(rows.size() == 2);
    CHECK(rows[0].group == "failed");
    CHECK(rows[0].choice == "broken");
    CHECK(rows[0].note == "no memory");
    CHECK(rows[1].group == "g");
    CHECK(accuracy_table(rows).find("no memory") != std::string::npos);
    CHECK(accuracy_json(rows, this_machine())["rows"].size() == 2);
}

TEST_CASE("the slab's smallest mesh: finite pairs, tetrahedra the stiffest, B-bar the best") {
    double last = -100.0;
    for (const Element element : {Element::tet4, Element::hex8, Element::hex8_bbar}) {
        const AccuracyRow row = slab_row(element, {8, 8, 5}, true, 0.45, reference(), kLeast);
        CAPTURE(row.choice);
        CHECK(row.nodes == 486);
        CHECK(row.dofs == 1215);
        for (const double value : {row.error_percent, row.worst_error_percent, row.reference_error_percent,
                                   row.offline_s, row.per_step_us, row.per_step_p99_us})
            CHECK(std::isfinite(value));
        CHECK(row.per_step_us <= row.per_step_p99_us);
        CHECK(row.steps >= 20);
        CHECK(row.error_percent < 0.0);
        CHECK(row.error_percent > last);
        last = row.error_percent;
    }
    CHECK(last > -12.0);  // B-bar: -9.5 % (measured 2026-11)
}

TEST_CASE("B-bar on 2,890 nodes beats tetrahedra on 8,750") {
    if (kSlow) {
        MESSAGE("left out with sanitizers: too slow");
        return;
    }
    CHECK(reference().uncertainty_percent < 0.5);
    const AccuracyRow bbar = slab_row(Element::hex8_bbar, {16, 16, 9}, true, 0.45, reference(), kLeast);
    const AccuracyRow tets = slab_row(Element::tet4, {24, 24, 13}, true, 0.45, reference(), kLeast);
    CHECK(bbar.nodes == 2890);
    CHECK(tets.nodes == 8750);
    CHECK(3.0 * std::abs(bbar.error_percent) < std::abs(tets.error_percent));
}

TEST_CASE("the lists: no measurement twice, quick is part of the whole") {
    for (const auto& list : {slab_measurements, contact_measurements, step_measurements}) {
        const std::vector<Measurement> quick = list({true, 0.05, 0.05});
        const std::vector<Measurement> whole = list({false, 1.0, 1.0});
        CHECK(!quick.empty());
        CHECK(quick.size() <= whole.size());
        for (const Measurement& one : whole) CHECK(one.expected_s > 0.0);
        std::set<std::string> names;
        for (const Measurement& one : whole) CHECK(names.insert(one.what).second);
    }
}
