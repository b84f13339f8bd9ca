#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace palpa::platform {

// Datagrams to and from one address. The class is meant for a thread of its own.
class UdpPort {
  public:
    // Throws std::runtime_error with the system's reason.
    UdpPort(const std::string& host, int port);
    ~UdpPort();
    UdpPort(const UdpPort&) = delete;
    UdpPort& operator=(const UdpPort&) = delete;

    // Sends one datagram; returns false if the system did not take all of it.
    bool send(const std::uint8_t* bytes, std::size_t count);
    // Receives one datagram. Returns its number of bytes; 0 if none came within `wait_s`, or if nobody listens at the
    // address. With `wait_s` = 0 it takes only what has arrived already.
    int receive(double wait_s, std::uint8_t* bytes, std::size_t room);
    // Takes one datagram that has arrived, and when the system got it (steady clock). Returns 0 if there is none.
    int receive_at_once(std::uint8_t* bytes, std::size_t room, double& arrival_s) noexcept;

    int fd() const { return fd_; }  // to wait for it together with others

  private:
    int fd_ = -1;
};

}  // namespace palpa::platform
