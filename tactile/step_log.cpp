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

StepLog::StepLog(const std::filesystem::path& folder, const TactilePlan& plan)
    : plan_(plan), steps_(folder / "steps.tsv") {
    visit_step({}, [&](const char* name, double) { text_.append(text_.empty() ? "" : "\t").append(name); });
    steps_.append(text_.append("\n"));
    if (plan.pins) {
        pins_.emplace(folder / "pins.tsv");
        pins_->append(pin_columns(plan.pins->pin_m.cols()));
    }
    if (plan.pressure_m.cols() == 0) return;
    pressures_.emplace(folder / "pressures.tsv");
    work_ = make_work(plan.renderer);
    pressure_Pa_.setZero(plan.pressure_m.cols());
    text_ = "time_s";
    for (Eigen::Index i = 1; i <= pressure_Pa_.size(); ++i) text_ += "\tpressure_Pa_" + std::to_string(i);
    pressures_->append(text_.append("\n"));
}

void StepLog::write_pins(const LoopCommand& step) {
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

void StepLog::write_pressures(const LoopCommand& step) {
    press_with_force(plan_.renderer, Eigen::Vector2d(step.x_m, step.y_m), step.force_N, work_);
    pressure_Pa(plan_.renderer, work_, plan_.pressure_m, pressure_Pa_);
    text_.clear();
    files::append_number(step.time_s, text_);
    for (const double value : pressure_Pa_) {
        text_.push_back('\t');
        files::append_number(value, text_);
    }
    pressures_->append(text_.append("\n"));
}

void StepLog::write(const LoopCommand& step) {
    text_.clear();
    visit_step(step, [&](const char*, double value) {
        if (!text_.empty()) text_.push_back('\t');
        files::append_number(value, text_);
    });
    steps_.append(text_.append("\n"));
    if (pins_ && written_ % kPinsEvery == 0) write_pins(step);
    if (pressures_ && written_ % kPinsEvery == 0) write_pressures(step);
    ++written_;
}

bool StepLog::sync() {
    bool good = steps_.sync();
    for (auto* file : {&pins_, &pressures_}) {
        if (*file) good = (*file)->sync() && good;
    }
    return good;
}

}  // namespace palpa::tactile
