#include "stiffnessmaps/import/probing_curve.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/contact_height.h"
#include "stiffnessmaps/import/probing.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

void erase_row(ProbedPoint& p, std::size_t i) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    p.depth_m.erase(p.depth_m.begin() + at);
    p.force_N.erase(p.force_N.begin() + at);
    for (auto& lateral : p.lateral_N) {
        if (!lateral.empty()) lateral.erase(lateral.begin() + at);
    }
}

void reject_outliers(Probing& probing, double deviations, ImportReport& report) {
    std::vector<double> differences;
    std::vector<double> greatest_N;
    for (const ProbedPoint& p : probing.points) {
        add_fourth_differences(p.force_N, differences);
        greatest_N.push_back(*std::max_element(p.force_N.begin(), p.force_N.end()));
    }
    // a sensor that counts in steps may show no noise
    const double least_N = 1e-3 * std::abs(median(std::move(greatest_N)));
    const double limit_N = deviations * std::max(noise_of_fourth_differences(std::move(differences)), least_N);
    for (ProbedPoint& p : probing.points) {
        const std::vector<bool> outlier = lone_outliers(p.force_N, limit_N);
        for (std::size_t i = outlier.size(); i-- > 0;) {
            if (!outlier[i]) continue;
            erase_row(p, i);
            ++report.outliers;
            ++report.rejected_rows;
        }
    }
}

// Counts depth and force from the first row. Returns the force of that row.
double start_at_first_row(ProbedPoint& p) {
    const double depth_m = p.depth_m.front();
    const double force_N = p.force_N.front();
    for (double& d : p.depth_m) d -= depth_m;
    for (double& f : p.force_N) f -= force_N;
    p.z_m = -depth_m;
    return force_N;
}

// Takes depth and force as they stand, with the contact, 0 N at depth 0, before the first row below it.
void start_at_surface(ProbedPoint& p) {
    while (!p.depth_m.empty() && !(p.depth_m.front() > 0.0)) erase_row(p, 0);
    p.depth_m.insert(p.depth_m.begin(), 0.0);
    p.force_N.insert(p.force_N.begin(), 0.0);
    for (auto& lateral : p.lateral_N) {
        if (!lateral.empty()) lateral.insert(lateral.begin(), 0.0);
    }
}

// Counts each place's depth from where its force begins, and its force from that in the air, which is returned. Places whose
// force never begins are emptied.
std::vector<double> start_at_contact(Probing& probing, const ContactHeights& contacts) {
    for (std::size_t i = 0; i < probing.points.size(); ++i) {
        ProbedPoint& p = probing.points[i];
        const double contact_m = contacts.contact_m[i];
        if (std::isnan(contact_m)) {
            p.depth_m.clear();
            p.force_N.clear();
            continue;
        }
        for (double& d : p.depth_m) d -= contact_m;
        for (double& f : p.force_N) f -= contacts.air_N[i];
        start_at_surface(p);
        p.z_m = -contact_m;
    }
    return contacts.air_N;
}

const char* name_of(ContactStart contact) {
    return contact == ContactStart::first_row ? "first-row" : contact == ContactStart::given ? "given" : "threshold";
}

constexpr const char* kWhatDepthsCountFrom =
    "--contact given (depths and forces count from the surface as they stand), "
    "--contact first-row (they count from the first row) or --contact threshold (they begin in the "
    "air, and contact is where the force begins)";

// Throws InputError for depths whose first row is far from 0: nothing tells whether it is the contact.
void check_first_rows(const Probing& probing, const std::string& file) {
    std::vector<double> first_m;
    std::vector<double> step_m;
    for (const ProbedPoint& p : probing.points) {
        first_m.push_back(p.depth_m[0]);
        step_m.push_back(p.depth_m[1] - p.depth_m[0]);
    }
    constexpr double kNear_m = 1e-4;
    const double begins_m = median(std::move(first_m));
    if (std::abs(begins_m) <= std::max(kNear_m, 0.5 * median(std::move(step_m)))) return;
    throw files::bad_input(file, "depth",
                           "depths that begin at " + files::short_number(1e3 * begins_m) + " mm (median)",
                           std::string("0 at contact, or ") + kWhatDepthsCountFrom);
}

// Empties places that begin deeper than the others by three quarters of a step or more, if they are a few: their first row,
// the contact, is missing, and counted from the next one they would seem softer. Returns how many. Throws InputError for more.
std::size_t leave_out_late_starts(Probing& probing, const std::string& file) {
    constexpr double kNear_m = 1e-4, kShareOfStep = 0.75, kFew = 0.1;
    std::vector<double> first_m;
    std::vector<double> step_m;
    for (const ProbedPoint& p : probing.points) {
        first_m.push_back(p.depth_m[0]);
        step_m.push_back(p.depth_m[1] - p.depth_m[0]);
    }
    const double latest_m = median(std::move(first_m)) + std::max(kNear_m, kShareOfStep * median(std::move(step_m)));
    const auto late = [&](const ProbedPoint& p) { return p.depth_m[0] > latest_m; };
    const auto n = static_cast<std::size_t>(std::count_if(probing.points.begin(), probing.points.end(), late));
    if (static_cast<double>(n) > kFew * static_cast<double>(probing.points.size()))
        throw files::bad_input(
            file, "depth",
            std::to_string(n) + " of " + std::to_string(probing.points.size()) + " places that begin deeper than " +
                files::short_number(1e3 * latest_m) + " mm",
            std::string("the contact as the first row of nine tenths of them, or ") + kWhatDepthsCountFrom);
    std::erase_if(probing.points, late);
    return n;
}

