#include "platform/udp_port.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <netdb.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace palpa::platform {

UdpPort::UdpPort(const std::string& host, int port) {
    addrinfo wanted{};
    wanted.ai_family = AF_INET;
    wanted.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    const int reason = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
    if (reason != 0) throw std::runtime_error(host + ": is not known: " + ::gai_strerror(reason));
    fd_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const bool connected = fd_ >= 0 && ::connect(fd_, found->ai_addr, found->ai_addrlen) == 0;
    const std::string why = std::strerror(errno);
    ::freeaddrinfo(found);
    if (!connected) {
        if (fd_ >= 0) ::close(fd_);
        throw std::runtime_error(host + ": cannot be reached: " + why);
    }
    // holds a second of a 7 kHz stream (with the kernel's own overhead per datagram), in case this process gets no
    // processor
    const int room_bytes = 8 << 20;
    if (::setsockopt(fd_, SOL_SOCKET, SO_RCVBUFFORCE, &room_bytes, sizeof room_bytes) != 0) {  // root only
        ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &room_bytes, sizeof room_bytes);  // up to net.core.rmem_max
    }
}

UdpPort::~UdpPort() { ::close(fd_); }

bool UdpPort::send(const std::uint8_t* bytes, std::size_t count) {
    return ::send(fd_, bytes, count, 0) == static_cast<ssize_t>(count);
}

int UdpPort::receive(double wait_s, std::uint8_t* bytes, std::size_t room) {
    const ssize_t at_once = ::recv(fd_, bytes, room, MSG_DONTWAIT);
    if (at_once > 0 || wait_s <= 0.0) return at_once > 0 ? static_cast<int>(at_once) : 0;
    pollfd waiting{fd_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::ceil(1e3 * wait_s))) <= 0) return 0;
    const ssize_t n = ::recv(fd_, bytes, room, MSG_DONTWAIT);
    return n > 0 ? static_cast<int>(n) : 0;
}

}  // namespace palpa::platform
