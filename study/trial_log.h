#pragma once
// What a person did in a trial, beside the samples of study/sample_log.h:
//     ..._events.tsv   start, each mark, each confidence, each undo, finish or interrupted; written as it happens
//     ..._marks.tsv    the marks that stood at the end, with what they found; also of a trial that was broken off
// A JSON file explains the columns of each table. Rows are only appended. LogOptions say when they are on the disk.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "files/append_file.h"
#include "files/json.h"
#include "study/sample_log.h"

namespace palpa::study {

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
    double path_mm = kMissing;  // this and the two forces: on the row finish, over the time that the pen presses
    double mean_force_N = kMissing;
    double max_force_N = kMissing;
    double x_mm = kMissing;  // of a mark, so that the log of a trial that is broken off has its places too
    double y_mm = kMissing;
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

// The labels of a trial of a study, as its protocol plans it.
struct TrialLabel {
    std::string condition;
    std::string device;
    int trial = 1;
    int order_id = 0;
    files::Json study;  // for the settings: protocol, version, hash, participant, whether simulated
    bool practice = false;
};

// One choice between two stimuli: one row of ..._task-softer_..._events.tsv.
struct ChoiceRow {
    static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
    double onset_s = 0.0;  // since the run began
    double duration_s = kMissing;
    std::string_view trial_type = "choice";
    std::string_view block = "test";
    std::int64_t trial = 1;
    std::int64_t order_id = 0;
    std::string_view condition = "n/a";
    std::string_view device_id = "n/a";
    std::int64_t seed = 0;
    double reference_kPa = 0.0;
    double comparison_kPa = 0.0;
    std::string_view reference_on = "n/a";  // condition of the reference; n/a: that of the row
    std::string_view first = "reference";   // reference or comparison
    std::string_view answer = "reference";  // the one that was called softer: reference or comparison
    std::int64_t correct = 0;
};

struct LogOptions {
    bool sync_rows = true;  // each row is on the disk when write() returns; false: when sync() returns
    bool sidecars = true;   // a JSON file beside each table; false: one at the top of the dataset explains all
};

class TrialLog {
  public:
    explicit TrialLog(const RunFiles& files, const LogOptions& options = {});
    // Append a row. They return false once anything could not be written.
    bool write(const EventRow& row);
    bool write(const MarkRow& row);
    bool sync_marks() { return marks_.sync(); }
    bool sync_events() { return events_.sync(); }
    bool failed() const { return events_.failed() || marks_.failed(); }

  private:
    files::AppendFile events_;
    files::AppendFile marks_;
    std::string line_;
    bool sync_rows_;
};

// The choices of one participant; each is on the disk when write() returns.
class ChoiceLog {
  public:
    explicit ChoiceLog(const RunFiles& files);
    bool write(const ChoiceRow& row);

  private:
    files::AppendFile file_;
    std::string line_;
};

// Writes the files that every folder of logs has, and the explanations of all its tables (in BIDS, a JSON file higher
// up is inherited). Existing files are left as they are.
void prepare_log_folder(const std::filesystem::path& directory);

}  // namespace palpa::study
