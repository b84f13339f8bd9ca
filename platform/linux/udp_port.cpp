#include "platform/udp_port.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <netdb.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include "files/clock.h"

namespace palpa::platform {
namespace {

// The system stamps datagrams with the time of day. Its distance to the steady clock is taken now: a clock that is set
// in between spoils the few datagrams that are waiting, not more.
double arrival_of(msghdr& message) {
    const double now_s = files::steady_s();
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
        if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
        timespec today{};
        ::clock_gettime(CLOCK_REALTIME, &today);
        const double waited_s = static_cast<double>(today.tv_sec - stamp.tv_sec) +
                                1e-9 * static_cast<double>(today.tv_nsec - stamp.tv_nsec);
        constexpr double kLongest_s = 10.0;
        return waited_s >= 0.0 && waited_s < kLongest_s ? now_s - waited_s : now_s;
    }
    return now_s;
}

}  // namespace

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
    const int stamped = 1;
    ::setsockopt(fd_, SOL_SOCKET, SO_TIMESTAMPNS, &stamped, sizeof stamped);
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

int UdpPort::receive_at_once(std::uint8_t* bytes, std::size_t room, double& arrival_s) noexcept {
    iovec data{bytes, room};
    alignas(cmsghdr) char control[128];
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t n = ::recvmsg(fd_, &message, MSG_DONTWAIT);
    if (n <= 0) return 0;
    arrival_s = arrival_of(message);
    return static_cast<int>(n);
}

}  // namespace palpa::platform
