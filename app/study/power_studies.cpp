#include "app/study/power_studies.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/study/simulated_trial.h"
#include "files/input_error.h"
#include "files/text.h"
#include "study/follow_protocol.h"
#include "study/found_trial.h"
#include "study/stiffer_counts.h"

namespace palpa::app {
namespace {

std::string simulated_code(int number) {
    char code[24];
    std::snprintf(code, sizeof code, "sim%04d", number);
    return code;
}

// A finished trial as its log would tell of it.
void add_finished(const session::Session& session, const std::string& condition, int person,
                  study::FoundTrials& found) {
    const session::Trial& trial = session.trial;
    const study::Score score = session::debrief(*session.plan, trial).score;
    study::RunLog run;
    run.condition = condition;
    run.tp = score.true_positives;
    run.fp = score.false_positives;
    run.fn = score.false_negatives;
    run.duration_s = trial.now_s - trial.began_s;
    run.path_m = trial.pressed_m;
    run.mean_force_N = session::mean_force_N(trial);
    run.max_force_N = trial.max_force_N;
    study::RunSettings settings;
    settings.there = true;
    settings.tissue = session.plan->tissue_name;
    for (const auto& nodule : session.plan->nodules)
        settings.nodules.push_back({nodule.id, 1e3 * nodule.diameter_m.value_or(0.0)});
    std::vector<study::LoggedMark> marks;
    for (std::size_t i = 0; i < trial.marks.size(); ++i) {
        const study::MarkScore& mark = score.marks[i];
        study::LoggedMark logged{"n/a", 1e3 * mark.distance_m, mark.kind == study::MarkKind::hit};
        if (mark.target >= 0) logged.nodule = session.plan->nodules[static_cast<std::size_t>(mark.target)].id;
        if (trial.marks[i].confidence > 0) logged.confidence = trial.marks[i].confidence;
        marks.push_back(std::move(logged));
    }
    found.add(run, person, settings, marks);
}

struct MemoryStudy {
    const study::Protocol& protocol;
    const StudyScenes& scenes;
    std::uint64_t seed;
    SimulatedEffect effect;
    double rate_Hz;
    PowerSessions& sessions;
    study::Observations seen;
    study::FoundTrials found{seen};
    study::NameIndex comparisons{seen.comparisons};
};

// The condition whose scene a test shows.
std::size_t shown_condition(const MemoryStudy& all, int number, const study::PlannedTrial& trial) {
    const std::size_t reference = all.effect.reference;
    if (trial.condition == reference || !all.scenes[reference] || !all.scenes[trial.condition]) return trial.condition;
    const std::uint64_t person = study::derived_seed(all.seed, kOwnScene, static_cast<std::uint64_t>(number));
    study::Random random(study::derived_seed(person, kOwnScene, static_cast<std::uint64_t>(trial.trial)));
    return random.uniform() < all.effect.effect ? trial.condition : reference;
}

void find_in_memory(MemoryStudy& all, int number, const study::PlannedTrial& trial) {
    const std::size_t shown = shown_condition(all, number, trial);
    if (!all.scenes[shown]) return;  // by hand
    std::optional<session::Session>& session = all.sessions.of_condition[shown];
    if (!session) {
        session.emplace();
        session->plan = all.scenes[shown]->plan;
    }
    session->scene = scene_of(*all.scenes[shown], trial);
    session::begin_trial({}, simulated_screen(), session::TrialMode::test, *session);
    session->state.time_every = 0;
    palpate_trial(all.protocol, all.protocol.conditions[shown], number, trial,
                  {all.seed, all.rate_Hz, all.effect.noise}, *session);
    session->ended.clear();
    add_finished(*session, all.protocol.conditions[trial.condition].id, number - 1, all.found);
}

void choose_in_memory(MemoryStudy& all, int number, const study::PlannedTrial& trial) {
    const std::uint64_t person = study::derived_seed(all.seed, kAnswers, static_cast<std::uint64_t>(number));
    study::Random random(study::derived_seed(person, kAnswers, static_cast<std::uint64_t>(trial.trial)));
    const double reference_kPa = study::reference_kPa_of(all.protocol, trial.condition);
    const double comparison_kPa =
        study::comparisons_kPa_of(all.protocol, trial.condition)[static_cast<std::size_t>(trial.comparison)];
    const bool of_reference = trial.condition == all.effect.reference;
    const double weber = kSoftnessWeber * all.effect.noise * (of_reference ? 1.0 : std::exp(all.effect.effect));
    const bool right = study::answers_right(reference_kPa, comparison_kPa, weber, random);
    const int condition = all.found.conditions.of(all.protocol.conditions[trial.condition].id);
    const int comparison = all.comparisons.of(files::number_text(comparison_kPa) + " kPa");
    all.seen.choices.push_back({condition, number - 1, comparison, right ? 1 : 0, 1});
    const bool fixed_reference = study::reference_condition_of(all.protocol, trial.condition).has_value();
    const bool reference_softer = right == (reference_kPa < comparison_kPa);
    all.seen.stiffer.push_back(study::stiffer_choice(
        {reference_kPa, comparison_kPa, trial.reference_first, fixed_reference}, reference_softer));
    all.seen.stiffer.back().condition = condition;
    all.seen.stiffer.back().participant = number - 1;
}

template <class Rows>
void keep_first(int participants, Rows& rows) {
    std::erase_if(rows, [&](const auto& row) { return row.participant >= participants; });
}

}  // namespace

std::size_t reference_of(const study::Protocol& protocol, const StudyScenes& scenes, const std::string& id) {
    const bool stated = protocol.primary && !protocol.primary->of_groups;
    const std::string wanted = !id.empty() ? id : stated ? protocol.primary->sides[0] : protocol.conditions.front().id;
    const auto it = std::find_if(protocol.conditions.begin(), protocol.conditions.end(),
                                 [&](const study::Condition& one) { return one.id == wanted; });
    if (it == protocol.conditions.end())
        throw files::bad_input("--reference", "", files::shown(id),
                               "the id of a condition of " + protocol.file.string());
    const auto index = static_cast<std::size_t>(it - protocol.conditions.begin());
    if (!scenes[index] && !compares(task_of(protocol, index)))
        throw files::bad_input("--reference", "", files::shown(wanted) + ", which is by hand",
                               "a condition with a scene");
    return index;
}

void check_power_protocol(const study::Protocol& protocol, const StudyScenes& scenes) {
    bool any = false;
    for (std::size_t i = 0; i < protocol.conditions.size(); ++i) {
        const study::TaskKind task = task_of(protocol, i);
        const auto refuse = [&](const char* found) {
            throw files::bad_input(
                protocol.file.string(), "conditions, " + protocol.conditions[i].id, found,
                "nodules to find with a scene, or choices without one: nothing else is simulated in memory");
        };
        if (task == study::TaskKind::staircase) refuse("a staircase");
        if (task == study::TaskKind::choice && scenes[i]) refuse("choices that are felt through a scene");
        any = any || scenes[i] || task == study::TaskKind::choice;
    }
    if (!any) {
        throw files::bad_input(protocol.file.string(), "conditions", "conditions by hand only",
                               "one condition at least that can be simulated");
    }
}

study::Observations study_in_memory(const study::Protocol& protocol, const StudyScenes& scenes, int participants,
                                    std::uint64_t seed, const SimulatedEffect& effect, double rate_Hz,
                                    PowerSessions& sessions) {
    MemoryStudy all{protocol, scenes, seed, effect, rate_Hz, sessions, {}};
    all.seen.from_logs = true;
    all.seen.simulated = true;
    std::vector<study::Person> people;
    for (int number = 1; number <= participants; ++number) {
        const study::PlannedParticipant who = study::plan_participant(protocol, number);
        all.seen.participants.push_back(simulated_code(number));
        people.emplace_back();
        people.back().code = all.seen.participants.back();
        people.back().group = protocol.groups[who.group].id;
        for (const study::PlannedTrial& trial : who.trials) {
            if (trial.practice) continue;
            if (compares(task_of(protocol, trial.condition))) {
                choose_in_memory(all, number, trial);
            } else {
                find_in_memory(all, number, trial);
            }
        }
    }
    study::take_groups(people, all.seen);
    return std::move(all.seen);
}

study::Observations first_people(const study::Protocol& protocol, const study::Observations& seen, int participants) {
    study::Observations out = seen;
    const auto n = std::min(static_cast<std::size_t>(participants), out.participants.size());
    out.participants.resize(n);
    out.group_of.resize(std::min(n, out.group_of.size()));
    keep_first(participants, out.rows);
    keep_first(participants, out.trials);
    keep_first(participants, out.choices);
    keep_first(participants, out.stiffer);
    keep_first(participants, out.judged);
    study::follow_protocol(protocol, out);
    return out;
}

}  // namespace palpa::app