// Returns the slopes (b, c) of the plane z = a + b x + c y through the contact heights.
Eigen::Vector2d contact_slope(const Probing& probing) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const ProbedPoint& p : probing.points) middle += Eigen::Vector3d(p.x_m, p.y_m, p.z_m);
    middle /= static_cast<double>(probing.points.size());
    for (const ProbedPoint& p : probing.points) {
        const Eigen::Vector3d row(1.0, p.x_m - middle.x(), p.y_m - middle.y());
        A += row * row.transpose();
        right += row * (p.z_m - middle.z());
    }
    A.diagonal().tail<2>().array() += 1e-12;  // a single line of places has no slope across it
    return A.ldlt().solve(right).tail<2>();
}

void remove_tilt(Probing& probing, MapSource& source) {
    const Eigen::Vector2d slope = contact_slope(probing);
    const double length = std::sqrt(1.0 + slope.squaredNorm());
    for (ProbedPoint& p : probing.points) {
        for (std::size_t i = 0; i < p.depth_m.size(); ++i) {
            p.depth_m[i] /= length;
            if (p.lateral_N[0].empty()) continue;
            const double lateral = slope.x() * p.lateral_N[0][i] + slope.y() * p.lateral_N[1][i];
            p.force_N[i] = (p.force_N[i] - lateral) / length;
        }
    }
    const double tilt_deg = std::atan(slope.norm()) * 180.0 / std::numbers::pi;
    add_choice(source, "tilt_removed_deg", std::round(1e3 * tilt_deg) / 1e3, "plane through the contact heights",
               "--tilt keep");
}

}  // namespace

void clean_curves(Probing& probing, const ImportOptions& options, const std::string& file, MapSource& source,
                  ImportReport& report) {
    constexpr double kOutliers = 20.0;
    const double deviations = options.outliers.value_or(kOutliers);
    if (deviations > 0.0) reject_outliers(probing, deviations, report);
    add_choice(source, "outliers_deviations", deviations,
               "a single force that far outside the range of the two beside it; " + std::to_string(report.outliers) +
                   " left out",
               "--outliers", options.outliers.has_value());

    const ContactStart contact =
        options.contact.value_or(probing.depth_from_z ? ContactStart::threshold : ContactStart::first_row);
    std::size_t late = 0;
    if (!options.contact && !probing.depth_from_z) {
        check_first_rows(probing, file);
        late = leave_out_late_starts(probing, file);
    }
    for (ProbedPoint& p : probing.points) {
        for (auto& lateral : p.lateral_N) {  // the lateral force counts from its first row, too
            for (std::size_t i = lateral.size(); i-- > 0;) lateral[i] -= lateral[0];
        }
    }
    std::vector<double> offsets_N;
    double threshold_N = 0.0;
    ContactHeights contacts;
    if (contact == ContactStart::threshold) {
        threshold_N = options.contact_force_N.value_or(contact_threshold_N(probing.points));
        contacts = find_contacts(probing.points, threshold_N);
        constexpr double kFewestInAir = 4.0;  // what three rows show may be tissue already
        if (contacts.rows_in_air < kFewestInAir)
            throw files::bad_input(
                file, "contact",
                files::short_number(contacts.rows_in_air) + " rows before the contact (median of the places)",
                "four at least in the air, which show the force at rest and where contact begins; "
                "or --contact first-row (depths and forces count from the first row) or given");
        offsets_N = start_at_contact(probing, contacts);
    }
    for (ProbedPoint& p : probing.points) {
        if (contact == ContactStart::first_row) offsets_N.push_back(start_at_first_row(p));
        if (contact == ContactStart::given) start_at_surface(p);
    }
    report.median_offset_N = median(offsets_N);
    std::erase_if(probing.points, [](const ProbedPoint& p) { return p.depth_m.size() < 2; });
    add_choice(source, "contact", name_of(contact),
               probing.depth_from_z ? "depth comes from z, the surface must be found"
                                    : "the recording has depths: its robot had found the surface; places left out that "
                                      "begin deeper: " +
                                          std::to_string(late),
               "--contact", options.contact.has_value());
    if (contact == ContactStart::threshold) {
        add_choice(source, "contact_force_N", threshold_N,
                   "4 deviations of the force in the air, or 1 % of the greatest: above it a place touches for sure",
                   "--contact-force-N", options.contact_force_N.has_value());
        add_choice(source, "contact_exponent", contacts.exponent,
                   "of force over depth from the contact to ten times that force, for all places", "");
    }
    if (probing.depth_from_z && options.remove_tilt && !probing.points.empty()) remove_tilt(probing, source);
}

double force_at(const ProbedPoint& p, double depth_m, double step_m) {
    const auto& d = p.depth_m;
    if (depth_m > d.back() + 0.05 * step_m) return std::numeric_limits<double>::quiet_NaN();
    std::size_t i = 1;
    while (i + 1 < d.size() && d[i] < depth_m) ++i;
    const double s = (depth_m - d[i - 1]) / (d[i] - d[i - 1]);
    return p.force_N[i - 1] + s * (p.force_N[i] - p.force_N[i - 1]);
}

}  // namespace palpa::stiffnessmaps
