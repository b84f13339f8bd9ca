#pragma once
// The log of a loop: what it computed and wanted, step by step. It depends on the rows of input alone, so that the same
// rows give the same bytes; what devices report by the wall clock stands elsewhere.
//
//   steps.tsv  a row per step: time_s x_mm y_mm depth_mm force_N pressed held over_edge inexact linearity shape_scale
//              clipped
//   pins.tsv   a row every 20 steps, with a shape display: time_s, then of each pin wanted, commanded and estimated height
//              (wanted_mm_1 ..., commanded_mm_1 ..., estimated_mm_1 ...)
//   pressures.tsv  with a pressure display instead: time_s, then the pressure at each of its points (pressure_Pa_1 ...),
//              solved here and not in the loop

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "files/append_file.h"
#include "tactile/loop.h"

namespace palpa::tactile {

// Writes into a folder that exists; the plan must outlive it. The constructor throws std::runtime_error if a file exists or cannot be created. Not for
// the loop's own thread.
class StepLog {
  public:
    StepLog(const std::filesystem::path& folder, const TactilePlan& plan);
    void write(const LoopCommand& step);
    bool sync();  // false once anything could not be written

  private:
    void write_pins(const LoopCommand& step);
    void write_pressures(const LoopCommand& step);

    const TactilePlan& plan_;
    files::AppendFile steps_;
    std::optional<files::AppendFile> pins_;
    std::optional<files::AppendFile> pressures_;
    RendererWork work_;  // of the pressures
    Eigen::VectorXd pressure_Pa_;
    std::string text_;
    std::int64_t written_ = 0;
};

}  // namespace palpa::tactile
