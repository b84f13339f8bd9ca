#include <doctest/doctest.h>

#include "files/json.h"
#include "files/text.h"
#include "study/dataset.h"
#include "study/trial_log.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::study;
using namespace palpa::test;
using palpa::files::read_json;
using palpa::files::read_text;

namespace {

Protocol of_authors(const std::string& dataset) {
    const TemporaryFolder folder;
    palpa::files::write_text_atomically(folder / "p.json",
                                        R"({"name": "n", "version": "2", "seed": 5, "order": "fixed", "conditions": [
                                            {"id": "a", "modality": "hand"}])" +
                                            dataset + "}");
    return read_protocol(folder / "p.json");
}

}  // namespace

TEST_CASE(
    "dataset: README, authors and the columns of all tables at the top are described, and nothing is overwritten") {
    const Protocol protocol =
        of_authors(R"(, "dataset": {"authors": ["Ada L.", "Bo M."], "license": "CC0", "ethics_approvals": ["E 7"]})");
    const TemporaryFolder folder;
    describe_dataset(folder.path(), protocol, {false, 0, "palpa 9.8"});
    const auto about = read_json(folder / "dataset_description.json");
    CHECK(about["Name"] == "n");
    CHECK(about["Authors"] == palpa::files::Json({"Ada L.", "Bo M."}));
    CHECK(about["GeneratedBy"][0]["Version"] == "9.8");
    CHECK(about["EthicsApprovals"][0] == "E 7");
    CHECK_FALSE(about.contains("Funding"));
    const std::string readme = read_text(folder / "README");
    CHECK(contains(readme, "- Ada L."));
    CHECK(contains(readme, protocol.sha256));
    CHECK(read_json(folder / "participants.json").size() == 8);
    CHECK(read_json(folder / "exclusions.json").contains("reason"));
    palpa::files::write_text_atomically(folder / "README", "mine");
    describe_dataset(folder.path(), protocol, {});
    CHECK(read_text(folder / "README") == "mine");
}

TEST_CASE("dataset: simulated participants are called so, and authors that are not stated are not invented") {
    const Protocol protocol = of_authors("");
    const TemporaryFolder simulated, people;
    describe_dataset(simulated.path(), protocol, {true, 1, "palpa 1"});
    describe_dataset(people.path(), protocol, {false, 0, "palpa 1"});
    CHECK(contains(read_text(simulated / "README"), "SIMULATED: no person took part"));
    CHECK(contains(read_json(simulated / "dataset_description.json")["Authors"][0].get<std::string>(), "No person"));
    CHECK_FALSE(read_json(people / "dataset_description.json").contains("Authors"));
    CHECK(contains(read_text(people / "README"), "Authors: not stated"));
}

TEST_CASE("dataset: authors that are no list of texts are refused with their key") {
    const auto said = [](const char* dataset) { return message_of([&] { of_authors(dataset); }); };
    CHECK(contains(said(R"(, "dataset": {"authors": "Ada"})"),
                   "dataset.authors: found 'Ada', expected an array of texts"));
    CHECK(contains(said(R"(, "dataset": {"authors": [1]})"), "dataset.authors: found 1, expected texts"));
    CHECK(contains(said(R"(, "dataset": {"author": ["Ada"]})"), "author"));
    CHECK(contains(said(R"(, "analysis": {"participants": 0})"), "analysis.participants"));
}
