#include "app/study/simulate.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

#include "app/assets.h"
#include "app/study/felt_search.h"
#include "app/study/felt_stimuli.h"
#include "app/study/simulated_trial.h"
#include "files/clock.h"
#include "files/folder_lock.h"
#include "files/progress_line.h"
#include "files/text.h"
#include "session/session.h"
#include "study/staircase_history.h"
#include "study/study_folder.h"
#include "study/typed_trial.h"

namespace palpa::app {
namespace {

// What searching hands feel, by condition; each is tabulated when it is needed first.
class FeltConditions {
  public:
    // Null for what is seen on a screen.
    const FeltSearch* of(const study::Protocol& protocol, const StudyScenes& scenes, std::uint64_t seed,
                         std::size_t condition) {
        const auto cast_of = protocol.conditions[condition].cast_of;
        const auto& scene = scenes[cast_of.value_or(condition)];
        if (!scene || (!cast_of && !feels_device(scene->scene))) return nullptr;
        const std::lock_guard lock(mutex_);
        std::unique_ptr<FeltSearch>& felt = felt_[condition];
        if (felt) return felt.get();
        if (cast_of) {
            felt = std::make_unique<FeltSearch>(*scene, [](double ratio) { return felt_by_hand(ratio); });
        } else {
            FeltStimuli stimuli(scenes, {}, seed);
            felt = std::make_unique<FeltSearch>(*scene, [&](double ratio) { return stimuli.of(condition, ratio); });
        }
        return felt.get();
    }

  private:
    std::mutex mutex_;
    std::map<std::size_t, std::unique_ptr<FeltSearch>> felt_;
};

struct Shared {
    const study::Protocol& protocol;
    const SimulateOptions& options;
    const StudyScenes& scenes;
    std::vector<files::Json> identities;  // by condition: hashes of map and profile
    std::atomic<int> next_participant{1};
    std::atomic<int> done{0};
    std::atomic<int> trials_begun{0};
    std::atomic<bool> stop{false};
    std::mutex mutex;
    SimulateResult result;
    std::exception_ptr error;
    FeltConditions felt_conditions;

    const FeltSearch* felt(std::size_t condition) {
        return felt_conditions.of(protocol, scenes, study::derived_seed(options.seed, kDevices, condition), condition);
    }
};

std::string code_of(int number) {
    char code[24];
    std::snprintf(code, sizeof code, "sim%04d", number);
    return code;
}

session::SessionFiles files_of(const Shared& shared, const study::PlannedParticipant& who,
                               const study::PlannedTrial& trial) {
    session::SessionFiles files;
    files.log = shared.options.output.string();
    files.participant = code_of(who.number);
    files.samples = shared.options.samples;
    files.sync_rows = false;  // nobody waits, and the trial is on the disk before the next begins
    files.label = label_of(shared.protocol, who, trial, shared.identities[trial.condition]);
    files.label->study["simulated"] = true;
    files.label->study["simulation_seed"] = shared.options.seed;
    return files;
}

// Lets a person search the tissue of a trial that has begun.
void search_tissue(Shared& shared, const study::PlannedParticipant& who, const study::PlannedTrial& trial,
                   session::Session& session) {
    session.state.time_every = 0;
    SimulatedHand hand{.seed = shared.options.seed, .rate_Hz = shared.options.rate_Hz};
    hand.felt = shared.felt(trial.condition);
    palpate_trial(shared.protocol, shared.protocol.conditions[trial.condition], who.number, trial, hand, session);
}

void run_trial(Shared& shared, const study::PlannedParticipant& who, const study::PlannedTrial& trial,
               session::Session& session) {
    const double began_s = files::steady_s();
    session.scene = scene_of(*shared.scenes[trial.condition], trial);
    session::begin_trial(files_of(shared, who, trial), simulated_screen(),
                         trial.practice ? session::TrialMode::practice : session::TrialMode::test, session);
    search_tissue(shared, who, trial, session);
    const std::int64_t samples = session.state.counters.samples;
    double written_MB = 0.0;
    if (session.files && shared.options.samples) {
        written_MB = 1e-6 * static_cast<double>(std::filesystem::file_size(session.files->file("_samples.tsv")));
    }
    const double wall_s = files::steady_s() - began_s;
    const std::string stem = session.files->stem;
    session.ended.clear();
    if (!session::close_files({{"wall_s", wall_s}, {"samples", samples}}, session)) {
        throw std::runtime_error(
            stem + ": the trial could not be written to its end (is the disk full?); the study has stopped");
    }
    const std::lock_guard lock(shared.mutex);
    ++shared.result.trials;
    shared.result.samples += samples;
    shared.result.written_MB += written_MB;
}

// On a cast of the phantom, by hand: nothing is logged but what the experimenter would type in.
void run_typed(Shared& shared, const study::PlannedParticipant& who, const study::PlannedTrial& trial,
               std::size_t phantom, session::Session& session) {
    session.scene = scene_of(*shared.scenes[phantom], trial);
    session::begin_trial({}, simulated_screen(), session::TrialMode::test, session);
    search_tissue(shared, who, trial, session);
    const session::SessionFiles files = files_of(shared, who, trial);
    std::vector<std::string> names;
    for (const stiffnessmaps::Nodule& nodule : session.plan->nodules) names.push_back(nodule.id);
    study::write_typed_trial(study::next_run(files.log, files.participant, files.task, files.first_run), *files.label,
                             trial.practice, static_cast<std::int64_t>(trial.seed), names,
                             typed_answers(*session.plan, session.trial));
    session.ended.clear();
    const std::lock_guard lock(shared.mutex);
    ++shared.result.trials;
}

// The answers of one participant to pairs of surfaces, which need no trials: each answer is drawn from what two surfaces
// feel like, with noise.
class PairAnswers {
  public:
    PairAnswers(Shared& shared, const study::PlannedParticipant& who)
        : shared_(shared),
          who_(who),
          felt_(shared.scenes, habit_of(shared, who.number),
                study::derived_seed(shared.options.seed, kDevices, static_cast<std::uint64_t>(who.number))) {}

