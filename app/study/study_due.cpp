// The trial of a study that is due: its scene, its files, its limit.

#include <algorithm>

#include "app/study/study_run.h"
#include "files/text.h"
#include "study/staircase_history.h"

namespace palpa::app {

const study::PlannedTrial& due_trial(const StudyRun& run) { return *run.progress.next; }

std::size_t due_condition_index(const StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    const bool reference = (run.interval == 0) == trial.reference_first;
    const auto stays = study::reference_condition_of(run.protocol, trial.condition);
    return reference ? stays.value_or(trial.condition) : trial.condition;
}

const study::Condition& due_condition(const StudyRun& run) { return run.protocol.conditions[due_condition_index(run)]; }

bool typed_in(const StudyRun& run, std::size_t condition) { return run.protocol.conditions[condition].typed_in; }

bool feels_device(const StudyRun& run) {
    if (!shows_tissue(run)) return false;
    const scene::Scene& scene = run.scenes[due_condition_index(run)]->scene;
    return scene.tactile || scene.tangible;
}

bool shows_tissue(const StudyRun& run) {
    const std::size_t condition = due_condition_index(run);
    return !typed_in(run, condition) && run.scenes[condition].has_value();
}

bool due_compares(const StudyRun& run) {
    return run.progress.next && study::compares(study::task_of(run.protocol, run.progress.next->condition));
}

void find_comparison(StudyRun& run) {
    run.comparison = -1;
    if (!due_compares(run)) return;
    const study::PlannedTrial& trial = due_trial(run);
    run.comparison = trial.comparison;
    if (run.comparison >= 0) return;
    const auto answers = study::staircase_answers(run.directory, run.protocol, run.code, trial.condition);
    run.comparison = study::next_level(run.protocol.staircase, answers, trial.reference_first);
}

double due_comparison_kPa(const StudyRun& run) {
    const std::vector<double>& kPa = study::comparisons_kPa_of(run.protocol, due_trial(run).condition);
    return kPa[static_cast<std::size_t>(run.comparison)];
}

const StudyScene& due_scene(const StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    if (!due_compares(run)) return *run.scenes[trial.condition];
    const bool reference = (run.interval == 0) == trial.reference_first;
    return run.stimuli[due_condition_index(run)][reference ? 0 : 1 + static_cast<std::size_t>(run.comparison)];
}

session::SessionFiles due_files(const StudyRun& run) {
    const study::PlannedTrial& trial = due_trial(run);
    session::SessionFiles files;
    files.log = run.directory.string();
    files.participant = run.code;
    files.first_run = run.first_run;
    const std::size_t condition = due_condition_index(run);  // that of the interval
    files.label = label_of(run.protocol, run.progress.plan, trial, run.identities[condition]);
    files.label->condition = run.protocol.conditions[condition].id;
    files.label->device = run.protocol.conditions[condition].device;
    files.label->study["modality"] = name_of(run.protocol.conditions[condition].modality);
    if (due_compares(run)) {
        files.task = "interval";
        files.label->study["interval"] = run.interval + 1;
    }
    return files;
}

study::ChoiceRow due_choice(const StudyRun& run, bool first_is_softer) {
    const study::PlannedTrial& trial = due_trial(run);
    const study::Condition& condition = run.protocol.conditions[trial.condition];
    const bool reference = first_is_softer == trial.reference_first;
    study::ChoiceRow row;
    row.block = trial.practice ? "practice" : "test";
    row.trial = trial.trial;
    row.order_id = run.progress.plan.order_id;
    row.condition = condition.id;
    row.device_id = condition.device;
    row.seed = trial.seed;
    row.reference_kPa = study::reference_kPa_of(run.protocol, trial.condition);
    row.comparison_kPa = due_comparison_kPa(run);
    if (const auto stays = study::reference_condition_of(run.protocol, trial.condition))
        row.reference_on = run.protocol.conditions[*stays].id;
    row.first = trial.reference_first ? "reference" : "comparison";
    row.answer = reference ? "reference" : "comparison";
    row.correct = reference == (row.reference_kPa < row.comparison_kPa) ? 1 : 0;
    return row;
}

double due_limit_s(const StudyRun& run) {
    return due_trial(run).practice ? run.protocol.practice_limit_s : run.protocol.time_limit_s;
}

std::vector<std::string> due_nodules(const StudyRun& run) {
    const std::size_t condition = due_trial(run).condition;
    const auto& scene = run.scenes[run.protocol.conditions[condition].cast_of.value_or(condition)];
    if (!scene) return due_condition(run).nodules;
    std::vector<std::string> names;
    for (const stiffnessmaps::Nodule& nodule : scene->plan->nodules) names.push_back(nodule.id);
    return names;
}

const std::vector<study::Item>& due_items(const StudyRun& run) {
    return at<step::Questions>(run) ? run.protocol.demographics : run.protocol.ratings;
}

bool is_answer(const study::Item& item, const std::string& answer) {
    return answer.empty() || !item.from || study::is_step_of(item, answer);
}

std::size_t finished_count(const StudyRun& run) {
    const bool told = at<step::Told>(run) || at<step::Feedback>(run);
    return run.progress.finished.size() + (told ? 1 : 0);
}

files::Json now_json(const StudyRun& run) {
    files::Json json{{"participant", run.code},
                     {"step", name_of(run.step)},
                     {"finished", finished_count(run)},
                     {"of", run.progress.plan.trials.size()},
                     {"locked", run.lock != nullptr && run.lock->held()}};
    if (const auto* stopped = std::get_if<step::Stopped>(&run.step)) json["stopped"] = stopped->why;
    if (const auto* rated = std::get_if<step::Ratings>(&run.step)) {
        json["rated"] = run.protocol.conditions[rated->condition].id;
        return json;
    }
    // nothing is presented yet to somebody who answers the first questions, nor any more to somebody who has left
    const bool before = at<step::Again>(run) || at<step::Consent>(run) || at<step::Questions>(run);
    if (!run.progress.next || before || at<step::Withdrawn>(run)) return json;
    const study::PlannedTrial& trial = *run.progress.next;
    json["trial"] = trial.trial;
    json["condition"] = run.protocol.conditions[trial.condition].id;
    json["practice"] = trial.practice;
    if (run.comparison < 0) return json;
    const double comparison_kPa = due_comparison_kPa(run);
    const double reference_kPa = study::reference_kPa_of(run.protocol, trial.condition);
    json["present_kPa"] = {trial.reference_first ? reference_kPa : comparison_kPa,
                           trial.reference_first ? comparison_kPa : reference_kPa};
    json["interval"] = run.interval + 1;
    json["condition"] = due_condition(run).id;  // that of the interval
    return json;
}

std::vector<ShownText> shown_texts(const study::Protocol& protocol) {
    std::vector<ShownText> texts{{"consent", protocol.consent}, {"instructions", protocol.instructions}};
    for (const study::Condition& condition : protocol.conditions) {
        texts.push_back({"conditions: " + condition.id, condition.title + condition.instructions});
        for (const std::string& nodule : condition.nodules) texts.back().text += nodule;
    }
    for (const auto* items : {&protocol.demographics, &protocol.ratings}) {
        for (const study::Item& item : *items) {
            texts.push_back({(items == &protocol.ratings ? "ratings: " : "demographics: ") + item.id,
                             item.text + item.low + item.high});
            for (const std::string& choice : item.choices) texts.back().text += choice;
        }
    }
    return texts;
}

std::string letters_of(const study::Protocol& protocol) {
    std::string letters;
    for (const ShownText& shown : shown_texts(protocol)) letters += shown.text;
    return letters;
}

std::string progress_text(const StudyRun& run) {
    const std::size_t of = run.progress.plan.trials.size();
    return std::to_string(std::min(of, run.progress.finished.size() + 1)) + " of " + std::to_string(of);
}

}  // namespace palpa::app
