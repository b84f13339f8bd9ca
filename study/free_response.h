#pragma once
// Free-response data: people mark places in cases and rate each mark. A mark on a lesion is a lesion localization (LL), a
// mark on none a non-lesion localization (NL). A case is one tissue in one trial; people do not know how many lesions it
// has. Source: Chakraborty, Observer Performance Methods for Diagnostic Imaging (2017), and its online book RJafrocFrocBook,
// chapters 2 and 3.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace palpa::study {

inline constexpr double kUnmarked = -std::numeric_limits<double>::infinity();  // below every rating

struct FreeResponseCase {
    std::string id;
    std::vector<std::string> lesions;  // empty: a case without lesions
    std::vector<double> weights;       // by lesion, with the sum 1; empty: all the same
};

// What one person marked in one case under one condition.
struct Reading {
    std::vector<double> nl;  // ratings of the marks on no lesion
    std::vector<double> ll;  // by lesion of the case: its highest rating, kUnmarked if it has no mark
};

struct FreeResponse {
    std::vector<std::string> conditions;
    std::vector<std::string> participants;
    std::vector<FreeResponseCase> cases;
    std::vector<std::optional<Reading>> readings;  // [condition][participant][case]; nothing: not judged

    std::size_t place(std::size_t condition, std::size_t participant, std::size_t c) const {
        return (condition * participants.size() + participant) * cases.size() + c;
    }
    const std::optional<Reading>& at(std::size_t condition, std::size_t participant, std::size_t c) const {
        return readings[place(condition, participant, c)];
    }
};

// Figures of merit, all from psi(a, b) = 1 if a < b, 1/2 if a = b (also of two unmarked ones), 0 otherwise. FP_i is the
// highest NL of case i (kUnmarked without), z_kl the rating of lesion l of case k and W_kl its weight; K1 cases have no
// lesion, K2 have lesions:
//
//     wafroc   1/(K1 K2)      sum_{i without} sum_{k with} sum_l W_kl psi(FP_i, z_kl)
//     wafroc1  1/((K1+K2) K2) the same with the sum over all cases i
//     afroc    1/(K1 L)       the same with W_kl = 1, i without lesions; L lesions in all cases
//     hr_auc   1/(K1 K2)      sum_i sum_k psi(FP_i, highest of all marks of k): ROC inferred from the highest rating
//
// Nobody's marks at all give 0.5, and false marks alone 0: 0.5 is not chance.
enum class Merit { wafroc, wafroc1, afroc, hr_auc };
inline constexpr std::array<Merit, 4> kMerits{Merit::wafroc, Merit::wafroc1, Merit::afroc, Merit::hr_auc};
const char* name_of(Merit merit);  // as above

// The figure of one person under one condition, over the cases that this person judged, and without[k], the same without
// case k. NaN where it needs cases that are not there: without a case with lesions, or for all but wafroc1 without one that
// has none. Also NaN: without[k] of a case that was not judged.
struct MeritFigure {
    double all = 0.0;
    std::vector<double> without;  // by case
};
MeritFigure merit_of(const FreeResponse& data, std::size_t condition, std::size_t participant, Merit merit);

// One point of an FROC curve: NLs per case against the share of lesions with a rating of `rating` or higher.
struct FrocPoint {
    double rating = 0.0;
    double nlf = 0.0;
    double llf = 0.0;
};

// The points from the highest rating down; empty if nobody marked anything. `participant` nothing: all people pooled. The
// area under this curve is no figure of merit, because it grows with the number of false marks: it is a picture.
std::vector<FrocPoint> froc_curve(const FreeResponse& data, std::size_t condition,
                                  std::optional<std::size_t> participant);

// The share of lesions found at `nlf` false marks a case: on the straight lines between the points from (0, 0) on; beyond the
// last point that point's share. NaN without lesions.
double llf_at(const FreeResponse& data, std::size_t condition, std::optional<std::size_t> participant, double nlf);

}  // namespace palpa::study
