#include <doctest/doctest.h>

#include "files/text.h"
#include "study/check_logs.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

Protocol with_questions(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 3, "order": "fixed",
        "conditions": [{"id": "a", "modality": "hand"}],
        "demographics": [{"id": "hobby", "text": "t"}],
        "ratings": [{"id": "effort", "text": "t", "from": 1, "to": 7},
                    {"id": "like", "text": "t", "choices": ["yes, \"much\"", "no"]}]})");
    return read_protocol(folder / "p.json");
}

std::string text_of(const std::vector<Rating>& answers) {
    std::string out;
    for (const Rating& one : answers) out += one.condition + " " + one.item + " " + one.value + "; ";
    return out;
}

}  // namespace

TEST_CASE("check logs: answers that the protocol offers count once") {
    const TemporaryFolder folder;
    const Protocol protocol = with_questions(folder);
    std::vector<std::string> notes;
    const std::vector<Rating> good{
        {"n/a", "hobby", "chess"}, {"a", "effort", "7"}, {"a", "like", "yes, 'much'"}, {"n/a", "consent", "given"}};
    CHECK(text_of(answers_to_questions(&protocol, "01", good, notes)) ==
          "n/a hobby chess; a effort 7; a like yes, 'much'; ");
    CHECK(notes.empty());
    const std::vector<Rating> kept = answers_to_questions(&protocol, "01", good, notes);
    CHECK_FALSE(kept[1].chosen);  // of a scale
    CHECK(kept[2].chosen);
    const std::vector<Rating> again{{"a", "effort", "7"}, {"a", "like", "no"}, {"a", "effort", "2"}};
    CHECK(text_of(answers_to_questions(&protocol, "01", again, notes)) == "a effort 2; a like no; ");
    REQUIRE(notes.size() == 1);
    CHECK(notes[0] ==
          "sub-01: 'effort' under 'a' is answered more than once, '7' and then '2': the last answer counts");
    CHECK(text_of(answers_to_questions(nullptr, "01", again, notes)) == "a effort 2; a like no; ");
}

TEST_CASE("check logs: answers that the protocol does not offer are left out and named") {
    const TemporaryFolder folder;
    const Protocol protocol = with_questions(folder);
    for (const Rating& odd : std::vector<Rating>{{"a", "effort", "8"},
                                                 {"a", "effort", "3.5"},
                                                 {"a", "effort", "much"},
                                                 {"a", "like", "perhaps"},
                                                 {"a", "hobby", "chess"},
                                                 {"b", "effort", "3"},
                                                 {"n/a", "effort", "3"}}) {
        CAPTURE(odd.condition + " " + odd.item + " " + odd.value);
        std::vector<std::string> notes;
        CHECK(answers_to_questions(&protocol, "01", {odd}, notes).empty());
        REQUIRE(notes.size() == 1);
        CHECK(contains(notes[0], "sub-01: the answer '" + odd.value + "' to '" + odd.item));
    }
}

TEST_CASE("check logs: trials of one condition with other nodules are named") {
    NodulesOfConditions seen;
    std::vector<std::string> notes;
    seen.compare("a", "1.json", {{"A", 10.0}, {"B", 8.0}}, notes);
    seen.compare("a", "2.json", {{"B", 8.0}, {"A", 10.0}}, notes);
    seen.compare("b", "3.json", {}, notes);
    CHECK(notes.empty());
    seen.compare("a", "4.json", {{"A", 10.0}}, notes);
    REQUIRE(notes.size() == 1);
    CHECK(notes[0] == "4.json: the nodules are A, but A, B in 1.json, of the same condition");
}
