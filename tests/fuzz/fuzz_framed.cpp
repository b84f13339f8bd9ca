// The bytes of a board that speaks our frames, both ways. The CRC is set right in a copy, or nothing would get beyond it.

#include "devices/crc16.h"
#include "devices/framed.h"
#include "devices/simulators/framed_board.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

namespace {

void take_frames(std::span<const std::uint8_t> bytes) {
    FrameParser parser;
    simulators::FramedBoard board;
    for (const std::uint8_t byte : bytes) {
        Frame frame;
        if (!feed(byte, parser, frame)) continue;
        if (frame.values > kMostFramedValues) fuzz::finding("more values than a frame has");
        for (std::size_t i = 0; i < frame.values; ++i) {
            if (frame.value[i] < kLeastFramedCounts || frame.value[i] > kMostFramedCounts)
                fuzz::finding("counts out of range");
        }
    }
    simulators::take_bytes(bytes, board);
    if (board.outputs > kMostFramedValues) fuzz::finding("more outputs than a board has");
}

}  // namespace

PALPA_FUZZ_ENTRY(framed)(const std::uint8_t* data, std::size_t size) {
    take_frames({data, size});
    std::vector<std::uint8_t> frame{0xff};
    for (std::size_t i = 0; i < std::min<std::size_t>(size, kMostFrame_bytes - 4); ++i) frame.push_back(data[i] & 0x7f);
    const std::uint16_t crc = crc16(frame);
    for (const int shift : {14, 7, 0}) frame.push_back(static_cast<std::uint8_t>((crc >> shift) & 0x7f));
    take_frames(frame);
    return 0;
}
