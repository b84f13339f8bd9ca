#include "app/study/simulated_trial.h"

#include "scene/mapping.h"

namespace palpa::app {
namespace {

constexpr double kScreenWidth_px = 1280.0;
constexpr double kScreenHeight_px = 800.0;
constexpr double kNoLimit_s = 60.0;  // how long a simulated person searches without a limit in the protocol

// Makes the samples of a hand that presses with a given force at a place on the screen: the inverse of calibration and
// mapping.
class Hand {
  public:
    Hand(const study::Condition& condition, const session::Session& session)
        : profile_(session.plan->profile),
          view_(session.state.view),
          force_scale_(session.scene.force_scale),
          tool_(condition.modality == study::Modality::finger ? platform::Tool::finger : platform::Tool::pen) {}

    platform::Sample sample(double t_s, const study::ScreenPlace& at, double force_N, platform::Phase phase) const {
        platform::Sample out;
        out.t_host_s = out.t_device_s = t_s;
        out.pointer_id = 1;
        out.tool = tool_;
        out.phase = phase;
        place(at, view_.input_px_per_m, out);
        set_level(profile_, calibration::level_at_force(profile_, force_N / force_scale_), out);
        return out;
    }
    platform::Sample act(double t_s, const study::ScreenPlace& at, platform::Action action) const {
        platform::Sample out;
        out.t_host_s = out.t_device_s = t_s;
        out.tool = tool_;
        out.phase = platform::Phase::ui;
        place(at, view_.input_px_per_m, out);
        out.action = action;
        return out;
    }

  private:
    // the person's y axis points up, the screen's down
    void place(const study::ScreenPlace& at, const Eigen::Vector2d& px_per_m, platform::Sample& out) const {
        out.x_px = view_.centre_px.x() + at.x_m * px_per_m.x();
        out.y_px = view_.centre_px.y() - at.y_m * px_per_m.y();
    }

    const calibration::Profile& profile_;
    scene::View view_;
    double force_scale_;
    platform::Tool tool_;
};

double greatest_force_N(const session::Session& session) {
    std::int64_t clamped = 0;
    return session.scene.force_scale * force_N(session.plan->profile, session.plan->profile.level_highest, clamped);
}

// Returns what a person sees of the present state, or feels.
study::Sight sight_of(const FeltSearch* felt, const session::Session& session) {
    if (felt != nullptr) return felt->sight(session.state);
    return {scene::seen_lag_m(session.state.avatar), session.state.contact.depth_m, session.scene.surface.has_value()};
}

void palpate(study::SimulatedPerson& person, const Hand& hand, const SimulatedHand& of, session::Session& session) {
    const double dt_s = 1.0 / of.rate_Hz;
    for (std::int64_t i = 0; !session.trial.finished; ++i) {
        const double t_s = static_cast<double>(i) * dt_s;
        const study::Move made = study::move(dt_s, person);
        session::take_sample(
            hand.sample(t_s, made.at, made.force_N, made.began ? platform::Phase::down : platform::Phase::move),
            session);
        study::see(sight_of(of.felt, session), dt_s, person);
        if (made.deed == study::Deed::none) continue;
        if (made.deed == study::Deed::mark) {
            session::take_sample(hand.act(t_s, made.mark, platform::Action::mark), session);
            const int first = static_cast<int>(platform::Action::confidence_1) - 1;
            session::take_sample(hand.act(t_s, made.mark, static_cast<platform::Action>(first + made.confidence)),
                                 session);
        } else {
            session::take_sample(hand.sample(t_s, made.at, 0.0, platform::Phase::up), session);
            session::take_sample(hand.act(t_s, made.at, platform::Action::finish), session);
        }
    }
}

}  // namespace

platform::TraceInfo simulated_screen() {
    return {kScreenWidth_px, kScreenHeight_px, platform::kMissing, platform::kMissing, "simulated participant"};
}

void palpate_trial(const study::Protocol& protocol, const study::Condition& shown, int person,
                   const study::PlannedTrial& trial, const SimulatedHand& hand, session::Session& session) {
    const auto number = static_cast<std::uint64_t>(person);
    study::Random of_person(study::derived_seed(hand.seed, kTraits, number));
    study::PersonTraits traits = study::draw_person(session.plan->zone_N[1], greatest_force_N(session), of_person);
    if (hand.felt != nullptr) traits.dent_noise = hand.felt->sd();
    traits.lag_noise_m *= hand.noise;
    traits.dent_noise *= hand.noise;
    const double asked_s = trial.practice ? protocol.practice_limit_s : protocol.time_limit_s;
    const bool on_side = trial.rotate_deg % 180 != 0;
    const Eigen::Vector2d& size_m = session.plan->area.size_m;
    const std::uint64_t trials = study::derived_seed(hand.seed, kTrials, number);
    study::SimulatedPerson searcher =
        study::make_person(traits, on_side ? size_m.y() : size_m.x(), on_side ? size_m.x() : size_m.y(),
                           asked_s > 0.0 ? asked_s : kNoLimit_s,
                           study::derived_seed(trials, kTrials, static_cast<std::uint64_t>(trial.trial)));
    palpate(searcher, Hand(shown, session), hand, session);
}

study::TypedAnswers typed_answers(const scene::Plan& plan, const session::Trial& trial) {
    const study::Score score = session::debrief(plan, trial).score;
    study::TypedAnswers typed;
    for (const int mark : score.found_by) {
        const int confidence = mark >= 0 ? trial.marks[static_cast<std::size_t>(mark)].confidence : 0;
        typed.nodules.push_back(mark < 0 ? study::kMissed : confidence);
    }
    typed.false_marks = score.false_positives;
    typed.duration_s = session::clock_s(trial, trial.now_s);
    return typed;
}

}  // namespace palpa::app
