#pragma once
// What the screens see of a soft device, filled from its model. For session/tangible_run*.cpp alone.

#include "devices/rig.h"
#include "session/tangible_run_sink.h"

namespace palpa::session {

// The nodes of the model that lie on the body's surface, at most kMostTangibleNodes, in the order of the file's nodes.
std::vector<int> surface_nodes(const tangible::TangiblePlan& plan);
// `rendered`: where TangibleMoment::rendered_N comes from.
TangibleBody body_of(const tangible::TangiblePlan& plan, const std::string& rendered);
// Allocates nothing.
void fill_shape(const tangible::TangiblePlan& plan, const std::vector<int>& nodes, const tangible::DeviceState& state,
                TangibleShape& out) noexcept;
void fill_moment(const TickRecord& record, const TangibleSink& sink, double rate_Hz, TangibleMoment& out);

// The wires of the device file, with the ports given instead of its own. Throws InputError.
devices::ActuatorRig tangible_rig(const tangible::DeviceModel& model, const std::vector<std::string>& ports);

}  // namespace palpa::session
