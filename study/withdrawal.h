#pragma once
// Participants who agree to take part, and those who stop before the end. Both are kept among the answers to the
// protocol's questions (study/ratings.h), so that they come with the logs of a tablet.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "study/ratings.h"

namespace palpa::study {

enum class Withdrawal {
    none,
    keeps_data,  // stopped; the data so far may be used
    takes_data   // stopped; the analysis leaves out all data of this participant
};

// Throws InputError for a withdrawal that does not say whether the data may be used, as a power cut may leave it, unless
// a later one does.
Withdrawal withdrawal_of(const std::filesystem::path& directory, const std::string& code);

// What a row of the answers' file tells, with or without its end; none if that is no withdrawal.
Withdrawal withdrawal_in(std::string_view row);

// Notes a withdrawal for the reader of a report. True for a participant who withdrew the data too.
bool takes_data(const std::filesystem::path& directory, const std::string& code, std::vector<std::string>& notes);

// Keeps that a participant stops; `how` is not none. Nothing is deleted. Throws std::runtime_error if it cannot be
// written.
void withdraw(const std::filesystem::path& directory, const std::string& code, Withdrawal how);

// True for an answer that says that a person takes part, or has stopped: no answer to a question.
bool tells_participation(const Rating& answer);

// The answer that stands for the consent of a participant.
Rating consent_given();

}  // namespace palpa::study
