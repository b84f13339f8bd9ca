#pragma once
// What goes into a device loop (an arm, pins, a soft device), row by row, and the one path that turns it into commands.
//
// A device D brings plain structs and one function:
//
//   D::Plan                                        made once, constant while the loop runs
//   D::Feedback, D::Command                        doubles; visit_fields(row, visit) calls visit(name, field) for each
//   D::State                                       what a row changes
//   static D::Command command(const D::Plan&, const DeviceInput<D::Feedback>&, D::State&) noexcept;
//
// It allocates nothing, reads no clock and asks nobody: its commands are a function of the plan and of the rows. Live
// and replay both go through run_row(), so the same rows give the same commands, to the last bit on one machine and
// build.

#include <array>
#include <cassert>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "files/append_file.h"

namespace palpa::session {

// The pen's latest contact, as it is handed over to a device loop. Read it together with the loop's time: it may be old.
struct PenContact {
    double time_s = 0.0;  // of its sample, on the timeline of the trace
    double x_m = 0.0;     // on the tissue
    double y_m = 0.0;
    double depth_m = 0.0;
    double normal_N = 0.0;
    double tangential_N = 0.0;  // resisting motion along the pen's direction
    double down = 0.0;          // 1: the pen presses, 0: it does not
};

template <class Contact, class Visit>
requires std::same_as<std::remove_const_t<Contact>, PenContact>
void visit_fields(Contact& contact, Visit&& visit) {
    visit("pen_time_s", contact.time_s);
    visit("pen_x_m", contact.x_m);
    visit("pen_y_m", contact.y_m);
    visit("pen_depth_m", contact.depth_m);
    visit("pen_normal_N", contact.normal_N);
    visit("pen_tangential_N", contact.tangential_N);
    visit("pen_down", contact.down);
}

template <class Feedback>
struct DeviceInput {
    double time_s = 0.0;  // of the feedback, on the host's clock
    Feedback feedback{};
    PenContact pen;  // the last that was handed over; of time 0 until the first
};

template <class D>
concept Device = std::is_trivially_copyable_v<typename D::Feedback> &&
    std::is_trivially_copyable_v<typename D::Command> &&
    requires(const typename D::Plan& plan, const DeviceInput<typename D::Feedback>& in, typename D::State& s) {
    { D::command(plan, in, s) }
    noexcept->std::same_as<typename D::Command>;
};

enum class DeviceRowKind : std::uint8_t { feedback, hand_over };

// One row in. `value` holds the fields of the feedback, or those of the contact.
inline constexpr std::size_t kDeviceFields = 64;
struct DeviceRow {
    DeviceRowKind kind = DeviceRowKind::feedback;
    double time_s = 0.0;  // when the loop took it, on the host's clock
    std::array<double, kDeviceFields> value{};
};

template <class Fields>
DeviceRow device_row(DeviceRowKind kind, double time_s, const Fields& fields) noexcept {
    DeviceRow row{kind, time_s, {}};
    std::size_t i = 0;
    visit_fields(fields, [&](const char*, const double& field) {
        assert(i < kDeviceFields);
        row.value[i++] = field;
    });
    return row;
}

template <class Fields>
void read_device_row(const DeviceRow& row, Fields& fields) noexcept {
    std::size_t i = 0;
    visit_fields(fields, [&](const char*, double& field) { field = row.value[i++]; });
}

template <class Fields>
bool all_finite(const Fields& fields) noexcept {
    bool finite = true;
    visit_fields(fields, [&](const char*, const double& field) { finite = finite && std::isfinite(field); });
    return finite;
}

template <class Fields>
std::vector<std::string> field_names() {
    std::vector<std::string> names;
    const Fields any{};
    visit_fields(any, [&](const char* name, const double&) { names.emplace_back(name); });
    return names;
}

// All that a row changes.
template <Device D>
struct DeviceMemory {
    typename D::State state{};
    DeviceInput<typename D::Feedback> in{};
};

// Runs one row. True if it gives a command: a hand-over gives none, and one that is not finite is not to be sent.
template <Device D>
bool run_row(const typename D::Plan& plan, const DeviceRow& row, DeviceMemory<D>& memory,
             typename D::Command& command) noexcept {
    if (row.kind == DeviceRowKind::hand_over) {
        read_device_row(row, memory.in.pen);
        return false;
    }
    memory.in.time_s = row.time_s;
    read_device_row(row, memory.in.feedback);
    command = D::command(plan, memory.in, memory.state);
    return all_finite(command);
}

// Calls take(command, time_s) for every command that the rows give.
template <Device D, class Take>
void replay_device(const typename D::Plan& plan, const std::vector<DeviceRow>& rows, DeviceMemory<D>& memory,
                   Take&& take) {
    typename D::Command command{};
    for (const DeviceRow& row : rows) {
        if (run_row<D>(plan, row, memory, command)) take(command, row.time_s);
    }
}

// The rows of a device beside the trace: NAME.tsv and "arm" give NAME.arm.tsv.
std::filesystem::path device_rows_of(const std::filesystem::path& trace, std::string_view device);

// Writes them: first `row` and `time_s`, then the contact's columns, then the feedback's; those of the other kind are
// n/a. Nothing is overwritten (std::runtime_error). Not for the loop's own thread: a full buffer waits for the disk.
class DeviceRowWriter {
  public:
    DeviceRowWriter(const std::filesystem::path& tsv, const std::vector<std::string>& feedback_fields);
    void write(const DeviceRow& row);
    bool sync() { return file_.sync(); }
    bool failed() const { return file_.failed(); }

  private:
    files::AppendFile file_;
    std::size_t contact_fields_;
    std::size_t feedback_fields_;
    std::string text_;
};

// Throws InputError with file, line and column: unknown or missing columns, a number that is none, a time that goes
// back.
std::vector<DeviceRow> read_device_rows(const std::filesystem::path& tsv,
                                        const std::vector<std::string>& feedback_fields);

}  // namespace palpa::session
