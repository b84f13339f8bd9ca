#pragma once
// Checks of a study's logs as a whole: what a reader of single files cannot see.

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "study/planned.h"
#include "study/protocol.h"
#include "study/ratings.h"
#include "study/run_files.h"
#include "study/run_log.h"

namespace palpa::study {

// Returns the answers to the protocol's questions, each once: of several answers to one question the last counts, as
// after a power cut, when questions are asked again. Notes those that are left out: an answer to no question of the
// protocol (null: any question), or one that the question does not offer. What tells who takes part is left out, too.
std::vector<Rating> answers_to_questions(const Protocol* protocol, const std::string& code,
                                         const std::vector<Rating>& all, std::vector<std::string>& notes);

// Takes a choice's pair into `logged`, whose condition is known. Throws InputError for one that the protocol does not have.
// The level of a staircase follows from the answers, so any of its levels is right here. `place`: file and line.
void check_pair(const Protocol& protocol, const std::string& place, const RunLog::Choice& choice, Logged& logged);

// Throws InputError if participants.tsv tells another group than that of the participant's place in the plan.
void check_group(const std::filesystem::path& directory, const std::string& code, const std::string& told,
                 const std::string& planned);

// Throws InputError for an exclusion of nobody, or of a trial that is not finished.
void check_exclusions(const std::filesystem::path& directory, const std::set<std::string>& left_out,
                      const std::set<std::pair<std::string, int>>& left_out_trials, const std::set<std::string>& codes,
                      const std::set<std::pair<std::string, int>>& finished);

// The nodules of each condition's first trial, to which the others are compared.
class NodulesOfConditions {
  public:
    // Notes a trial of the same condition with other nodules.
    void compare(const std::string& condition, const std::string& settings_file,
                 const std::vector<RunSettings::Nodule>& nodules, std::vector<std::string>& notes);

  private:
    struct First {
        std::string nodules, file;
    };
    std::map<std::string, First> first_;
};

}  // namespace palpa::study
