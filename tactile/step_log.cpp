#include "tactile/step_log.h"

#include "files/text.h"

namespace palpa::tactile {
namespace {

constexpr std::int64_t kPinsEvery = 20;  // steps

// One list of fields writes the header and every row.
template <class Visit>
void visit_step(const LoopCommand& step, Visit&& visit) {
    visit("time_s", step.time_s);
    visit("x_mm", 1e3 * step.x_m);
    visit("y_mm", 1e3 * step.y_m);
    visit("depth_mm", 1e3 * step.depth_m);
    visit("force_N", step.force_N);
    visit("pressed", step.pressed ? 1.0 : 0.0);
    visit("held", step.held ? 1.0 : 0.0);
    visit("over_edge", step.over_edge ? 1.0 : 0.0);
    visit("inexact", step.inexact ? 1.0 : 0.0);
    visit("linearity", step.linearity);
    visit("shape_scale", step.shape_scale);
    visit("clipped", static_cast<double>(step.clipped));
}

template <class Visit>
void visit_pins(const LoopCommand& step, Visit&& visit) {
    visit("wanted_mm_", step.wanted_m);
    visit("commanded_mm_", step.pins_m);
    visit("estimated_mm_", step.reached_m);
}

std::string pin_columns(Eigen::Index pins) {
    std::string text = "time_s";
    visit_pins({}, [&](const char* name, const auto&) {
        for (Eigen::Index i = 1; i <= pins; ++i) text += std::string("\t") + name + std::to_string(i);
    });
    return text + "\n";
}

}  // namespace

StepLog::StepLog(const std::filesystem::path& folder, const TactilePlan& plan) : steps_(folder / "steps.tsv") {
    visit_step({}, [&](const char* name, double) { text_.append(text_.empty() ? "" : "\t").append(name); });
    steps_.append(text_.append("\n"));
    if (!plan.pins) return;
    pins_.emplace(folder / "pins.tsv");
    pins_->append(pin_columns(plan.pins->pin_m.cols()));
}

void StepLog::write(const LoopCommand& step) {
    text_.clear();
    visit_step(step, [&](const char*, double value) {
        if (!text_.empty()) text_.push_back('\t');
        files::append_number(value, text_);
    });
    steps_.append(text_.append("\n"));
    if (pins_ && written_ % kPinsEvery == 0) {
        text_.clear();
        files::append_number(step.time_s, text_);
        visit_pins(step, [&](const char*, const auto& heights_m) {
            for (std::size_t i = 0; i < static_cast<std::size_t>(step.pins); ++i) {
                text_.push_back('\t');
                files::append_number(1e3 * heights_m[i], text_);
            }
        });
        pins_->append(text_.append("\n"));
    }
    ++written_;
}

bool StepLog::sync() {
    const bool steps = steps_.sync();
    return (!pins_ || pins_->sync()) && steps;
}

}  // namespace palpa::tactile
