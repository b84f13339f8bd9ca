#pragma once
// The input rows of a device loop (a force arm, a pin display, a soft device), and the one function that turns them
// into commands.
//
// A device D has plain structs and one function:
//
//   D::Plan                                        made once, constant while the loop runs
//   D::Feedback, D::Command                        doubles; visit_fields(row, visit) calls visit(name, field) for each
//   D::State                                       what a row changes
//   static D::Command command(const D::Plan&, const DeviceInput<D::Feedback>&, D::State&) noexcept;
//
// command() allocates nothing and reads neither a clock nor anything else: its result depends only on the plan and on
// the rows so far. Live and replayed rows both go through run_row(), so that the same rows give the same commands, to
// the last bit on one machine and build.

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

// The pen's latest contact as it is handed over to a device loop. It may be old: compare time_s with the loop's time.
struct PenContact {
    double time_s = 0.0;  // of the contact's sample, on the timeline of the trace
    double x_m = 0.0;     // place on the tissue
    double y_m = 0.0;
    double depth_m = 0.0;
    double normal_N = 0.0;
    double tangential_N = 0.0;  // resists motion along the pen's direction
    double down = 0.0;          // 1 while the pen presses, else 0
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
    PenContact pen;  // the last contact that was handed over; all zeros before the first
};

template <class D>
concept Device = std::is_trivially_copyable_v<typename D::Feedback> &&
    std::is_trivially_copyable_v<typename D::Command> &&
    requires(const typename D::Plan& plan, const DeviceInput<typename D::Feedback>& in, typename D::State& s) {
    { D::command(plan, in, s) }
    noexcept->std::same_as<typename D::Command>;
};

enum class DeviceRowKind : std::uint8_t { feedback, hand_over };

inline constexpr std::size_t kDeviceFields = 64;  // at most

// One row of input. `value` holds the fields of the feedback or, in a hand-over, those of the contact.
struct DeviceRow {
    DeviceRowKind kind = DeviceRowKind::feedback;
    double time_s = 0.0;  // when the loop took the row, on the host's clock
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

// All that a row changes, and so all that a replay must reproduce.
template <Device D>
struct DeviceMemory {
    typename D::State state{};
    DeviceInput<typename D::Feedback> in{};
};

// Runs one row. Returns whether `command` is to be sent: a hand-over gives no command, and one that is not finite must
// not be sent.
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

// Runs recorded rows and calls take(command, time_s) for every command that is to be sent.
template <Device D, class Take>
void replay_device(const typename D::Plan& plan, const std::vector<DeviceRow>& rows, DeviceMemory<D>& memory,
                   Take&& take) {
    typename D::Command command{};
    for (const DeviceRow& row : rows) {
        if (run_row<D>(plan, row, memory, command)) take(command, row.time_s);
    }
}

// Returns the file of a device's rows beside a trace: for NAME.tsv and "arm", NAME.arm.tsv.
std::filesystem::path device_rows_of(const std::filesystem::path& trace, std::string_view device);

// Writes rows to a table. Its columns are `row`, `time_s`, the contact's fields and the feedback's fields; the fields
// that a row's kind does not have are n/a. The constructor throws std::runtime_error if the file exists or cannot be
// created, and std::invalid_argument for more than kDeviceFields fields. Not for the loop's own thread, since a full
// buffer waits for the disk.
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

// Reads what DeviceRowWriter wrote. Throws InputError with file, line and column for unknown, missing or exchanged
// columns, for a value that is not a finite number, and for a time before that of the row above.
std::vector<DeviceRow> read_device_rows(const std::filesystem::path& tsv,
                                        const std::vector<std::string>& feedback_fields);

}  // namespace palpa::session
