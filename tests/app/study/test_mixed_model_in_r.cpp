// The script for lme4 beside a report, run by R where R and lme4 are installed.

#include <cmath>
#include <doctest/doctest.h>
#include <sstream>

#include "files/json.h"
#include "files/table.h"
#include "files/text.h"
#include "tests/error_message.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::test;

namespace {

// What R prints after a word, as numbers.
std::vector<double> numbers_after(const std::string& word, const std::string& text) {
    const std::size_t begin = text.find(word + " ");
    if (begin == std::string::npos) return {};
    std::istringstream line(text.substr(begin + word.size(), text.find('\n', begin) - begin - word.size()));
    std::vector<double> out;
    for (double x = 0.0; line >> x;) out.push_back(x);
    return out;
}

void write_counts(const char* answers, const std::filesystem::path& file) {
    Table table = read_csv(std::string(PALPA_RECORDINGS "/statistics/") + answers);
    std::string rows = "condition\tparticipant\tnodule\ttp\tfn\tfp\n";
    while (table.next()) {
        const auto of = [&](const char* column) { return std::string(table.field(table.column(column))); };
        rows +=
            "c" + of("c") + "\tp" + of("p") + "\tl" + of("l") + (of("y") == "1" ? "\t1\t0\tn/a\n" : "\t0\t1\tn/a\n");
    }
    write_text_atomically(file, rows);
}

}  // namespace

TEST_CASE("mixed model in R: lme4 finds the report's numbers by the script that stands beside it") {
    if (shell("Rscript -e 'library(lme4)'").status != 0) {
        MESSAGE("not checked: R with lme4 (r-cran-lme4) is not installed");
        return;
    }
    for (const char* answers : {"glmm1.csv", "glmm2.csv"}) {
        CAPTURE(answers);
        const TemporaryFolder folder;
        write_counts(answers, folder / "counts.tsv");
        const std::string report = (folder / "report").string();
        const Called called = shell("timeout 120 " PALPA_PROGRAM " study analyse " + (folder / "counts.tsv").string() +
                                    " --json -o " + report);
        REQUIRE(called.status == 0);
        write_text_atomically(report + "/check.R",
                              "source(\"mixed_model.R\")\n"
                              "cat(\"FIXED\", sprintf(\"%.9f\", fixef(with_conditions)), \"\\n\")\n"
                              "cat(\"SPREADS\", sprintf(\"%.9f\", as.data.frame(VarCorr(with_conditions))$sdcor), "
                              "\"\\n\")\n"
                              "cat(\"LOGLIK\", sprintf(\"%.9f\", c(logLik(with_conditions), logLik(one_for_all))), "
                              "\"\\n\")\n");
        const Called r = shell("cd " + report + " && timeout 300 Rscript check.R");
        CAPTURE(r.err);
        REQUIRE(r.status == 0);
        const Json json = parse_json(called.out, "stdout")["mixed_logistic"];
        const auto fixed = numbers_after("FIXED", r.out), spreads = numbers_after("SPREADS", r.out);
        const auto log_likelihood = numbers_after("LOGLIK", r.out);
        REQUIRE(fixed.size() == 2);
        REQUIRE(spreads.size() == 2);
        REQUIRE(log_likelihood.size() == 2);
        for (std::size_t c = 0; c < 2; ++c)
            CHECK(std::abs(json["conditions"][c]["log_odds"].get<double>() - fixed[c]) < 1e-4);
        CHECK(std::abs(json["spread_participants"].get<double>() - spreads[0]) < 1e-4);
        CHECK(std::abs(json["spread_nodules"].get<double>() - spreads[1]) < 1e-4);
        CHECK(std::abs(json["log_likelihood"].get<double>() - log_likelihood[0]) < 1e-5);
        CHECK(std::abs(json["test"]["likelihood_ratio"].get<double>() - 2.0 * (log_likelihood[0] - log_likelihood[1])) <
              1e-4);
    }
}