    void answer(const study::PlannedTrial& trial) {
        const study::Protocol& protocol = shared_.protocol;
        const study::Condition& condition = protocol.conditions[trial.condition];
        const std::uint64_t of_person =
            study::derived_seed(shared_.options.seed, kAnswers, static_cast<std::uint64_t>(who_.number));
        study::Random random(study::derived_seed(of_person, kAnswers, static_cast<std::uint64_t>(trial.trial)));
        const int level = level_of(trial);
        study::ChoiceRow row;
        row.duration_s = 2.0 + random.uniform();
        row.onset_s = 3.0 * (trial.trial - 1);
        row.block = trial.practice ? "practice" : "test";
        row.trial = trial.trial;
        row.order_id = who_.order_id;
        row.condition = condition.id;
        row.device_id = condition.device;
        row.seed = trial.seed;
        row.reference_kPa = study::reference_kPa_of(protocol, trial.condition);
        row.comparison_kPa = study::comparisons_kPa_of(protocol, trial.condition)[static_cast<std::size_t>(level)];
        row.first = trial.reference_first ? "reference" : "comparison";
        if (const auto stays = study::reference_condition_of(protocol, trial.condition))
            row.reference_on = protocol.conditions[*stays].id;
        const bool right = is_right(trial, row, random);
        const bool reference_softer = row.reference_kPa < row.comparison_kPa;
        row.answer = right == reference_softer ? "reference" : "comparison";
        row.correct = right ? 1 : 0;
        const std::string code = code_of(who_.number);
        if (!log_) log_.emplace(study::next_run(shared_.options.output, code, "softer"));
        if (!log_->write(row))
            throw std::runtime_error(code + ": a choice could not be written; the study has stopped");
        if (trial.comparison < 0) steps_[trial.condition].push_back({level, trial.reference_first, right});
        const std::lock_guard lock(shared_.mutex);
        ++shared_.result.trials;
    }

  private:
    static PressHabit habit_of(const Shared& shared, int number) {
        study::Random random(study::derived_seed(shared.options.seed, kHabit, static_cast<std::uint64_t>(number)));
        return draw_habit(random);
    }

    // By what the displays showed where that can be run, else by the two stiffnesses themselves.
    bool is_right(const study::PlannedTrial& trial, const study::ChoiceRow& row, study::Random& random) {
        const study::Protocol& protocol = shared_.protocol;
        if (!feels_displays(protocol, shared_.scenes, trial.condition))
            return study::answers_right(row.reference_kPa, row.comparison_kPa, kSoftnessWeber, random);
        const std::size_t on = study::reference_condition_of(protocol, trial.condition).value_or(trial.condition);
        const double reference = study::perceived_ln(felt_.of(on, 1.0), {}, random);
        const double ratio = row.comparison_kPa / row.reference_kPa;
        const double comparison = study::perceived_ln(felt_.of(trial.condition, ratio), {}, random);
        return (comparison > reference) == (row.comparison_kPa > row.reference_kPa);
    }

