#pragma once
// A person who ends a long command by Ctrl-C keeps what it has done so far.

namespace palpa::app {

// What the figures of such a command say then, and standard error: nobody shall take a part for the whole.
inline constexpr const char* kCut = "stopped by a signal before the press was over: the figures are of its beginning";

// While one lives, SIGINT, SIGTERM and SIGHUP do not end the program: they are remembered. Under nohup SIGHUP stays ignored.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    bool came() const noexcept;

  private:
    void (*before_[3])(int);
};

}  // namespace palpa::app
