#include "study/found_trial.h"

#include <algorithm>

namespace palpa::study {

void FoundTrials::add(const RunLog& run, int participant, const RunSettings& settings,
                      const std::vector<LoggedMark>& marks) {
    const int condition = conditions.of(run.condition);
    const int repeat = repeats_[{participant, condition}]++;
    for (const RunSettings::Nodule& nodule : settings.nodules) {
        const bool hit = std::any_of(marks.begin(), marks.end(),
                                     [&](const LoggedMark& mark) { return mark.hit && mark.nodule == nodule.id; });
        out_.rows.push_back({condition, participant, nodules.of(nodule.id), repeat, hit, !hit, 0});
    }
    if (settings.there && !settings.typed) {
        out_.judged.push_back(judged_case(settings, marks));
        out_.judged.back().condition = condition;
        out_.judged.back().participant = participant;
    }
    const bool named = !settings.nodules.empty();
    out_.rows.push_back({condition, participant, -1, repeat, named ? 0 : run.tp, named ? 0 : run.fn, run.fp});
    out_.trials.push_back({condition, participant, run.duration_s, run.path_m, run.mean_force_N, run.max_force_N});
}

}  // namespace palpa::study
