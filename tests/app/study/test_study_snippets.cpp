// The snippets of docs/study.md run as they stand there, on logs of a simulated study.

#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>

#include "files/json.h"
#include "files/text.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "tests/error_message.h"
#include "tests/study/python.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

// The code block of that language.
std::string snippet(const std::string& language) {
    const std::string text = read_text(PALPA_SOURCE_DIR "/docs/study.md");
    const std::string open = "```" + language + "\n";
    const auto begin = text.find(open) + open.size();
    return text.substr(begin, text.find("```", begin) - begin);
}

bool simulate(const TemporaryFolder& folder) {
    const std::string command = "timeout 120 " PALPA_PROGRAM " study simulate " PALPA_SOURCE_DIR
                                "/assets/protocols/effects.json --participants 12 --samples none -o " +
                                (folder / "log").string() + " >/dev/null";
    return std::system(command.c_str()) == 0;
}

}  // namespace

TEST_CASE("study snippets: pandas reads the logs as the analysis does") {
    const std::string python = python_with("pandas");
    if (python.empty()) {
        MESSAGE("not checked: python3-pandas is not installed");
        return;
    }
    const TemporaryFolder folder;
    REQUIRE(simulate(folder));
    const std::string script = snippet("python") + "\nsummary.to_csv('summary.tsv', sep='\\t')\n";
    REQUIRE(run_python(python, folder, script));
    const std::string table = read_text(folder / "summary.tsv");
    const Report report = make_report(read_study(folder / "log"), {});
    REQUIRE(report.conditions.size() == 3);
    for (const ConditionResult& condition : report.conditions) {
        CAPTURE(condition.name);
        CAPTURE(table);
        CHECK(contains(table, condition.name + "\t" + std::to_string(condition.tp) + ".0\t" +
                                  std::to_string(condition.fn) + ".0\t" + std::to_string(condition.fp) + ".0\t"));
    }
}

TEST_CASE("study snippets: R reads the logs") {
    if (std::system("command -v Rscript >/dev/null 2>&1") != 0) {
        MESSAGE("not checked: R is not installed");
        return;
    }
    const TemporaryFolder folder;
    REQUIRE(simulate(folder));
    write_text_atomically(folder / "script.R", snippet("r"));
    const std::string command = "cd " + folder.path().string() + " && timeout 120 Rscript script.R >said.txt 2>&1";
    CHECK(std::system(command.c_str()) == 0);
    CHECK(contains(read_text(folder / "said.txt"), "display ratio"));
}
