#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace palpa::platform {

// A serial port, raw 8N1. read() blocks for `wait_s` at most; the class is meant for a thread of its own.
class SerialPort {
  public:
    // Throws std::runtime_error with the system's reason, and for a port that another SerialPort has (after a second);
    // InputError for a baud rate that is not supported.
    SerialPort(const std::string& path, int baud);
    ~SerialPort();
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    // Returns the number of bytes read, 0 if none came within `wait_s`, -1 once the device is gone (unplugged).
    int read(double wait_s, std::uint8_t* bytes, std::size_t room);
    // Writes all bytes, or returns false, also if the device takes none of them for `wait_s`.
    bool write(const std::uint8_t* bytes, std::size_t count, double wait_s = 1.0);

  private:
    int fd_ = -1;
};

}  // namespace palpa::platform
