#include <doctest/doctest.h>

#include "study/withdrawal.h"
#include "tests/temporary_folder.h"

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
