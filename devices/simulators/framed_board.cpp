#include "devices/simulators/framed_board.h"

namespace palpa::devices::simulators {
namespace {

void obey_frame(const Frame& frame, FramedBoard& board) {
    if (frame.kind == FrameKind::is) return;
    const bool timed_out = board.state == BoardState::timed_out;
    board.heard_s = board.time_s;
    if (frame.kind == FrameKind::relax) board.state = BoardState::relaxed;
    if (frame.kind == FrameKind::set && !timed_out) {
        board.state = BoardState::drives;
        board.output = frame.value;
        board.outputs = frame.values;
    }
    Frame is;
    is.kind = FrameKind::is;
    is.sequence = frame.sequence;
    is.state = board.state;
    is.value = board.output;
    is.values = board.outputs;
    const FrameBytes bytes = encode_frame(is);
    board.out.insert(board.out.end(), bytes.view().begin(), bytes.view().end());
}

}  // namespace

void take_bytes(std::span<const std::uint8_t> bytes, FramedBoard& board) {
    for (const std::uint8_t byte : bytes) {
        Frame frame;
        if (feed(byte, board.parser, frame)) obey_frame(frame, board);
    }
}

void advance(double dt_s, FramedBoard& board) {
    board.time_s += dt_s;
    const bool silent = board.timeout_s > 0.0 && board.time_s - board.heard_s > board.timeout_s;
    if (board.state != BoardState::drives || !silent) return;
    board.state = BoardState::timed_out;
    ++board.timeouts;
}

}  // namespace palpa::devices::simulators
