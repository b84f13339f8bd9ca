#include <doctest/doctest.h>

#include "desk/request_head.h"
#include "study/random.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::desk;

TEST_CASE("serve head: what the library gets, and what it never sees") {
    const auto head = check_head(
        "PUT /api/logs/x HTTP/1.1\r\nHost: h\r\nContent-Length:  12 \r\nRange: bytes=0-1,0-1\r\nACCEPT-ENCODING: "
        "gzip\r\nX-A:b\r\n\r\n");
    CHECK(head.refused == 0);
    CHECK(head.content_bytes == 12);
    CHECK(head.text == "PUT /api/logs/x HTTP/1.1\r\nHost: h\r\nContent-Length: 12\r\nX-A: b\r\n\r\n");
    CHECK(check_head("GET / HTTP/1.1\r\n\r\n").refused == 0);
}

TEST_CASE("serve head: what is refused") {
    const auto status = [](const std::string& lines) { return check_head(lines + "\r\n\r\n").refused; };
    CHECK(status("GET") == 400);
    CHECK(status("GET /") == 400);
    CHECK(status("GET  / HTTP/1.1") == 400);
    CHECK(status("GET http://h/ HTTP/1.1") == 400);
    CHECK(status("GET /a b HTTP/1.1") == 400);
    CHECK(status("GET /" + std::string(1024, 'a') + " HTTP/1.1") == 414);
    CHECK(status("GET / HTTP/1.1\r\n folded") == 400);
    CHECK(status("GET / HTTP/1.1\r\nno colon") == 400);
    CHECK(status("GET / HTTP/1.1\r\n: x") == 400);
    CHECK(status("GET / HTTP/1.1\r\nA : x") == 400);
    CHECK(status("GET / HTTP/1.1\r\nA: x\ny") == 400);
    CHECK(status("GET / HTTP/1.1\r\nA: x\ry") == 400);
    CHECK(status(std::string("GET / HTTP/1.1\r\nA: \0", 20)) == 400);
    CHECK(status("PUT / HTTP/1.1") == 411);
    CHECK(status("POST / HTTP/1.1\r\nTransfer-Encoding: chunked") == 411);
    CHECK(status("POST / HTTP/1.1\r\nContent-Length: 5\r\ntransfer-encoding: chunked") == 411);
    CHECK(status("PUT / HTTP/1.1\r\nContent-Length: 5\r\nContent-Length: 5") == 400);
    for (const char* length : {"", "-1", "+1", "5x", "5,5", "0x5", "9999999999999999", "99999999999999999999999"}) {
        CAPTURE(length);
        CHECK(status(std::string("PUT / HTTP/1.1\r\nContent-Length: ") + length) == 400);
    }
    CHECK(status("PUT / HTTP/1.1\r\nContent-Length: 5\r\nContent-Encoding: gzip") == 415);
    CHECK(status("PUT / HTTP/1.1\r\nContent-Length: 5\r\nContent-Type: Multipart/form-data; boundary=x") == 415);
    std::string many = "GET / HTTP/1.1";
    for (int i = 0; i < 200; ++i) many += "\r\nA: b";
    CHECK(status(many) == 431);
    CHECK(check_head("").refused == 400);
    CHECK(check_head("GET / HTTP/1.1\r\n").refused == 400);
}

TEST_CASE("serve head: any bytes are refused or become lines without surprises") {
    constexpr std::uint64_t kSeed = 11;
    CAPTURE(kSeed);
    Random random(kSeed);
    const std::string good =
        "PUT /api/logs/x HTTP/1.1\r\nHost: 127.0.0.1:8443\r\nContent-Length: 12\r\nX-Content-SHA256: ab\r\n\r\n";
    for (int i = 0; i < 20000; ++i) {
        std::string head = good;
        for (int change = 0; change < 3; ++change) {
            const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(head.size())));
            if (random.uniform() < 0.5)
                head[at] = static_cast<char>(random.uniform(0.0, 256.0));
            else
                head.insert(at, 1, " \r\n:/\t"[static_cast<std::size_t>(random.uniform(0.0, 6.0))]);
        }
        CAPTURE(i);
        const auto checked = check_head(head);
        if (checked.refused != 0) continue;
        CHECK(checked.text.substr(checked.text.size() - 4) == "\r\n\r\n");
        CHECK(checked.text.find("\r\n\r\n") == checked.text.size() - 4);
        CHECK(checked.text.find('\0') == std::string::npos);
    }
}

TEST_CASE("serve head: every refusal says why") {
    for (const int status : {400, 411, 414, 415, 431}) {
        CAPTURE(status);
        CHECK(std::string(why_refused(status)).size() > 10);
        CHECK((status == 400 || std::string(why_refused(status)) != why_refused(400)));
    }
}
