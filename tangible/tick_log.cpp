#include "tangible/tick_log.h"

#include <cmath>

#include "files/text.h"

namespace palpa::tangible {
namespace {

void append_value(double value, std::string& text) {
    text.push_back('\t');
    if (std::isfinite(value))
        files::append_number(value, text);
    else
        text += "n/a";
}

bool is_cable(const SoftActuator& actuator) { return actuator.kind == ActuatorKind::cable; }

}  // namespace

std::string tick_columns(const DeviceModel& model) {
    std::string text = "time_s\tdepth_mm\twanted_N\tforce_N\tworld_depth_mm";
    for (const SoftActuator& a : model.actuators) text += "\t" + a.name + "_" + unit_of(a.kind);
    for (const SoftActuator& a : model.actuators) text += "\t" + a.name + (is_cable(a) ? "_mm" : "_mm3");
    return text + "\tresidual_mm\tsaturated\theld\trelaxed\tby_length\n";
}

void append_tick(const DeviceModel& model, CommandKind command, const TangibleCommand& tick, double depth_m,
                 double wanted_N, double rendered_N, std::string& text) {
    files::append_number(tick.time_s, text);
    append_value(1e3 * depth_m, text);
    append_value(wanted_N, text);
    append_value(rendered_N, text);
    append_value(1e3 * tick.world_depth_m, text);
    for (std::size_t j = 0; j < model.actuators.size(); ++j) append_value(tick.actuation[j], text);
    for (std::size_t j = 0; j < model.actuators.size(); ++j)
        append_value((is_cable(model.actuators[j]) ? 1e3 : -1e9) * tick.length[j], text);
    append_value(1e3 * tick.residual_m, text);
    for (const bool flag : {tick.saturated, tick.held, tick.relaxed, command != CommandKind::force})
        text += flag ? "\t1" : "\t0";
    text.push_back('\n');
}

TickLog::TickLog(const std::filesystem::path& folder, const DeviceModel& model, CommandKind command)
    : model_(model), command_(command), file_(folder / "ticks.tsv") {
    file_.append(tick_columns(model));
}

void TickLog::write(const TangibleCommand& tick, double rendered_N) {
    text_.clear();
    append_tick(model_, command_, tick, tick.depth_m, tick.wanted_N, rendered_N, text_);
    file_.append(text_);
}

}  // namespace palpa::tangible
