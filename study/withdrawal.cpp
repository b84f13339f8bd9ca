#include "study/withdrawal.h"

#include <cassert>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::study {
namespace {

constexpr const char* kConsentItem = "consent";
constexpr const char* kWithdrawalItem = "withdrawal";
constexpr const char* kKeepsData = "data may be used";
constexpr const char* kTakesData = "data must not be used";

}  // namespace

Withdrawal withdrawal_of(const std::filesystem::path& directory, const std::string& code) {
    std::vector<std::string> notes;
    Withdrawal last = Withdrawal::none;
    for (const Rating& answer : read_ratings(directory, code, notes)) {
        if (answer.condition != "n/a" || answer.item != kWithdrawalItem) continue;
        if (answer.value != kTakesData && answer.value != kKeepsData) {
            throw files::bad_input(ratings_file(directory, code).string(), kWithdrawalItem, files::shown(answer.value),
                                   files::shown(kKeepsData) + " or " + files::shown(kTakesData));
        }
        last = answer.value == kTakesData ? Withdrawal::takes_data : Withdrawal::keeps_data;
    }
    return last;
}

bool takes_data(const std::filesystem::path& directory, const std::string& code, std::vector<std::string>& notes) {
    const Withdrawal how = withdrawal_of(directory, code);
    if (how == Withdrawal::none) return false;
    notes.push_back("sub-" + code + ": withdrew from the study; the data " +
                    (how == Withdrawal::takes_data ? "are left out, as the participant asked" : "may be used"));
    return how == Withdrawal::takes_data;
}

void withdraw(const std::filesystem::path& directory, const std::string& code, Withdrawal how) {
    assert(how != Withdrawal::none);
    add_ratings(directory, code, {{"n/a", kWithdrawalItem, how == Withdrawal::takes_data ? kTakesData : kKeepsData}});
}

bool tells_participation(const Rating& answer) {
    return answer.condition == "n/a" && (answer.item == kConsentItem || answer.item == kWithdrawalItem);
}

Rating consent_given() { return {"n/a", kConsentItem, "given"}; }

}  // namespace palpa::study