    int level_of(const study::PlannedTrial& trial) {
        if (trial.comparison >= 0) return trial.comparison;
        auto [answers, fresh] = steps_.try_emplace(trial.condition);
        if (fresh) {  // of an earlier call
            answers->second = study::staircase_answers(shared_.options.output, shared_.protocol, code_of(who_.number),
                                                       trial.condition);
        }
        return study::next_level(shared_.protocol.staircase, answers->second, trial.reference_first);
    }

    Shared& shared_;
    const study::PlannedParticipant& who_;
    FeltStimuli felt_;
    std::optional<study::ChoiceLog> log_;
    std::map<std::size_t, std::vector<study::StaircaseAnswer>> steps_;  // by condition
};

void run_participant(Shared& shared, int number, std::vector<std::optional<session::Session>>& sessions) {
    const study::PlannedParticipant who = study::plan_participant(shared.protocol, number);
    const std::set<int> finished = study::finished_trials(shared.options.output, code_of(number));
    {
        const std::lock_guard lock(shared.mutex);
        shared.result.already_there += static_cast<int>(finished.size());
    }
    PairAnswers pairs(shared, who);
    for (const study::PlannedTrial& trial : who.trials) {
        if (shared.stop) return;
        ++shared.trials_begun;
        const bool pair = study::compares(study::task_of(shared.protocol, trial.condition));
        const auto cast_of = shared.protocol.conditions[trial.condition].cast_of;
        const std::size_t tissue = cast_of.value_or(trial.condition);
        const bool simulated =
            (pair || shared.scenes[tissue].has_value()) && (!trial.practice || shared.options.practice);
        if (!simulated && !trial.practice) {
            const std::lock_guard lock(shared.mutex);
            ++shared.result.left_out;
        }
        if (!simulated || finished.count(trial.trial) > 0) continue;
        if (pair) {
            pairs.answer(trial);
            continue;
        }
        std::optional<session::Session>& session = sessions[trial.condition];
        if (!session) {
            session.emplace();
            session->plan = shared.scenes[tissue]->plan;
        }
        if (cast_of)
            run_typed(shared, who, trial, tissue, *session);
        else
            run_trial(shared, who, trial, *session);
    }
}

void work(Shared& shared) {
    std::vector<std::optional<session::Session>> sessions(shared.protocol.conditions.size());
    try {
        while (!shared.stop) {
            const int number = shared.next_participant++;
            if (number > shared.options.participants) return;
            run_participant(shared, number, sessions);
            ++shared.done;
        }
    } catch (...) {
        const std::lock_guard lock(shared.mutex);
        if (!shared.error) shared.error = std::current_exception();
        shared.stop = true;
    }
}

void add_everybody(const study::Protocol& protocol, const SimulateOptions& options) {
    std::vector<study::Person> people;
    for (int number = 1; number <= options.participants; ++number) {
        study::Person person;
        person.code = code_of(number);
        person.group = protocol.groups[study::membership_of(protocol, number).group].id;
        people.push_back(person);
    }
    study::add_people(options.output, people);
}

}  // namespace

SimulateResult simulate_study(const study::Protocol& protocol, const SimulateOptions& options) {
    const double began_s = files::steady_s();
    const StudyScenes scenes = load_study_scenes(protocol);
    Shared shared{protocol, options, scenes, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    shared.next_participant = 1;
    shared.identities = identities_of(scenes);
    std::error_code error;  // open_study says why a folder cannot be made
    std::optional<files::FolderLock> lock;
    std::filesystem::create_directories(options.output, error);
    if (!error) lock.emplace(options.output, study::kOtherWriter);
    study::open_study(options.output, protocol, {true, options.seed, "palpa " PALPA_VERSION, options.rate_Hz});
    add_everybody(protocol, options);
    std::vector<std::thread> workers;
    for (int i = 0; i < options.jobs; ++i) workers.emplace_back([&] { work(shared); });
    const auto trials = static_cast<double>(study::plan_participant(protocol, 1).trials.size()) * options.participants;
    std::thread teller([&] {
        files::ProgressLine line;
        while (!shared.stop && shared.done < options.participants) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            const int begun = shared.trials_begun;
            line.show(std::to_string(shared.done) + " of " + std::to_string(options.participants) + " participants",
                      static_cast<double>(begun) / trials);
        }
    });
    for (std::thread& worker : workers) worker.join();
    teller.join();
    if (shared.error) std::rethrow_exception(shared.error);
    shared.result.wall_s = files::steady_s() - began_s;
    return shared.result;
}

}  // namespace palpa::app
