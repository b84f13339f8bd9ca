// Commands and data frames of pressure controllers, and the simulated ones.

#include <doctest/doctest.h>
#include <random>

#include "devices/alicat.h"
#include "devices/simulators/alicat_units.h"
#include "tests/close_to.h"
#include "tests/devices/wires.h"

using namespace palpa::devices;
using namespace palpa::devices::simulators;
using namespace palpa::test;

namespace {

std::span<const std::uint8_t> bytes_in(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::vector<AlicatFrame> frames_in(std::string_view text, AlicatParser& parser) {
    std::vector<AlicatFrame> out;
    AlicatFrame frame;
    for (const std::uint8_t byte : bytes_in(text)) {
        if (feed(byte, parser, frame)) out.push_back(frame);
    }
    return out;
}

std::string answered(const AlicatCommand& command, AlicatUnits& units) {
    take_bytes(bytes_in(command.view()), units);
    for (int i = 0; i < 10; ++i) advance(1e-3, units);
    std::string text(units.out.begin(), units.out.end());
    units.out.clear();
    return text;
}

}  // namespace

TEST_CASE("alicat: commands are as the manuals print them, in both forms, in any locale") {
    CHECK(encode_alicat_set_point('A', 5.44, false).view() == "AS5.440\r");
    CHECK(encode_alicat_set_point('A', 5.44, true).view() == "AS 5.440\r");
    CHECK(encode_alicat_set_point('C', -0.0, false).view() == "CS0.000\r");
    CHECK(encode_alicat_set_point('Z', -99999.0, true).view() == "ZS -99999.000\r");
    CHECK(encode_alicat_poll('B').view() == "B\r");
    CHECK(encode_alicat_hold_closed('A').view() == "AHC\r");
    CHECK(encode_alicat_cancel_hold('A').view() == "AC\r");
}

TEST_CASE("alicat: data frames, numbers first and words behind them; what is none is counted") {
    AlicatParser parser;
    const auto frames = frames_in("A +014.70 +015.00\r\nB -0.5 +25.1 +03.00 +03.00 Air HLD\r", parser);
    REQUIRE(frames.size() == 2);
    CHECK(frames[0].values == 2);
    CHECK(frames[0].value[1] == 15.0);
    CHECK_FALSE(frames[0].held);
    CHECK(frames[1].unit == 'B');
    CHECK(frames[1].value[0] == -0.5);
    CHECK(frames[1].values == 4);
    CHECK(frames[1].held);
    CHECK(parser.malformed == 0);
    for (const char* bad : {"?", "A", "a +1", "AB +1", "1 +2", "A nan", "A inf 1", "A 1e400", "A 1e3", "A ++1",
                            "A +1,5", "A 100000.5", "A +1 \x01", "A 1 2 3 4 5 6 7 8 9 10 11 12 13"}) {
        CAPTURE(bad);
        AlicatParser fresh;
        CHECK(frames_in(std::string(bad) + "\r", fresh).empty());
        CHECK(fresh.malformed == 1);
    }
    AlicatParser flooded;
    CHECK(frames_in(std::string(100'000, '7') + "\r", flooded).empty());
    CHECK(flooded.malformed == 1);
    CHECK(frames_in("A +1.0 +2.0\r", flooded).size() == 1);
}

TEST_CASE("alicat: every split of a valid stream decodes alike") {
    const std::string stream = "0 +17.2\rA +014.70 +015.00\rB +1.00 +2.00 HLD\r";
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        CAPTURE(cut);
        AlicatParser parser;
        auto found = frames_in(stream.substr(0, cut), parser);
        const auto rest = frames_in(stream.substr(cut), parser);
        found.insert(found.end(), rest.begin(), rest.end());
        REQUIRE(found.size() == 2);
        CHECK(found[0].value[0] == 14.7);
        CHECK(found[1].held);
        CHECK(parser.malformed == 1);
    }
}

TEST_CASE("alicat: the simulated unit echoes what it took, keeps it, and refuses what it cannot do") {
    AlicatUnits units;
    units.unit = {{'A', 50.0, 0.0, 0.0, false}, {'B', 50.0, 0.0, 0.0, false}};
    CHECK(answered(encode_alicat_set_point('A', 5.444, false), units).find("+005.44") != std::string::npos);
    CHECK(answered(encode_alicat_set_point('A', 51.0, true), units).find("+005.44") != std::string::npos);
    CHECK(units.unit[1].set_point == 0.0);
    for (int i = 0; i < 3000; ++i) advance(1e-3, units);  // in silence
    CHECK(units.unit[0].set_point == 5.44);
    CHECK(units.unit[0].pressure == close_to(5.44));
    CHECK(answered(encode_alicat_poll('C'), units).empty());
    take_bytes(bytes_in("A\r"), units);
    take_bytes(bytes_in("B\r"), units);  // before the answer
    CHECK(units.spoiled == 1);
}

TEST_CASE("alicat: a million random bytes give no value out of range and no set point beyond full scale") {
    constexpr unsigned kSeed = 21;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    AlicatUnits units;
    units.unit = {{'A', 50.0, 0.0, 0.0, false}};
    AlicatParser parser;
    AlicatFrame frame;
    const std::string letters = "AS +-.0123456789\rHC";
    std::int64_t frames = 0;
    bool in_range = true;
    for (int i = 0; i < 1'000'000; ++i) {
        const auto byte = i % 3 == 0 ? static_cast<std::uint8_t>(random())
                                     : static_cast<std::uint8_t>(letters[random() % letters.size()]);
        take_bytes(std::span(&byte, 1), units);
        if (i % 8 == 0) advance(1e-3, units);
        units.out.clear();
        if (feed(byte, parser, frame)) {
            ++frames;
            for (std::size_t k = 0; k < frame.values; ++k)
                in_range = in_range && std::abs(frame.value[k]) <= kMostAlicatValue;
        }
        in_range = in_range && units.unit[0].set_point >= 0.0 && units.unit[0].set_point <= 50.0;
    }
    CHECK(in_range);
    CHECK(frames > 0);
}
