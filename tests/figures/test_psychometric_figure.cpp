#include <cmath>
#include <doctest/doctest.h>

#include "figures/psychometric_figure.h"
#include "files/text.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::study;

namespace {

Report report_of_curves(const std::string& condition) {
    Observations seen;
    index_of(condition, seen.conditions);
    index_of("at a step", seen.conditions);
    for (int person = 0; person < 3; ++person) {
        index_of("p" + std::to_string(person), seen.participants);
        for (int i = -2; i <= 2; ++i)
            seen.stiffer.push_back({0, person, StiffnessAxis::second_first, 0.3 * i, 10 + 4 * i + person % 2, 20});
    }
    seen.stiffer.push_back({1, 0, StiffnessAxis::comparison_reference, -0.2, 0, 9});
    seen.stiffer.push_back({1, 0, StiffnessAxis::comparison_reference, 0.2, 9, 9});
    ReportOptions options;
    options.bootstrap.resamples = 100;
    return make_report(seen, options);
}

int times(const std::string& text, const std::string& what) {
    int n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

}  // namespace

TEST_CASE("psychometric figure: one panel for each condition, with a curve for all and for each person") {
    const std::string script = figures::psychometric_script(report_of_curves("it's {a} _name_"));
    CHECK(times(script, "\nplot ") == 2);
    CHECK(times(script, "set title 'it''s {a} _name_' noenhanced") == 1);
    CHECK(times(script, "lw 3") == 1);  // none through a step
    CHECK(times(script, "lw 0.7") == 3);
    CHECK(times(script, "set xlabel 'second / first'") == 1);
    CHECK(times(script, "set xlabel 'comparison / reference'") == 1);
}

TEST_CASE("psychometric figure: gnuplot draws it in three formats; without curves there is none") {
    const test::TemporaryFolder folder;
    CHECK(figures::draw_psychometric_figure({}, folder.path()).empty());
    CHECK_FALSE(std::filesystem::exists(folder / "psychometric.gp"));
    const std::string trouble = figures::draw_psychometric_figure(report_of_curves("on"), folder.path());
    CHECK(std::filesystem::exists(folder / "psychometric.gp"));
    if (!test::has_gnuplot()) return;
    CHECK(trouble.empty());
    CHECK(files::read_text(folder / "psychometric.svg").find("</svg>") != std::string::npos);
    CHECK(files::read_text(folder / "psychometric.png").substr(1, 3) == "PNG");
    CHECK(files::read_text(folder / "psychometric.pdf").substr(0, 4) == "%PDF");
}
