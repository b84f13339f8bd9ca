#pragma once
// The log of a loop, tick by tick. It depends on the rows of input and on the plant alone, so that the same rows give the
// same bytes. Its columns are also those of recorded presses (fit.h):
//
//   time_s depth_mm wanted_N force_N world_depth_mm NAME_N or NAME_Pa ... NAME_mm or NAME_mm3 ... residual_mm saturated held
//   relaxed by_length
//
// of each actuator first what its drive is told by force, then the length of its cable or the volume of its cavity.
// force_N: what the finger felt, n/a where nobody knows. by_length: 1 where cables were told the lengths, not the tensions.

#include <filesystem>
#include <string>

#include "files/append_file.h"
#include "tangible/loop.h"

namespace palpa::tangible {

std::string tick_columns(const DeviceModel& model);
// rendered_N: NaN where nobody knows. Appends to `text`.
void append_tick(const DeviceModel& model, CommandKind command, const TangibleCommand& tick, double depth_m,
                 double wanted_N, double rendered_N, std::string& text);

// Writes ticks.tsv into a folder that exists. The constructor throws std::runtime_error if the file exists or cannot be
// created. Not for the loop's own thread.
class TickLog {
  public:
    TickLog(const std::filesystem::path& folder, const DeviceModel& model, CommandKind command);
    void write(const TangibleCommand& tick, double rendered_N);
    bool sync() { return file_.sync(); }  // false once anything could not be written

  private:
    const DeviceModel& model_;
    CommandKind command_;
    files::AppendFile file_;
    std::string text_;
};

}  // namespace palpa::tangible
