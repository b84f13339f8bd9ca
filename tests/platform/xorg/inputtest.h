#pragma once
// A client of Xorg's inputtest driver: makes a pen, a touch screen or a mouse of the X server do something.

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

namespace palpa::xorg {

using Axes = std::initializer_list<std::pair<int, double>>;  // number, value in the device's counts

// A connection to one device's socket. The driver takes one in the server's life; a second one would hang,
// so every wait ends after 5 s. Throws std::runtime_error.
class InputDevice {
  public:
    explicit InputDevice(const std::string& socket_path);
    ~InputDevice();
    InputDevice(const InputDevice&) = delete;
    InputDevice& operator=(const InputDevice&) = delete;

    void move_to(Axes axes);
    void move_by(Axes axes);
    void button(int number, bool pressed, Axes axes);
    void key(int code, bool pressed);  // X keycode
    void proximity(bool in, Axes axes);
    enum class Touch : std::uint8_t { begin, update, end };
    void touch(std::uint32_t id, Touch what, Axes axes);

    // Returns when the server has dealt with all events so far. Without it the server merges motions.
    void sync();

  private:
    int socket_ = -1;
};

}  // namespace palpa::xorg
