#pragma once
// The log of a run: one row per sample, in the BIDS layout
//     DIR/sub-01/beh/sub-01_task-palpation_run-01_samples.tsv   (and .json, which explains the columns)
// Rows are only appended; a run never overwrites another, but takes the next number.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "files/append_file.h"

namespace palpa::study {

struct SampleRow {
    static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();  // written as n/a
    double t_host_s = 0.0;
    double t_device_s = kMissing;
    std::int64_t trial = 1;
    std::int64_t pointer_id = 0;
    std::string_view tool = "n/a";
    std::string_view phase = "n/a";
    double x_mm = kMissing;
    double y_mm = kMissing;
    double pressure = kMissing;
    double force_N = kMissing;
    double depth_mm = kMissing;
    double tangential_N = kMissing;
    double avatar_x_mm = kMissing;
    double avatar_y_mm = kMissing;
    double lag_mm = kMissing;
    double delay_ms = kMissing;
    double texture_mm = kMissing;
    std::int64_t saturated = 0;
    std::string_view ft_source = "n/a";
    double footprint_mm = kMissing;
    double crease = kMissing;
    double drawn_depth_mm = kMissing;
};

// The files of one run. next_run() takes the first free number from `first` on and creates the folders. Throws
// InputError if `participant` is not made of ASCII letters and digits, std::runtime_error if a folder cannot be
// created.
struct RunFiles {
    std::filesystem::path folder;
    std::string stem;  // sub-01_task-palpation_run-01
    std::filesystem::path file(std::string_view suffix) const { return folder / (stem + std::string(suffix)); }
};
RunFiles next_run(const std::filesystem::path& directory, std::string_view participant,
                  std::string_view task = "palpation", int first = 1);

// Writes .bidsignore and dataset_description.json where they do not exist yet.
void prepare_dataset(const std::filesystem::path& directory);

// Writes the explanation of the columns of samples, once for a whole dataset.
void explain_samples_once(const std::filesystem::path& json);

class SampleLog {
  public:
    explicit SampleLog(const RunFiles& files, bool sidecar = true);
    void write(const SampleRow& row);  // allocates nothing after the first row
    bool flush() { return file_.flush(); }
    bool sync() { return file_.sync(); }
    bool failed() const { return file_.failed(); }

  private:
    files::AppendFile file_;
    std::string row_;
};

}  // namespace palpa::study
