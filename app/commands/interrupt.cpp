#include "app/commands/interrupt.h"

#include <csignal>

namespace palpa::app {
namespace {

constexpr int kSignals[3] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t interrupted = 0;

}  // namespace

Interrupt::Interrupt() {
    interrupted = 0;
    for (int i = 0; i < 3; ++i) {
        before_[i] = std::signal(kSignals[i], [](int) { interrupted = 1; });
        if (kSignals[i] == SIGHUP && before_[i] == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
    }
}

Interrupt::~Interrupt() {
    for (int i = 0; i < 3; ++i) std::signal(kSignals[i], before_[i]);
}

bool Interrupt::came() const noexcept { return interrupted != 0; }

}  // namespace palpa::app
