#include "study/trial_log.h"

#include "study/ratings.h"
#include "study/rows.h"

namespace palpa::study {

template <class Visit>
void visit_fields(const EventRow& r, Visit&& visit) {
    visit("onset", r.onset_s, "s", "since the trial began");
    visit("duration", r.duration_s, "s", "of the trial, on the row finish");
    visit("trial_type", r.trial_type, "",
          "start, mark, confidence, undo, finish; hidden and shown: the app was out of sight in between; pause and "
          "resume: the person stopped the clock in between; device_gone: what the trial is done with was unplugged; "
          "no_pressure: its pen or finger turned out to measure none, or all touches had one contact area; no_level: "
          "its touches lacked the level that the profile reads; interrupted: it ended without finish");
    visit("block", r.block, "", "practice (nodules shown) or test (hidden)");
    visit("trial", r.trial, "", "number of the trial");
    visit("order_id", r.order_id, "", "row of the protocol's order");
    visit("condition", r.condition, "",
          "of the protocol; without one the law of the avatar: display_ratio, delay or none");
    visit("device_id", r.device_id, "",
          "device of the study's condition; without a study the pens, touch screens or mouse at the trial's "
          "beginning, n/a in a browser, which does not tell (tool in samples.tsv: what pressed)");
    visit("calibration_id", r.calibration_id, "", "profile of the pressure");
    visit("map_id", r.map_id, "", "tissue");
    visit("map_rotation_deg", r.map_rotation_deg, "deg", "how the tissue was turned, counter-clockwise");
    visit("map_flip", r.map_flip, "", "1: left and right exchanged before it was turned");
    visit("seed", r.seed, "", "of the scene");
    visit("n_nodules", r.n_nodules, "", "to be found");
    visit("tp", r.true_positives, "", "nodules found");
    visit("fp", r.false_positives, "", "marks on no nodule");
    visit("fn", r.false_negatives, "", "nodules missed");
    visit("path_mm", r.path_mm, "mm", "way of the pen while it presses, in steps of 0.5 mm or more");
    visit("mean_force_N", r.mean_force_N, "N", "over the time that it presses");
    visit("max_force_N", r.max_force_N, "N", "greatest force");
    visit("x_mm", r.x_mm, "mm", "of a mark, map's frame");
    visit("y_mm", r.y_mm, "mm", "of a mark, map's frame");
}

template <class Visit>
void visit_fields(const MarkRow& r, Visit&& visit) {
    visit("onset", r.onset_s, "s", "since the trial began");
    visit("trial", r.trial, "", "number of the trial");
    visit("mark", r.mark, "", "number of the mark");
    visit("x_mm", r.x_mm, "mm", "map's frame");
    visit("y_mm", r.y_mm, "mm", "map's frame");
    visit("confidence", r.confidence, "", "1 unsure to 5 sure");
    visit("nodule", r.nodule, "", "found, or found again; else the nearest");
    visit("distance_mm", r.distance_mm, "mm", "to that nodule's centre or axis");
    visit("hit", r.hit, "", "1: the mark that finds the nodule");
}

template <class Visit>
void visit_fields(const ChoiceRow& r, Visit&& visit) {
    visit("onset", r.onset_s, "s", "of the question, since the run began");
    visit("duration", r.duration_s, "s", "until the answer");
    visit("trial_type", r.trial_type, "", "choice");
    visit("block", r.block, "", "practice or test");
    visit("trial", r.trial, "", "number of the trial");
    visit("order_id", r.order_id, "", "row of the protocol's order");
    visit("condition", r.condition, "", "of the protocol");
    visit("device_id", r.device_id, "", "of the protocol");
    visit("seed", r.seed, "", "of the trial");
    visit("reference_kPa", r.reference_kPa, "kPa", "Young's modulus of the reference");
    visit("comparison_kPa", r.comparison_kPa, "kPa", "Young's modulus of the comparison");
    visit("reference_on", r.reference_on, "",
          "condition under which the reference was presented, with choice.reference_on; else n/a: that of the row");
    visit("first", r.first, "", "which came first: reference or comparison");
    visit("answer", r.answer, "", "which was called softer: reference or comparison");
    visit("correct", r.correct, "", "1: the softer one");
}

namespace {

template <class Row>
void begin(const std::filesystem::path& sidecar, const LogOptions& options, files::AppendFile& file) {
    if (options.sidecars) files::write_text_atomically(sidecar, explanation_of<Row>());
    file.append(header_of<Row>());
    if (options.sync_rows) file.sync();
}

template <class Row>
bool add(const Row& row, bool sync, std::string& line, files::AppendFile& file) {
    line_of(row, line);
    file.append(line);
    return sync ? file.sync() : !file.failed();
}

template <class Row>
void explain_once(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) files::write_text_atomically(file, explanation_of<Row>());
}

}  // namespace

TrialLog::TrialLog(const RunFiles& files, const LogOptions& options)
    : events_(files.file("_events.tsv")), marks_(files.file("_marks.tsv")), sync_rows_(options.sync_rows) {
    begin<EventRow>(files.file("_events.json"), options, events_);
    begin<MarkRow>(files.file("_marks.json"), options, marks_);
}

bool TrialLog::write(const EventRow& row) { return add(row, sync_rows_, line_, events_); }
bool TrialLog::write(const MarkRow& row) { return add(row, sync_rows_, line_, marks_); }

ChoiceLog::ChoiceLog(const RunFiles& files) : file_(files.file("_events.tsv")) {
    begin<ChoiceRow>("", {true, false}, file_);
}

bool ChoiceLog::write(const ChoiceRow& row) { return add(row, true, line_, file_); }

void prepare_log_folder(const std::filesystem::path& directory) {
    prepare_dataset(directory);
    explain_once<EventRow>(directory / "task-palpation_events.json");
    explain_once<MarkRow>(directory / "task-palpation_marks.json");
    explain_once<ChoiceRow>(directory / "task-softer_events.json");
    explain_samples_once(directory / "task-palpation_samples.json");
    explain_ratings_once(directory);
}

}  // namespace palpa::study
