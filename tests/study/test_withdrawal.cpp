#include <doctest/doctest.h>

#include "files/text.h"
#include "study/withdrawal.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("withdrawal: it is kept with the answers, and the last one holds") {
    const TemporaryFolder folder;
    CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::none);
    add_ratings(folder.path(), "07", {consent_given(), {"pen", "withdrawal", "data must not be used"}});
    CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::none);  // a rating of a condition is none
    withdraw(folder.path(), "07", Withdrawal::keeps_data);
    CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::keeps_data);
    withdraw(folder.path(), "07", Withdrawal::takes_data);
    CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::takes_data);
    CHECK(withdrawal_of(folder.path(), "08") == Withdrawal::none);
}

TEST_CASE("withdrawal: a table that a spreadsheet saved says the same, and any other word is refused") {
    const TemporaryFolder folder;
    withdraw(folder.path(), "07", Withdrawal::takes_data);
    const auto file = ratings_file(folder.path(), "07");
    write_text_atomically(file,
                          "\xEF\xBB\xBF"
                          "condition\titem\tvalue\r\nn/a\twithdrawal\tdata must not be used\r\n");
    CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::takes_data);
    std::vector<std::string> notes;
    CHECK(takes_data(folder.path(), "07", notes));
    REQUIRE(notes.size() == 1);
    CHECK(contains(notes[0], "left out"));
    write_text_atomically(file, "n/a\twithdrawal\tdata must not be used\n");  // without its header
    CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::takes_data);
    write_text_atomically(file, "condition\titem\tvalue\nn/a\twithdrawal\tData must not be used\n");
    CHECK(
        contains(message_of([&] { withdrawal_of(folder.path(), "07"); }),
                 "withdrawal: found 'Data must not be used', expected 'data may be used' or 'data must not be used'"));
}

TEST_CASE("withdrawal: what a power cut left of one is refused until it is noted again, never taken for none") {
    const TemporaryFolder folder;
    const std::string header = "condition\titem\tvalue\n";
    const std::string whole = "n/a\twithdrawal\tdata must not be used\n";
    withdraw(folder.path(), "07", Withdrawal::takes_data);
    const auto file = ratings_file(folder.path(), "07");
    for (std::size_t bytes = 0; bytes <= whole.size(); ++bytes) {
        CAPTURE(bytes);
        write_text_atomically(file, header + whole.substr(0, bytes));
        const std::string refusal = message_of([&] { withdrawal_of(folder.path(), "07"); });
        if (bytes < 5) {
            CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::none);  // might be any answer
        } else if (bytes < whole.size() - 1) {
            CHECK(contains(refusal, "note it by palpa study withdraw"));
        } else {
            CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::takes_data);
        }
        add_ratings(folder.path(), "07", {{"n/a", "age", "30"}});  // does not complete it
        const std::string after = message_of([&] { withdrawal_of(folder.path(), "07"); });
        CHECK(after.empty() == (bytes < 5 || bytes == whole.size()));
        withdraw(folder.path(), "07", Withdrawal::keeps_data);
        CHECK(withdrawal_of(folder.path(), "07") == Withdrawal::keeps_data);
    }
}

TEST_CASE("withdrawal: half an answer never becomes a whole one, whatever follows it") {
    const TemporaryFolder folder;
    add_ratings(folder.path(), "07", {{"n/a", "sex", "f"}});
    const auto file = ratings_file(folder.path(), "07");
    write_text_atomically(file, read_text(file) + "n/a\tage\t2");  // of 23
    add_ratings(folder.path(), "07", {{"pen", "effort", "5"}});
    std::vector<std::string> notes;
    const auto answers = read_ratings(folder.path(), "07", notes);
    REQUIRE(answers.size() == 2);
    CHECK(answers[0].item == "sex");
    CHECK(answers[1].item == "effort");
    CHECK(notes.size() == 1);
}
