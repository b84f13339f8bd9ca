// Our frames and the simulated board that takes them.

#include <doctest/doctest.h>
#include <random>

#include "devices/framed.h"
#include "devices/simulators/framed_board.h"
#include "tests/devices/wires.h"

using namespace palpa::devices;
using namespace palpa::devices::simulators;
using namespace palpa::test;

namespace {

Frame setting(std::initializer_list<std::int32_t> values) {
    Frame frame;
    frame.kind = FrameKind::set;
    frame.sequence = 5;
    for (const std::int32_t value : values) frame.value[frame.values++] = value;
    return frame;
}

std::vector<Frame> frames_of(std::span<const std::uint8_t> bytes, FrameParser& parser) {
    std::vector<Frame> out;
    Frame frame;
    for (const std::uint8_t byte : bytes) {
        if (feed(byte, parser, frame)) out.push_back(frame);
    }
    return out;
}

}  // namespace

TEST_CASE("framed: a frame comes back as it was, to the ends of its values; FF stands at its beginning alone") {
    const Frame frame = setting({0, 1, -1, kMostFramedCounts, kLeastFramedCounts, 123456});
    const FrameBytes bytes = encode_frame(frame);
    CHECK(bytes.bytes[0] == 0xff);
    for (std::size_t i = 1; i < bytes.size; ++i) CHECK(bytes.bytes[i] < 0x80);
    FrameParser parser;
    const auto back = frames_of(bytes.view(), parser);
    REQUIRE(back.size() == 1);
    CHECK(back[0].kind == FrameKind::set);
    CHECK(back[0].sequence == 5);
    CHECK(back[0].values == 6);
    CHECK(back[0].value == frame.value);
    // worked out by hand from the description: counts 0 are 1,048,576 = 40 00 00 in sevens
    CHECK(hex_of(encode_frame(setting({0})).view().first(8)) == "FF 01 05 00 01 40 00 00");
    FrameParser other;
    CHECK(frames_of(encode_frame(setting({1 << 30})).view(), other)[0].value[0] == kMostFramedCounts);
}

TEST_CASE("framed: every split of a valid stream decodes alike, with garbage before and a frame cut off") {
    std::vector<std::uint8_t> stream{0x13, 0x80, 0x01};
    add_bytes(encode_frame(setting({7, 8})).view(), stream);
    add_bytes(encode_frame(setting({9})).view().first(6), stream);
    add_bytes(encode_frame(setting({10})).view(), stream);
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        CAPTURE(cut);
        FrameParser parser;
        auto found = frames_of(std::span(stream).first(cut), parser);
        const auto rest = frames_of(std::span(stream).subspan(cut), parser);
        found.insert(found.end(), rest.begin(), rest.end());
        REQUIRE(found.size() == 2);
        CHECK(found[0].value[1] == 8);
        CHECK(found[1].value[0] == 10);
        CHECK(parser.malformed == 1);
    }
}

TEST_CASE("framed: a frame with any one bit changed is refused") {
    const FrameBytes bytes = encode_frame(setting({-42, 4711}));
    for (std::size_t at = 0; at < bytes.size; ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            CAPTURE(at);
            CAPTURE(bit);
            FrameBytes changed = bytes;
            changed.bytes[at] = static_cast<std::uint8_t>(changed.bytes[at] ^ (1 << bit));
            FrameParser parser;
            CHECK(frames_of(changed.view(), parser).empty());
        }
    }
}

TEST_CASE("framed: a million random bytes give no value out of range, and the board still obeys afterwards") {
    constexpr unsigned kSeed = 22;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    FramedBoard board;
    bool in_range = true;
    for (int i = 0; i < 1'000'000; ++i) {
        auto byte = static_cast<std::uint8_t>(random());
        if (i % 12 == 0) byte = 0xff;
        if (i % 12 == 1) byte = 1;
        take_bytes(std::span(&byte, 1), board);
        board.out.clear();
        for (std::size_t k = 0; k < board.outputs; ++k)
            in_range = in_range && board.output[k] >= kLeastFramedCounts && board.output[k] <= kMostFramedCounts;
    }
    CHECK(in_range);
    take_bytes(encode_frame(setting({77})).view(), board);
    CHECK(board.output[0] == 77);
}

TEST_CASE("framed: a board rests after 100 ms of silence, and drives again only after a relax") {
    FramedBoard board;
    take_bytes(encode_frame(setting({77})).view(), board);
    CHECK(board.state == BoardState::drives);
    for (int i = 0; i < 99; ++i) advance(1e-3, board);
    CHECK(board.state == BoardState::drives);
    for (int i = 0; i < 3; ++i) advance(1e-3, board);
    CHECK(board.state == BoardState::timed_out);
    take_bytes(encode_frame(setting({88})).view(), board);
    CHECK(board.state == BoardState::timed_out);
    CHECK(board.output[0] == 77);
    Frame relax;
    relax.kind = FrameKind::relax;
    take_bytes(encode_frame(relax).view(), board);
    take_bytes(encode_frame(setting({88})).view(), board);
    CHECK(board.state == BoardState::drives);
    CHECK(board.output[0] == 88);
}

TEST_CASE("framed: sketch frames hold no header but the first, whatever is wanted") {
    const std::vector<std::int32_t> counts{0, 254, 255, 1000, -3};
    CHECK(hex_of(encode_sketch_frame(counts).view()) == "FF 00 FE FE FE 00");
}
