#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "devices/force_sensor.h"
#include "devices/pin_line.h"
#include "devices/pins.h"
#include "platform/real_time.h"

namespace palpa::devices {
namespace {

constexpr double kUnsent_s = 0.1;
constexpr double kOpenAgain_s = 0.5;
constexpr int kErrorsInARow = 20;
constexpr int kMissingInARow = 3;        // and for
constexpr double kBoardSilent_s = 0.25;  // a servo needs as long for its stroke

void nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(std::max(seconds, 0.0))); }

}  // namespace

struct PinDriver::Works {
    explicit Works(const PinDevice& d) : device(d), line(std::make_unique<PinLine>(d)) {
        for (auto& wanted : wanted_m) wanted.store(device.rest_m);
        health.boards = device.boards.size();
    }

    PinDevice device;
    std::array<std::atomic<double>, kMostPins> wanted_m;
    std::atomic<double> sent_s{-1e9};  // when send() was called last
    std::atomic<PinState> state{PinState::proving};
    std::atomic<bool> ending{false};
    mutable std::mutex copy_guard;  // guards the copy below; locked once a frame
    PinHealth copy;

    // of the thread alone
    std::unique_ptr<PinLine> line;
    PinHealth health;
    std::array<int, kMostBoards> errors_in_a_row{};
    std::array<int, kMostBoards> missing_in_a_row{};
    std::array<double, kMostBoards> heard_s{};
    std::size_t asked = 0;  // the board that is asked in this frame
    double tried_s = 0.0;
    PinFrame frame;
    std::array<double, kMostPins> height_m{};
    std::thread thread;

    void run();
    void prove();
    void reopen();
    void drive_frame();
    void ask_next();
    void publish(PinState now);
};

void PinDriver::Works::publish(PinState now) {
    health.state = now;
    if (line) {
        health.unasked = line->parser.unasked;
        health.malformed = line->parser.malformed;
    }
    state.store(now);
    const std::lock_guard<std::mutex> guard(copy_guard);
    copy = health;
}

// Until it is proved, a line that was in trouble stays so: a fault lasts until the pins are driven again.
void PinDriver::Works::prove() {
    errors_in_a_row.fill(0);
    missing_in_a_row.fill(0);
    const std::span<BoardHealth> boards(health.board.data(), health.boards);
    prove_boards(device, *line, boards);
    PinState proved = state_of(device, *line, boards);
    if (proved == PinState::driving && !set_speeds(device, *line)) proved = PinState::gone;
    heard_s.fill(steady_s());
    publish(proved);
}

// Also for boards that were not safe: a garbled reply may have been the reason, or a person has set them right.
void PinDriver::Works::reopen() {
    line.reset();
    if (steady_s() - tried_s < kOpenAgain_s) return nap(device.frame_s);
    tried_s = steady_s();
    const bool was_gone = state.load() == PinState::gone;
    try {
        line = std::make_unique<PinLine>(device);
        health.reconnects += was_gone;
    } catch (const std::exception&) {
        return;  // still gone
    }
    prove();
}

void PinDriver::Works::ask_next() {
    BoardHealth& board = health.board[asked];
    std::uint16_t errors = 0;
    if (!ask_errors(device.boards[asked].address, 0.5 * device.frame_s, *line, errors)) {
        ++board.missing;
        ++missing_in_a_row[asked];
    } else {
        missing_in_a_row[asked] = 0;
        heard_s[asked] = steady_s();
        board.errors = static_cast<std::uint16_t>(board.errors | errors);
        board.error_replies += errors != 0;
        errors_in_a_row[asked] = errors != 0 ? errors_in_a_row[asked] + 1 : 0;
    }
    const bool silent = missing_in_a_row[asked] >= kMissingInARow && steady_s() - heard_s[asked] > kBoardSilent_s;
    const bool faulty = errors_in_a_row[asked] >= kErrorsInARow;
    asked = (asked + 1) % health.boards;
    publish(line->gone ? PinState::gone : silent ? PinState::no_answer : faulty ? PinState::faulty : PinState::driving);
}

void PinDriver::Works::drive_frame() {
    health.resting = steady_s() - sent_s.load() > kUnsent_s;
    for (std::size_t i = 0; i < device.pins.size(); ++i)
        height_m[i] = health.resting ? device.rest_m : wanted_m[i].load(std::memory_order_relaxed);
    pin_frame(device, std::span(height_m.data(), device.pins.size()), frame);
    if (!write_line(frame.view(), *line)) return publish(PinState::gone);
    ++health.frames;
    ask_next();
}

void PinDriver::Works::run() {
    // where it is granted; else a busy computer may let the boards' timeouts fire
    platform::set_real_time(true, platform::kGuardPriority);
    prove();
    const double period_s = write_period_s(device);
    for (double due_s = steady_s(); !ending.load();) {
        const PinState now = state.load();
        if (now == PinState::driving) {
            drive_frame();
        } else {
            reopen();
        }
        due_s += period_s;
        const double late_s = steady_s() - due_s;
        if (late_s > 0.5 * device.frame_s) {
            health.late_frames += now == PinState::driving;
            due_s += late_s;
        }
        nap(due_s - steady_s());
    }
    if (!line || state.load() != PinState::driving) return;
    height_m.fill(device.rest_m);
    pin_frame(device, std::span(height_m.data(), device.pins.size()), frame);
    write_line(frame.view(), *line);
}

PinDriver::PinDriver(const PinDevice& device) : works_(std::make_unique<Works>(device)) {
    works_->thread = std::thread([works = works_.get()] { works->run(); });
}

PinDriver::~PinDriver() {
    works_->ending.store(true);
    works_->thread.join();
}

void PinDriver::send(std::span<const double> heights_m) noexcept {
    const std::size_t count = std::min(heights_m.size(), kMostPins);
    for (std::size_t i = 0; i < count; ++i) works_->wanted_m[i].store(heights_m[i], std::memory_order_relaxed);
    works_->sent_s.store(steady_s());
}

PinState PinDriver::state() const noexcept { return works_->state.load(); }

PinHealth PinDriver::health() const {
    const std::lock_guard<std::mutex> guard(works_->copy_guard);
    return works_->copy;
}

const PinDevice& PinDriver::device() const { return works_->device; }

}  // namespace palpa::devices
