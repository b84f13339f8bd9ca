#pragma once
// The time as a count that never goes back, and the time of day as text.

#include <cstdint>
#include <ctime>
#include <string>

namespace palpa::files {

// The steady clock, which the samples' t_host_s uses too. Only differences have a meaning.
std::int64_t steady_ns();
double steady_s();

// Returns UTC as "2026-11-21T09:30:00Z"; the first ten characters are the date.
std::string utc_text(std::time_t time);
std::string utc_now();

}  // namespace palpa::files
