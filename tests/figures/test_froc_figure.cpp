#include <doctest/doctest.h>

#include "figures/froc_figure.h"
#include "files/text.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;

namespace {

study::Report report_of_marks() {
    study::Report report;
    report.free_response.curves = {{"it's {a} _name_", {{5.0, 0.0, 0.25}, {3.0, 0.5, 0.75}}, 0.75},
                                   {"no marks", {}, 0.0},
                                   {"b", {{4.0, 0.25, 1.0}}, 1.0}};
    return report;
}

}  // namespace

TEST_CASE("FROC figure: one curve for each condition with marks, from no mark at all on") {
    const std::string script = figures::froc_script(report_of_marks());
    CHECK(script.find("$froc_1 << EOD\n0 0\n0 0.25\n0.5 0.75\nEOD\n") != std::string::npos);
    CHECK(script.find("title 'it''s {a} _name_' noenhanced") != std::string::npos);
    CHECK(script.find("$froc_2 << EOD\n0 0\n0.25 1\nEOD\n") != std::string::npos);
    CHECK(script.find("no marks") == std::string::npos);
    CHECK(script.find("plot [0:0.525]") != std::string::npos);
}

TEST_CASE("FROC figure: gnuplot draws it in three formats; without marks there is none") {
    const test::TemporaryFolder folder;
    CHECK(figures::draw_froc_figure({}, folder.path()).empty());
    CHECK_FALSE(std::filesystem::exists(folder / "froc.gp"));
    const std::string trouble = figures::draw_froc_figure(report_of_marks(), folder.path());
    CHECK(std::filesystem::exists(folder / "froc.gp"));
    if (!test::has_gnuplot()) return;
    CHECK(trouble.empty());
    CHECK(files::read_text(folder / "froc.svg").find("</svg>") != std::string::npos);
    CHECK(files::read_text(folder / "froc.png").substr(1, 3) == "PNG");
    CHECK(files::read_text(folder / "froc.pdf").substr(0, 4) == "%PDF");
}
