#pragma once
// How far a long computation has come, on a terminal.

#include <string_view>

namespace palpa::files {

// One line on standard error that is written over: a bar, the share done and the time left. It appears once a second has
// passed, changes at most ten times a second, and is shown on a terminal only.
class ProgressLine {
  public:
    ProgressLine();
    ~ProgressLine();  // leaves no trace of the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // `share`: 0 to 1, NaN while it is not known. The time left counts from the first share that was known, so that work done
    // before the line began does not flatter it.
    void show(std::string_view what, double share);

  private:
    bool on_;
    bool shown_ = false;
    double began_s_;
    double last_s_ = 0.0;
    double first_share_ = -1.0;
    double first_s_ = 0.0;
};

}  // namespace palpa::files
