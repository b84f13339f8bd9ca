// What a trial advises, and where the guided start stands: both follow from what was pressed and marked.

#include <doctest/doctest.h>

#include "app/scene_choices.h"
#include "app/screens/screens.h"
#include "session/session.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::stiffnessmaps;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

struct Learner {
    Session session;
    double t_s = 1.0;

    explicit Learner(int rotate_deg = 0) {
        session.scene = load_scene("");
        session.scene.mapping.rotate_deg = rotate_deg;
        session.plan = std::make_shared<const Plan>(make_plan(session.scene));
        begin_trial({}, {1280, 800, kMissing, kMissing, "test"}, TrialMode::practice, session);
    }
    const Plan& plan() const { return *session.plan; }
    const Nodule& nodule(std::size_t i) const { return plan().nodules[i]; }
    void sample(Phase phase, const Eigen::Vector2d& p_m, double pressure, Action action = Action::none) {
        Sample s;
        s.t_host_s = t_s += 0.01;
        s.tool = Tool::pen;
        s.pointer_id = -2;
        s.phase = phase;
        const Eigen::Vector2d px = px_of_tissue(session.state.view, p_m);
        s.x_px = px.x();
        s.y_px = px.y();
        s.pressure = pressure;
        s.action = action;
        take_sample(s, session);
    }
    // Strokes from 6 mm on one side of a place to 6 mm on the other.
    void stroke(const Eigen::Vector2d& p_m, double pressure) {
        sample(Phase::down, p_m - Eigen::Vector2d(6e-3, 0.0), 0.1);
        for (int i = -12; i <= 12; ++i) sample(Phase::move, p_m + Eigen::Vector2d(0.5e-3 * i, 0.0), pressure);
        sample(Phase::up, p_m, 0.0);
    }
    void over(std::size_t i, double pressure) { stroke({nodule(i).x_m, nodule(i).y_m}, pressure); }
    void mark(const Eigen::Vector2d& p_m) { sample(Phase::ui, p_m, kMissing, Action::mark); }
    void find(std::size_t i) {
        over(i, 0.85);
        mark({nodule(i).x_m, nodule(i).y_m});
    }
    // Presses everywhere but within 40 mm of a place, deep enough.
    void examine(const Eigen::Vector2d& but_m = {1.0, 1.0}) {
        for (double y_m = 2e-3; y_m < 0.12; y_m += 4e-3) {
            for (double x_m = 1e-3; x_m < 0.119; x_m += 2e-3) {
                if ((Eigen::Vector2d(x_m, y_m) - but_m).norm() < 40e-3) continue;
                sample(Phase::down, {x_m, y_m}, 0.1);
                sample(Phase::move, {x_m, y_m}, 0.85);
                sample(Phase::up, {x_m, y_m}, 0.0);
            }
        }
    }
    std::string advice() {
        return advice_for(plan(), session.trial, debrief(plan(), session.trial), session.state.view);
    }
    GuidedStep step() const { return guided_step(plan(), session.trial); }
};

}  // namespace

TEST_CASE("advice: what was never touched comes first, named by its place on the screen") {
    Learner person;
    const Nodule& last = person.nodule(2);
    person.find(0);
    person.over(1, 0.02);
    // one region's name would say too little
    CHECK(contains(person.advice(), "You missed " + last.id + ": 9"));
    CHECK(contains(person.advice(), " % of the tissue was never examined"));
    person.examine({last.x_m, last.y_m});
    CHECK(contains(person.advice(), "You missed " + last.id + ": the "));
    CHECK(contains(person.advice(), "was never examined"));
    Learner turned(180);
    turned.find(0);
    turned.over(1, 0.02);
    turned.examine({last.x_m, last.y_m});
    CHECK(turned.advice() != person.advice());  // the same nodule lies on the other side
}

TEST_CASE("advice: too light, not marked, false positives, unexamined, all good") {
    Learner person;
    person.find(0);
    person.find(1);
    person.over(2, 0.02);
    CHECK(contains(person.advice(), "too lightly"));
    person.over(2, 0.85);
    CHECK(contains(person.advice(), "did not mark it"));
    person.mark({person.nodule(2).x_m, person.nodule(2).y_m});
    CHECK(contains(person.advice(), "a nodule there would have been missed"));
    person.mark(plain_place_m(person.plan()));
    CHECK(contains(person.advice(), "1 of 4 marks are on no nodule"));
    person.sample(Phase::ui, {0.0, 0.0}, kMissing, Action::undo);
    person.examine();
    CHECK(contains(person.advice(), "You found every nodule, and every mark is on a nodule"));
}

TEST_CASE("guided start: each step waits for what it asks for") {
    Learner person;
    CHECK(person.step() == GuidedStep::press);
    person.over(0, 0.85);  // not yet
    CHECK(person.step() == GuidedStep::press);
    person.stroke(plain_place_m(person.plan()), 0.85);
    CHECK(person.step() == GuidedStep::mark);  // the nodule was crossed before
    Learner other;
    other.stroke(plain_place_m(other.plan()), 0.85);
    CHECK(other.step() == GuidedStep::slide);
    other.over(0, 0.85);
    CHECK(other.step() == GuidedStep::mark);
    other.mark({other.nodule(0).x_m, other.nodule(0).y_m});
    CHECK(other.step() == GuidedStep::confidence);
    other.sample(Phase::ui, {0.0, 0.0}, kMissing, Action::confidence_4);
    CHECK(other.step() == GuidedStep::finish);
    other.sample(Phase::ui, {0.0, 0.0}, kMissing, Action::undo);
    CHECK(other.step() == GuidedStep::mark);
}

TEST_CASE("guided start: the plain place is far from every nodule") {
    const Learner person;
    const Eigen::Vector2d p_m = plain_place_m(person.plan());
    for (const Nodule& n : person.plan().nodules) CHECK((p_m - Eigen::Vector2d(n.x_m, n.y_m)).norm() > 0.02);
}
