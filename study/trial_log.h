#pragma once
// What a person did in a trial, beside the samples of study/sample_log.h:
//     ..._events.tsv   start, each mark, each judgement of how sure, each undo, finish; written as it happens
//     ..._marks.tsv    the marks that stood at the end, with what they found
// both with a JSON file that explains the columns. Rows are only appended, and each is on the disk before the
// next one begins.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "files/append_file.h"
#include "study/sample_log.h"

namespace palpa {

struct EventRow {
    static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
    double onset_s = 0.0;  // since the trial began
    double duration_s = kMissing;
    std::string_view trial_type = "n/a";
    std::string_view block = "n/a";
    std::int64_t trial = 1;
    double order_id = kMissing;
    std::string_view condition = "n/a";
    std::string_view device_id = "n/a";
    std::string_view calibration_id = "n/a";
    std::string_view map_id = "n/a";
    std::int64_t map_rotation_deg = 0;
    std::int64_t map_flip = 0;
    std::int64_t seed = 0;
    std::int64_t n_nodules = 0;
    double true_positives = kMissing;
    double false_positives = kMissing;
    double false_negatives = kMissing;
};

struct MarkRow {
    static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
    double onset_s = 0.0;
    std::int64_t trial = 1;
    std::int64_t mark = 1;
    double x_mm = 0.0;
    double y_mm = 0.0;
    double confidence = kMissing;  // 1 to 5
    std::string_view nodule = "n/a";
    double distance_mm = kMissing;
    std::int64_t hit = 0;
};

class TrialLog {
 public:
    explicit TrialLog(const RunFiles& files);
    // Return false once anything could not be written.
    bool write(const EventRow& row);
    bool write(const MarkRow& row);
    bool failed() const { return events_.failed() || marks_.failed(); }

 private:
    AppendFile events_;
    AppendFile marks_;
    std::string line_;
};

}  // namespace palpa
