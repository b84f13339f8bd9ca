#include "platform/serial_port.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <poll.h>
#include <stdexcept>
#include <sys/file.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "files/input_error.h"

namespace palpa::platform {
namespace {

speed_t speed_of(int baud) {
    const std::map<int, speed_t> known{{9600, B9600},     {19200, B19200},    {38400, B38400},   {57600, B57600},
                                       {115200, B115200}, {230400, B230400},  {460800, B460800}, {500000, B500000},
                                       {921600, B921600}, {1000000, B1000000}};
    const auto it = known.find(baud);
    if (it == known.end())
        throw files::bad_input("--baud", "", std::to_string(baud), "9600, 19200, 38400, 57600, 115200, ... 1000000");
    return it->second;
}

// Two programs on one line would each get some of the replies, and move one device against each other. A program that has just
// ended may still let its device go.
bool locked(int fd) {
    constexpr int kTries = 50;
    for (int i = 0; i < kTries; ++i) {
        if (::flock(fd, LOCK_EX | LOCK_NB) == 0) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud) {
    const speed_t speed = speed_of(baud);
    fd_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd_ < 0) throw std::runtime_error(path + ": cannot be opened: " + std::strerror(errno));
    termios settings{};
    if (::tcgetattr(fd_, &settings) != 0) {
        ::close(fd_);
        throw std::runtime_error(path + ": is not a serial port");
    }
    if (!locked(fd_)) {
        ::close(fd_);
        throw std::runtime_error(path + ": is used by another program");
    }
    ::cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    ::cfsetspeed(&settings, speed);
    ::tcsetattr(fd_, TCSANOW, &settings);
    ::tcflush(fd_, TCIFLUSH);  // what came before nobody has asked for, and its time is not known
}

SerialPort::~SerialPort() { ::close(fd_); }

int SerialPort::read(double wait_s, std::uint8_t* bytes, std::size_t room) {
    pollfd waiting{fd_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(std::ceil(1e3 * wait_s)));
    if (ready == 0 || (ready < 0 && errno == EINTR)) return 0;
    const ssize_t n = ::read(fd_, bytes, room);
    if (n > 0) return static_cast<int>(n);
    if (n < 0 && (errno == EAGAIN || errno == EINTR) && (waiting.revents & (POLLHUP | POLLERR)) == 0) return 0;
    return -1;
}

bool SerialPort::write(const std::uint8_t* bytes, std::size_t count, double wait_s) {
    while (count > 0) {
        const ssize_t n = ::write(fd_, bytes, count);
        if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
            pollfd waiting{fd_, POLLOUT, 0};
            if (::poll(&waiting, 1, static_cast<int>(std::ceil(1e3 * wait_s))) <= 0) return false;
            continue;
        }
        if (n <= 0) return false;
        bytes += n;
        count -= static_cast<std::size_t>(n);
    }
    return true;
}

}  // namespace palpa::platform
