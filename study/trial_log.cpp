#include "study/trial_log.h"

#include "study/rows.h"

namespace palpa {

template <class Visit>
void visit_fields(const EventRow& r, Visit&& visit) {
    visit("onset", r.onset_s, "s", "since the trial began");
    visit("duration", r.duration_s, "s", "of the trial, on the row finish");
    visit("trial_type", r.trial_type, "", "start, mark, confidence, undo or finish");
    visit("block", r.block, "", "practice (nodules shown) or test (hidden)");
    visit("trial", r.trial, "", "number of the trial");
    visit("order_id", r.order_id, "", "row of the protocol's order");
    visit("condition", r.condition, "", "law of the avatar: display_ratio, delay or none");
    visit("device_id", r.device_id, "", "pen, touch screen or mouse");
    visit("calibration_id", r.calibration_id, "", "profile of the pressure");
    visit("map_id", r.map_id, "", "tissue");
    visit("map_rotation_deg", r.map_rotation_deg, "deg", "how the tissue was turned, counter-clockwise");
    visit("map_flip", r.map_flip, "", "1: left and right exchanged before it was turned");
    visit("seed", r.seed, "", "of the scene");
    visit("n_nodules", r.n_nodules, "", "to be found");
    visit("tp", r.true_positives, "", "nodules found");
    visit("fp", r.false_positives, "", "marks on no nodule");
    visit("fn", r.false_negatives, "", "nodules missed");
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

namespace {

template <class Row>
void begin(const std::filesystem::path& sidecar, AppendFile& file) {
    write_text_atomically(sidecar, explanation_of<Row>());
    file.append(header_of<Row>());
    file.sync();
}

}  // namespace

TrialLog::TrialLog(const RunFiles& files) : events_(files.file("_events.tsv")), marks_(files.file("_marks.tsv")) {
    begin<EventRow>(files.file("_events.json"), events_);
    begin<MarkRow>(files.file("_marks.json"), marks_);
}

bool TrialLog::write(const EventRow& row) {
    line_of(row, line_);
    events_.append(line_);
    return events_.sync();
}

bool TrialLog::write(const MarkRow& row) {
    line_of(row, line_);
    marks_.append(line_);
    return marks_.sync();
}

}  // namespace palpa
