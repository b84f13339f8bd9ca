#include "study/withdrawal.h"

#include <cassert>
#include <optional>
#include <string_view>
#include <utility>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::study {
namespace {

constexpr const char* kConsentItem = "consent";
constexpr const char* kWithdrawalItem = "withdrawal";
constexpr const char* kKeepsData = "data may be used";
constexpr const char* kTakesData = "data must not be used";

// True if a line may be what a power cut left of a withdrawal.
bool may_be_withdrawal(const RatingLine& line) {
    if (line.fields.size() < 2 || line.fields[0] != "n/a") return false;
    if (line.fields[1] == kWithdrawalItem) return true;
    const bool broken = line.fields.size() != 3 && !line.fields[1].empty();  // maybe in the middle of the item's name
    return broken && std::string_view(kWithdrawalItem).starts_with(line.fields[1]);
}

// The withdrawal that a line of three fields tells; nothing if it tells none of the two.
std::optional<Withdrawal> told_by(const RatingLine& line) {
    if (line.fields.size() != 3) return std::nullopt;
    if (line.fields[2] == kTakesData) return Withdrawal::takes_data;
    if (line.fields[2] == kKeepsData) return Withdrawal::keeps_data;
    return std::nullopt;
}

}  // namespace

Withdrawal withdrawal_of(const std::filesystem::path& directory, const std::string& code) {
    Withdrawal last = Withdrawal::none;
    std::optional<RatingLine> unclear;  // while none that is clear follows it
    for (const RatingLine& line : rating_lines(directory, code)) {
        if (!may_be_withdrawal(line)) continue;
        const auto told = told_by(line);
        if (told) last = *told;
        unclear = told ? std::nullopt : std::optional(line);
    }
    if (!unclear) return last;
    throw files::bad_input(ratings_file(directory, code).string() + ": line " + std::to_string(unclear->number),
                           kWithdrawalItem,
                           files::shown(unclear->fields.size() == 3 ? unclear->fields[2] : unclear->text),
                           files::shown(kKeepsData) + " or " + files::shown(kTakesData) +
                               "; ask what was meant, and note it by palpa study withdraw");
}

Withdrawal withdrawal_in(std::string_view row) {
    if (!row.empty() && row.back() == '\n') row.remove_suffix(1);
    for (const auto& [how, text] :
         {std::pair{Withdrawal::keeps_data, kKeepsData}, {Withdrawal::takes_data, kTakesData}}) {
        if (row == std::string("n/a\t") + kWithdrawalItem + "\t" + text) return how;
    }
    return Withdrawal::none;
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
