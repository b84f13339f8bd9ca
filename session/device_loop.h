#pragma once
// A device loop while it runs: it has a rate and a thread of its own, and works on the rows of device_rows.h.
//
// Two things pass between the threads, each from one writer to one reader: the pen's latest contact goes in
// (LatestValue), and rows come out to be written to a file (RowRing). In each period the loop's thread reads the
// device, runs the row and sends the command; it allocates nothing and touches no file.
//
// A port P talks to a device D, or to its simulator:
//   bool read(D::Feedback&) noexcept;         returns false if nothing came; may not block for longer than a period
//   void send(const D::Command&) noexcept;

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "platform/real_time.h"
#include "session/device_rows.h"
#include "session/latest_value.h"

namespace palpa::session {

// Rows on their way from the loop to the file. A full ring refuses the row, so that neither thread waits.
class RowRing {
  public:
    explicit RowRing(std::size_t rows) : row_(rows) {}

    // Called by the loop's thread. Returns false if the ring is full.
    bool put(const DeviceRow& row) noexcept {
        const std::size_t n = written_.load(std::memory_order_relaxed);
        if (n - taken_.load(std::memory_order_acquire) == row_.size()) return false;
        row_[n % row_.size()] = row;
        written_.store(n + 1, std::memory_order_release);
        return true;
    }

    // Called by the thread that writes files. Returns false if the ring is empty.
    bool take(DeviceRow& out) noexcept {
        const std::size_t n = taken_.load(std::memory_order_relaxed);
        if (n == written_.load(std::memory_order_acquire)) return false;
        out = row_[n % row_.size()];
        taken_.store(n + 1, std::memory_order_release);
        return true;
    }

  private:
    std::vector<DeviceRow> row_;
    std::atomic<std::size_t> written_{0};
    std::atomic<std::size_t> taken_{0};
};

// Health of a loop, for performance.json. All but rows and hand_overs depends on the wall clock or counts faults.
struct DeviceReport {
    std::int64_t rows = 0;              // feedback rows that were run
    std::int64_t hand_overs = 0;        // contacts that were run
    std::int64_t silent = 0;            // periods without feedback
    std::int64_t not_numbers = 0;       // feedback or contacts that are not finite; they are neither run nor recorded
    std::int64_t refused_commands = 0;  // commands that are not finite; they are not sent
    std::int64_t missed_periods = 0;    // left out because they could not be caught up on
    std::int64_t late_periods = 0;      // begun more than 1 ms late
    double latest_s = 0.0;              // greatest delay with which a period began
    bool real_time = false;             // the scheduler granted the thread its real-time priority
    // Rows that were run but not recorded because the ring was full. Once a row is lost no later one is recorded, so
    // that the recorded rows replay.
    std::int64_t lost_rows = 0;
};

template <Device D>
struct DeviceLoop {
    typename D::Plan plan;
    DeviceMemory<D> memory{};
    LatestValue<PenContact> pen{};
    RowRing recorded{8192};  // 8 s of feedback at 1 kHz, longer than a disk is expected to stall
    DeviceReport report{};   // belongs to the loop's thread while it runs
};

// Records one row and runs it. Returns whether `command` is to be sent, as run_row().
template <Device D>
bool take_row(const DeviceRow& row, DeviceLoop<D>& loop, typename D::Command& command) noexcept {
    if (loop.report.lost_rows > 0 || !loop.recorded.put(row)) ++loop.report.lost_rows;
    return run_row<D>(loop.plan, row, loop.memory, command);
}

// Runs one period: takes over the pen's latest contact, reads the device and sends the command. now_s: time on the
// host's clock. Allocates nothing.
template <Device D, class Port>
void run_period(double now_s, Port& port, DeviceLoop<D>& loop) noexcept {
    typename D::Command command{};
    PenContact pen;
    if (loop.pen.take(pen)) {
        if (all_finite(pen)) {
            take_row<D>(device_row(DeviceRowKind::hand_over, now_s, pen), loop, command);
            ++loop.report.hand_overs;
        } else {
            ++loop.report.not_numbers;
        }
    }
    typename D::Feedback feedback{};
    if (!port.read(feedback)) {
        ++loop.report.silent;
    } else if (!all_finite(feedback)) {
        ++loop.report.not_numbers;
    } else {
        ++loop.report.rows;
        if (take_row<D>(device_row(DeviceRowKind::feedback, now_s, feedback), loop, command))
            port.send(command);
        else
            ++loop.report.refused_commands;
    }
}

// Writes the rows recorded since the last call. The thread that owns the writer calls it before the ring is full.
inline void write_recorded(RowRing& recorded, DeviceRowWriter& writer) {
    for (DeviceRow row; recorded.take(row);) writer.write(row);
}

// Calls tick(now_s), with the time on the host's clock, at a rate until `stopping`. Periods that it is too late for are left
// out and counted. rate_Hz: at least 1 (assert).
template <class Tick>
void run_ticks(double rate_Hz, const std::atomic<bool>& stopping, DeviceReport& report, const Tick& tick) noexcept {
    assert(rate_Hz >= 1.0);
    using Clock = std::chrono::steady_clock;
    const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / rate_Hz));
    constexpr double kLate_s = 1e-3;
    auto due = Clock::now();
    while (!stopping) {
        const auto now = Clock::now();
        const auto missed = (now - due) / period;
        const double late_s = std::chrono::duration<double>(now - due).count();
        report.latest_s = std::max(report.latest_s, late_s);
        report.late_periods += late_s > kLate_s;
        report.missed_periods += missed;
        tick(std::chrono::duration<double>(now.time_since_epoch()).count());
        due += (missed + 1) * period;
        std::this_thread::sleep_until(due);
    }
}

// Runs a loop in a thread until stop() or the destructor. `port` and `loop` must outlive it; meanwhile other threads
// may only call `loop.pen.put` and `loop.recorded.take`. rate_Hz: at least 1 (assert).
template <Device D, class Port>
class DeviceThread {
  public:
    DeviceThread(double rate_Hz, Port& port, DeviceLoop<D>& loop)
        : thread_([this, rate_Hz, &port, &loop] { run(rate_Hz, port, loop); }) {}
    ~DeviceThread() { stop(); }
    DeviceThread(const DeviceThread&) = delete;
    DeviceThread& operator=(const DeviceThread&) = delete;

    void stop() {
        stopping_ = true;
        if (thread_.joinable()) thread_.join();
    }

  private:
    void run(double rate_Hz, Port& port, DeviceLoop<D>& loop) noexcept {
        loop.report.real_time = platform::set_real_time(true);
        run_ticks(rate_Hz, stopping_, loop.report, [&](double now_s) { run_period<D>(now_s, port, loop); });
    }

    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace palpa::session
