#pragma once
// Scores marks against the places that were to be found.

#include <span>
#include <string>
#include <vector>

namespace palpa::study {

// One place to find: a disc, or a rod with round ends if it is longer than its diameter.
struct Target {
    std::string id;
    double x_m = 0.0;
    double y_m = 0.0;
    double diameter_m = 0.0;
    double length_m = 0.0;   // along the angle, ends included; up to the diameter it is a disc
    double angle_rad = 0.0;  // counter-clockwise from +x
};

struct MarkedPlace {
    double x_m = 0.0;
    double y_m = 0.0;
};

// again: the mark is on a target that another mark found; it is neither a hit nor a false mark.
enum class MarkKind { hit, again, false_mark };

struct MarkScore {
    MarkKind kind = MarkKind::false_mark;
    int target = -1;          // the target that was found, or found again; else the nearest, -1 if there is none
    double distance_m = 0.0;  // from that target's axis or centre
};

struct Score {
    std::vector<MarkScore> marks;  // in the order of the marks
    std::vector<int> found_by;     // by target: index of the mark, -1: missed
    int true_positives = 0;
    int false_positives = 0;
    int false_negatives = 0;
    double sensitivity = 0.0;  // TP / (TP + FN); NaN if there is nothing to find
    double ppv = 0.0;          // TP / (TP + FP); NaN without marks
};

// Returns how far from a target's axis a mark still finds it: the target's diameter or 8 mm, whichever is larger. One
// lesion diameter is the usual rule for marks on images; hands err by 5 to 7 mm however small the lump (Front. Robot.
// AI 2021, 745234).
double acceptance_radius_m(const Target& target);

// Returns the distance from a mark to the axis of a rod or the centre of a disc.
double distance_m(const Target& target, const MarkedPlace& mark);

// Matches marks to targets: each mark finds at most one target and each target is found by at most one mark. As many
// targets as possible are found and, among the ways to find so many, the sum of the distances is least.
Score score_marks(std::span<const Target> targets, std::span<const MarkedPlace> marks);

}  // namespace palpa::study
