#pragma once
// What a searching hand feels on a display that is not seen: pins and arm, a soft device, or a cast of the phantom.
//
// A place whose tissue is r times as stiff as that in its middle is felt as a press in the middle that is r times as stiff
// was displayed: such presses are tabulated. r follows from the tissue's own answer: the force at this place over the force
// that reaches the same depth in the middle.

#include <functional>
#include <vector>

#include "app/study/study_scenes.h"
#include "scene/state.h"
#include "study/simulated_person.h"
#include "study/simulated_touch.h"

namespace palpa::app {

// A cast of tissue that is so many times as stiff: the hand and the fingertip are told the truth.
study::FeltStiffness felt_by_hand(double ratio);

class FeltSearch {
  public:
    // Calls felt(r) for some r from 1/2 to 4. The plan of `scene` must outlive this.
    FeltSearch(const StudyScene& scene, const std::function<study::FeltStiffness(double)>& felt);

    // What is felt of the present contact: how deep the displayed surface lets the hand sink; nothing is seen.
    study::Sight sight(const scene::State& state) const;
    double felt_ln(double ratio) const;  // of what a place so many times as stiff is felt, less that of the middle
    double sd() const { return sd_; }    // noise of the senses

  private:
    double depth_in_middle_m(double force_N) const;
    double force_in_middle_N(double depth_m) const;

    std::vector<double> force_N_, depth_m_;   // in the middle of the tissue
    std::vector<double> ln_ratio_, felt_ln_;  // rising
    double sd_ = 1.0;
};

}  // namespace palpa::app
