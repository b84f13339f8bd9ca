#pragma once
// Real-time priority for the calling thread, where the system grants it.

#include <pthread.h>
#include <sched.h>

namespace palpa::platform {

// Before all ordinary threads (SCHED_FIFO), or ordinary again. Returns whether it was granted.
inline bool set_real_time(bool wanted) noexcept {
    constexpr int kPriority = 10;
    sched_param parameter{};
    parameter.sched_priority = wanted ? kPriority : 0;
    return ::pthread_setschedparam(::pthread_self(), wanted ? SCHED_FIFO : SCHED_OTHER, &parameter) == 0;
}

}  // namespace palpa::platform
