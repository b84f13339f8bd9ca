#pragma once
// Real-time priority where the system grants it.

#include <sched.h>

namespace palpa::devices::simulators {

inline bool ask_for_real_time() {
    sched_param priority{};
    priority.sched_priority = 10;
    return ::sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
}

}  // namespace palpa::devices::simulators
