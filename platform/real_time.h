#pragma once
// Real-time priority for the calling thread, where the system grants it.

#include <pthread.h>
#include <sched.h>

namespace palpa::platform {

// A guard comes before the loop that it watches, which may compute for long.
constexpr int kLoopPriority = 10;
constexpr int kGuardPriority = 12;

// Before all ordinary threads (SCHED_FIFO), or ordinary again. Returns whether it was granted.
inline bool set_real_time(bool wanted, int priority = kLoopPriority) noexcept {
    sched_param parameter{};
    parameter.sched_priority = wanted ? priority : 0;
    return ::pthread_setschedparam(::pthread_self(), wanted ? SCHED_FIFO : SCHED_OTHER, &parameter) == 0;
}

}  // namespace palpa::platform
