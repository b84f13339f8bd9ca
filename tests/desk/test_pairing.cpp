#include <algorithm>
#include <doctest/doctest.h>
#include <set>

#include "desk/pairing.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::desk;
using namespace palpa::test;

using Answer = CodeGuard::Answer;

TEST_CASE("pairing: codes are six digits and differ") {
    std::set<std::string> codes;
    for (int i = 0; i < 1000; ++i) {
        const std::string code = random_code();
        CHECK(code.size() == 6);
        CHECK(std::all_of(code.begin(), code.end(), [](char c) { return c >= '0' && c <= '9'; }));
        codes.insert(code);
    }
    CHECK(codes.size() > 990);  // 0.5 alike are expected
}

TEST_CASE("pairing: a thousand wrong codes are few tries, and the right one waits for the lock's end") {
    CodeGuard guard("123456", {});
    int compared = 0, locked = 0;
    double until_s = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const auto result = guard.try_code(std::to_string(100000 + i), "10.0.0.7", 0.01 * i);
        compared += result.answer == Answer::wrong ? 1 : 0;
        locked += result.answer == Answer::locked ? 1 : 0;
        if (result.lock_began) until_s = 0.01 * i + result.wait_s;
    }
    CHECK(compared == 5);
    CHECK(locked == 995);
    CHECK(until_s == close_to(30.04));
    CHECK(guard.try_code("123456", "10.0.0.7", until_s - 0.1).answer == Answer::locked);
    CHECK(guard.try_code("123456", "10.0.0.8", 10.0).answer == Answer::right);  // another address
    CHECK(guard.try_code("123456", "10.0.0.7", until_s + 0.1).answer == Answer::right);
    // all is forgotten after the right one
    CHECK_FALSE(guard.try_code("1", "10.0.0.7", until_s + 0.2).lock_began);
}

TEST_CASE("pairing: lock-outs grow up to an hour") {
    CodeGuard guard("123456", {});
    double now_s = 0.0, before_s = 0.0;
    for (int i = 0; i < 4; ++i) guard.try_code("0", "a", now_s);
    for (int i = 0; i < 10; ++i) {
        const auto result = guard.try_code("0", "a", now_s);
        REQUIRE(result.lock_began);
        CHECK(result.wait_s >= before_s - 1e-6);
        CHECK(result.wait_s <= 3600.0 + 1e-6);
        if (i == 1) CHECK(result.wait_s == close_to(60.0));
        before_s = result.wait_s;
        now_s += result.wait_s + 0.001;
    }
    CHECK(before_s > 1800.0);
}

TEST_CASE("pairing: many addresses meet the lock of all, and take no more memory") {
    CodeGuard guard("123456", {});
    int compared = 0;
    for (int i = 0; i < 5000; ++i) {
        const std::string address =
            "10." + std::to_string(i / 65536) + "." + std::to_string(i / 256 % 256) + "." + std::to_string(i % 256);
        const auto result = guard.try_code("0", address, 0.001 * i);
        compared += result.answer == Answer::wrong ? 1 : 0;
        if (result.lock_began) CHECK(result.everybody);
    }
    CHECK(compared == 20);
    CHECK(guard.remembered() <= 1024);
    CHECK(guard.try_code("123456", "192.168.1.1", 6.0).answer == Answer::locked);
    CHECK(guard.try_code("123456", "192.168.1.1", 31.0).answer == Answer::right);
    // one network of IPv6 is one address
    CHECK(address_group("2001:db8:1:2:3:4:5:6") == address_group("2001:db8:1:2:ffff::1"));
    CHECK(address_group("2001:db8:1:2::1") != address_group("2001:db8:1:3::1"));
    CHECK(address_group("::ffff:10.0.0.1") != address_group("::ffff:10.0.0.2"));
}

TEST_CASE("pairing: what a day of guessing gives") {
    // whoever never stops, from as many addresses as he likes, one try each time that one is compared
    CodeGuard guard("123456", {});
    int compared = 0, address = 0;
    for (double now_s = 0.0; now_s < 86400.0;) {
        const auto result = guard.try_code("0", "10.0.0." + std::to_string(++address), now_s);
        compared += result.answer == Answer::wrong ? 1 : 0;
        now_s += result.wait_s > 0.0 ? result.wait_s : 0.001;
    }
    CHECK(compared < 300);  // of a million codes
}

TEST_CASE("sessions: tokens open the desk until they expire, also after a start anew; only hashes are kept") {
    const TemporaryFolder folder;
    std::string trouble;
    SessionLimits limits;
    limits.lasts_s = 100.0;
    Sessions sessions(folder / "s.json", limits, trouble);
    const auto one = sessions.open(1000.0), two = sessions.open(1050.0);
    CHECK(one.token.size() == 64);
    CHECK(one.token != two.token);
    CHECK(sessions.device_of(one.token, 1099.0) == 1);
    CHECK(sessions.device_of(two.token, 1099.0) == 2);
    CHECK_FALSE(sessions.device_of(one.token, 1100.0));
    CHECK_FALSE(sessions.device_of("", 1000.0));
    CHECK_FALSE(sessions.device_of(one.token.substr(1), 1000.0));
    CHECK_FALSE(contains(read_text(folder / "s.json"), one.token));
    Sessions again(folder / "s.json", limits, trouble);
    CHECK(trouble.empty());
    CHECK(again.device_of(two.token, 1099.0) == 2);
    CHECK(again.open(1101.0).device == 3);
    write_text_atomically(folder / "s.json", "{\"sessions\": 3}");
    Sessions damaged(folder / "s.json", limits, trouble);
    CHECK(contains(trouble, "must pair again"));
    CHECK_FALSE(damaged.device_of(two.token, 1099.0));
}

TEST_CASE("sessions: their number is bounded") {
    std::string trouble;
    SessionLimits limits;
    limits.most = 3;
    Sessions sessions("", limits, trouble);
    std::vector<std::string> tokens;
    for (int i = 0; i < 5; ++i) tokens.push_back(sessions.open(i).token);
    CHECK_FALSE(sessions.device_of(tokens[0], 5.0));
    CHECK_FALSE(sessions.device_of(tokens[1], 5.0));
    for (std::size_t i = 2; i < 5; ++i) CHECK(sessions.device_of(tokens[i], 5.0) == static_cast<int>(i) + 1);
}
