#pragma once
// The protocol of a study, from one JSON file (assets/schemas/protocol.schema.json): groups, conditions, tasks, order.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "study/primary.h"

namespace palpa::study {

enum class Modality { touchpad, pen, finger, mouse, tangible, shape_display, hand };
enum class OrderKind { fixed, random, latin, williams };
enum class TaskKind { find, choice, staircase };
enum class Assignment { alternate, random };
enum class TrialOrder { blocked, interleaved, shuffled };
enum class StaircaseMethod { weighted_up_down, quest_plus };

struct Condition {
    std::string id;
    std::string title;  // as the experimenter sees it
    Modality modality = Modality::pen;
    std::string scene;    // file relative to the protocol or among the assets' scenes; empty: by hand
    std::string profile;  // file that replaces the scene's profile; empty: the scene's
    std::string device;   // free text, for the log
    std::string instructions;
    std::vector<std::string> nodules;  // by hand only: names of the phantom's nodules, for answers typed in
    // By hand only: the condition whose scene's phantom this one is cast from, so that its nodules are known, and what a
    // simulated participant would feel.
    std::optional<std::size_t> cast_of{};
    std::optional<TaskKind> task;  // absent: the protocol's; task_of() knows
    // The answers are typed in: by hand, and on a display that the scene does not drive, which only who has read the scenes
    // knows (app/study/study_scenes.h).
    bool typed_in = false;
};

struct Group {
    std::string id;
    std::vector<std::size_t> conditions;  // indices into Protocol::conditions
};

// A forced choice: which of two surfaces is softer, the reference or a comparison? Pairs are shown in both orders.
struct ChoiceTask {
    double reference_kPa = 0.0;
    std::vector<double> comparisons_kPa;
    int repeats = 2;  // of each pair under each condition; an even number gives both orders equally often
    bool alternate_conditions = false;  // conditions alternate trial by trial; else one is completed before the next
    // The condition of every reference; absent: that of the comparison.
    std::optional<std::size_t> reference_on = std::nullopt;
};

// A forced choice whose comparison follows from the answers so far (study/staircase.h), to find a threshold.
struct StaircaseTask {
    StaircaseMethod method = StaircaseMethod::quest_plus;
    double reference_kPa = 0.0;
    std::vector<double> comparisons_kPa;  // the levels, the most similar to the reference first
    int trials = 40;                      // under each condition
    int steps_after_wrong = 3;            // weighted up-down: k levels easier after a wrong answer, 1 harder else
    int start = 0;                        // weighted up-down: index of the first level
};

// A question to the participant, before the trials or after each condition.
struct Item {
    std::string id;
    std::string text;
    std::vector<std::string> choices;  // empty: free text, or a scale
    std::optional<int> from, to;       // of a rating scale
    std::string low, high;             // what its ends mean, such as "not at all" and "very"; may be empty
};

// Whether an answer is a step of the item's scale (from and to are there): a whole number.
bool is_step_of(const Item& scale, const std::string& answer);

// Who made a study, for the description of its dataset and for its preregistration. All of it may be missing.
struct DatasetAbout {
    std::vector<std::string> authors, funding, ethics_approvals;
    std::string license;       // such as CC0
    std::string registration;  // where the study is registered, such as a DOI
};

struct Protocol {
    std::filesystem::path file;
    std::string text;    // content of the file, which is copied beside the logs
    std::string sha256;  // of the text
    std::string name;
    std::string version;
    std::uint32_t seed = 1;
    TaskKind task = TaskKind::find;  // of conditions that name none
    ChoiceTask choice;               // of conditions with TaskKind::choice
    StaircaseTask staircase;         // of conditions with TaskKind::staircase
    std::vector<Condition> conditions;
    std::vector<Group> groups;
    Assignment assignment = Assignment::alternate;
    int people_per_block = 2;  // of each group, in a block of random assignment
    OrderKind order = OrderKind::random;
    TrialOrder trial_order = TrialOrder::blocked;
    int repeats = 1;            // trials of each condition in which nodules are to be found
    bool turn_maps = true;      // trials of a participant show the map under different quarter turns
    bool flip_maps = false;     // also with left and right exchanged: eight views instead of four
    double time_limit_s = 0.0;  // 0: none
    int practice_trials = 0;    // before the first trial of each condition, with known positions
    double practice_limit_s = 0.0;
    int break_every_trials = 0;
    bool count_told = false;  // whether the participant is told the number of nodules
    std::string consent;      // shown before everything else; a participant takes part only after agreeing. Empty: none
    std::string instructions;
    std::vector<Item> demographics;
    std::vector<Item> ratings;
    std::optional<PrimaryComparison> primary;  // of the analysis
    int planned_participants = 0;              // of the analysis; 0: not stated
    std::string stopping_rule;                 // of the analysis: when the study ends; empty: not stated
    DatasetAbout about;
};

// Throws InputError that names file, key, what was found and what was expected.
Protocol read_protocol(const std::filesystem::path& file);

TaskKind task_of(const Protocol& protocol, std::size_t condition);
// True for tasks in which two surfaces are compared.
bool compares(TaskKind task);

// The condition under which the references of this one are presented, if its task is a choice with
// choice.reference_on; else nothing: its own.
std::optional<std::size_t> reference_condition_of(const Protocol& protocol, std::size_t condition);

// The surfaces of a condition in which two are compared.
double reference_kPa_of(const Protocol& protocol, std::size_t condition);
const std::vector<double>& comparisons_kPa_of(const Protocol& protocol, std::size_t condition);

const char* name_of(Modality modality);
const char* name_of(OrderKind order);
const char* name_of(TaskKind task);
const char* name_of(TrialOrder order);
const char* name_of(StaircaseMethod method);

// When a participant's practice comes: "before each condition", or, where the trials of the conditions are mixed, "of each
// condition before all tests".
std::string practice_comes(const Protocol& protocol);

}  // namespace palpa::study
