#include "files/progress_line.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unistd.h>

#include "files/clock.h"

namespace palpa::files {

ProgressLine::ProgressLine() : on_(::isatty(STDERR_FILENO) == 1), began_s_(steady_s()) {}

ProgressLine::~ProgressLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::show(std::string_view what, double share) {
    if (!on_) return;
    const double now_s = steady_s();
    const bool known = std::isfinite(share);
    if (known && first_share_ < 0.0) {
        first_share_ = share;
        first_s_ = now_s;
    }
    if (now_s - began_s_ < 1.0 || now_s - last_s_ < 0.1) return;
    last_s_ = now_s;
    shown_ = true;
    std::fprintf(stderr, "\r\033[K%.*s", static_cast<int>(what.size()), what.data());
    if (known) {
        constexpr int kBar = 30;
        const int bars = std::clamp(static_cast<int>(kBar * share), 0, kBar);
        std::fprintf(stderr, " [%.*s%*s] %.0f %%", bars, "##############################", kBar - bars, "",
                     100.0 * share);
        const double gained = share - first_share_;
        if (gained > 0.0) std::fprintf(stderr, ", %.0f s left", (now_s - first_s_) * (1.0 - share) / gained);
    } else {
        std::fputs(" ...", stderr);
    }
    std::fflush(stderr);
}

}  // namespace palpa::files
