#include "app/study/felt_search.h"

#include <algorithm>
#include <cmath>

#include "scene/tissue.h"

namespace palpa::app {
namespace {

constexpr double kRatios[] = {0.5, 0.7071, 1.0, 1.4142, 2.0, 2.8284, 4.0};

// Linear between the points, constant beyond them. x: rising, not empty.
double table_value(const std::vector<double>& x, const std::vector<double>& y, double at) {
    if (!(at > x.front())) return y.front();
    if (at >= x.back()) return y.back();
    const auto above = std::upper_bound(x.begin(), x.end(), at);
    const auto i = static_cast<std::size_t>(above - x.begin());
    const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
    return y[i - 1] + share * (y[i] - y[i - 1]);
}

}  // namespace

study::FeltStiffness felt_by_hand(double ratio) {
    study::FeltStiffness felt;
    felt.by(study::Sense::hand) = felt.by(study::Sense::fingertip) = std::log(ratio);
    return felt;
}

FeltSearch::FeltSearch(const StudyScene& scene, const std::function<study::FeltStiffness(double)>& felt) {
    constexpr double kStep_N = 0.02, kMost_N = 8.0;
    scene::TissueWork work = make_work(scene.plan->tissue);
    scene::Press asked;
    asked.p_m = scene.plan->area.centre_m;
    asked.down = true;
    asked.stiffness_scale = scene.scene.stiffness_scale;
    for (double force_N = 0.0; force_N <= kMost_N; force_N += kStep_N) {
        asked.force_N = force_N;
        scene::Contact contact;
        answer(scene.plan->tissue, scene::StageId::depth, asked, work, contact);
        if (!depth_m_.empty() && !(contact.depth_m > depth_m_.back())) break;  // the end of what is known
        force_N_.push_back(force_N);
        depth_m_.push_back(contact.depth_m);
    }
    const study::TouchNoise noise;
    for (const double ratio : kRatios) {
        const study::FeltStiffness stiffness = felt(ratio);
        const double ln = study::joined_ln(stiffness, noise);
        if (!std::isfinite(ln)) continue;  // this stiffness cannot be displayed at all
        ln_ratio_.push_back(std::log(ratio));
        felt_ln_.push_back(ln);
        if (ratio <= 1.0) sd_ = study::perceived_sd(stiffness, noise);
    }
    if (ln_ratio_.empty()) return;
    const double middle = table_value(ln_ratio_, felt_ln_, 0.0);
    for (double& ln : felt_ln_) ln -= middle;
}

double FeltSearch::felt_ln(double ratio) const {
    return ln_ratio_.empty() ? 0.0 : table_value(ln_ratio_, felt_ln_, std::log(ratio));
}

double FeltSearch::depth_in_middle_m(double force_N) const { return table_value(force_N_, depth_m_, force_N); }
double FeltSearch::force_in_middle_N(double depth_m) const { return table_value(depth_m_, force_N_, depth_m); }

study::Sight FeltSearch::sight(const scene::State& state) const {
    study::Sight sight;
    sight.lag_shown = false;
    const double force_N = state.touch.down ? state.touch.force_N : 0.0;
    const double middle_N = force_in_middle_N(state.contact.depth_m);
    if (!(force_N > 0.0) || !(middle_N > 0.0)) return sight;
    sight.depth_m = depth_in_middle_m(force_N) * std::exp(-felt_ln(force_N / middle_N));
    sight.dent_shown = true;
    return sight;
}

}  // namespace palpa::app
