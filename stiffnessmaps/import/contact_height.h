#pragma once
// Where a place's force begins, of recordings whose depth comes from z.

#include <vector>

namespace palpa::stiffnessmaps {

struct ProbedPoint;

// Returns four standard deviations of the force in the air, from the first two rows of each place, or 1 % of the median of
// the places' greatest forces, whichever is more.
double contact_threshold_N(const std::vector<ProbedPoint>& points);

struct ContactHeights {
    std::vector<double> air_N;      // of each place: the median force of the rows in the air
    std::vector<double> contact_m;  // of each place: depth as it stands at which the force begins; NaN if it never does
    double exponent = 1.0;          // of force over depth there
    double rows_in_air = 0.0;       // of the median place, before it touches for sure
};

// Finds where the forces begin. A place is surely in contact from the first of two rows on whose force, less that in the air,
// exceeds the threshold. Up to ten thresholds, and over the rows in the air, force is taken as 0 before the contact and as
// a (d - contact)^n from there on, n one of 1, 1.25 ... 2 for all places, by least squares; 1.5 where fewer than four rows of a
// place touch, which do not tell it. Source of the law: 1 for a flat punch, 1.5 for a sphere, 2 for a cone (Johnson, Contact
// Mechanics, chapters 3 to 5).
ContactHeights find_contacts(const std::vector<ProbedPoint>& points, double threshold_N);

}  // namespace palpa::stiffnessmaps
