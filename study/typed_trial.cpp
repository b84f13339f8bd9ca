#include "study/typed_trial.h"

#include <algorithm>
#include <stdexcept>

#include "files/text.h"

namespace palpa::study {
namespace {

files::Json settings_of(const TrialLabel& label, const std::vector<std::string>& nodules) {
    files::Json json{
        {"study", label.study}, {"answers", "typed in by the experimenter"}, {"nodules", files::Json::array()}};
    for (const std::string& id : nodules) json["nodules"].push_back({{"id", id}});
    return json;
}

bool write_marks(const TrialLabel& label, const std::vector<std::string>& nodules, const TypedAnswers& answers,
                 TrialLog& log) {
    MarkRow row;
    row.onset_s = answers.duration_s;  // the log does not know when each answer was given
    row.trial = label.trial;
    row.mark = 0;
    row.x_mm = row.y_mm = MarkRow::kMissing;
    bool good = true;
    for (std::size_t i = 0; i < nodules.size(); ++i) {
        if (answers.nodules[i] == kMissed) continue;
        ++row.mark;
        row.confidence = answers.nodules[i] > 0 ? answers.nodules[i] : MarkRow::kMissing;
        row.nodule = nodules[i];
        row.hit = 1;
        good = log.write(row) && good;
    }
    row.confidence = MarkRow::kMissing;
    row.nodule = "n/a";
    row.hit = 0;
    for (int i = 0; i < answers.false_marks; ++i) {
        ++row.mark;
        good = log.write(row) && good;
    }
    return good;
}

}  // namespace

int found_of(const TypedAnswers& answers) {
    const auto named =
        std::count_if(answers.nodules.begin(), answers.nodules.end(), [](int said) { return said != kMissed; });
    return answers.found + static_cast<int>(named);
}

int missed_of(const TypedAnswers& answers) {
    return answers.missed + static_cast<int>(std::count(answers.nodules.begin(), answers.nodules.end(), kMissed));
}

void write_typed_trial(const RunFiles& files, const TrialLabel& label, bool practice, std::int64_t seed,
                       const std::vector<std::string>& nodules, const TypedAnswers& answers) {
    files::write_text_atomically(files.file("_settings.json"), files::json_text(settings_of(label, nodules)));
    TrialLog log(files, {true, false});
    EventRow row;
    row.trial_type = "start";
    row.block = practice ? "practice" : "test";
    row.trial = label.trial;
    row.order_id = label.order_id;
    row.condition = label.condition;
    row.device_id = label.device;
    row.seed = seed;
    row.n_nodules = found_of(answers) + missed_of(answers);
    bool good = log.write(row);
    good = write_marks(label, nodules, answers, log) && good;
    row.trial_type = "finish";
    row.onset_s = row.duration_s = answers.duration_s;
    row.true_positives = found_of(answers);
    row.false_negatives = missed_of(answers);
    row.false_positives = answers.false_marks;
    good = good && log.write(row);  // last, since it says that all else was written
    if (!good) throw std::runtime_error(files.stem + ": the typed answers could not be written (is the disk full?)");
}

}  // namespace palpa::study
