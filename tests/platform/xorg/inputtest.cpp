#include "tests/platform/xorg/inputtest.h"

#include <X11/extensions/XI2.h>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>
#include <xorg/xf86-input-inputtest-protocol.h>

namespace palpa::xorg {
namespace {

template <class Message>
Message new_message(xf86ITEventType type) {
    Message message{};
    message.header.length = sizeof message;
    message.header.type = type;
    return message;
}

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("inputtest: " + what + ": " + std::strerror(errno));
}

void send_all(int socket, const void* data, std::size_t size) {
    const char* next = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t sent = ::send(socket, next, size, MSG_NOSIGNAL);
        if (sent <= 0) fail("send");
        next += sent;
        size -= static_cast<std::size_t>(sent);
    }
}

template <class Message>
void send_message(int socket, const Message& message) {
    send_all(socket, &message, sizeof message);
}

template <class Message>
Message receive_message(int socket, const char* what) {
    Message message{};
    char* next = reinterpret_cast<char*>(&message);
    for (std::size_t left = sizeof message; left > 0;) {
        const ssize_t got = ::recv(socket, next, left, 0);
        if (got <= 0) fail(what);
        next += got;
        left -= static_cast<std::size_t>(got);
    }
    return message;
}

void set_axes(Axes axes, xf86ITValuatorData& data) {
    for (const auto& [number, value] : axes) {
        auto& byte = data.mask[number / 8];
        byte = static_cast<std::uint8_t>(byte | (1u << (number % 8)));
        data.valuators[number] = value;
        data.unaccelerated[number] = value;
    }
}

int connect_to(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) throw std::runtime_error("inputtest: path too long: " + path);
    std::memcpy(address.sun_path, path.c_str(), path.size());
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (socket < 0) fail("socket");
    const timeval limit{5, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        const int error = errno;
        ::close(socket);
        errno = error;
        fail("connect to " + path);
    }
    return socket;
}

void motion(int socket, bool absolute, Axes axes) {
    auto message = new_message<xf86ITEventMotion>(XF86IT_EVENT_MOTION);
    message.is_absolute = absolute ? 1 : 0;
    set_axes(axes, message.valuators);
    send_message(socket, message);
}

}  // namespace

InputDevice::InputDevice(const std::string& socket_path) : socket_(connect_to(socket_path)) {
    auto version = new_message<xf86ITEventClientVersion>(XF86IT_EVENT_CLIENT_VERSION);
    version.major = XF86IT_PROTOCOL_VERSION_MAJOR;
    version.minor = XF86IT_PROTOCOL_VERSION_MINOR;
    send_message(socket_, version);
    receive_message<xf86ITResponseServerVersion>(socket_, "no answer (is another client connected?)");
}

InputDevice::~InputDevice() { ::close(socket_); }

void InputDevice::move_to(Axes axes) { motion(socket_, true, axes); }

void InputDevice::move_by(Axes axes) { motion(socket_, false, axes); }

void InputDevice::button(int number, bool pressed, Axes axes) {
    auto message = new_message<xf86ITEventButton>(XF86IT_EVENT_BUTTON);
    message.is_absolute = 1;
    message.button = number;
    message.is_press = pressed ? 1 : 0;
    set_axes(axes, message.valuators);
    send_message(socket_, message);
}

void InputDevice::key(int code, bool pressed) {
    auto message = new_message<xf86ITEventKey>(XF86IT_EVENT_KEY);
    message.key_code = code;
    message.is_press = pressed ? 1 : 0;
    send_message(socket_, message);
}

void InputDevice::proximity(bool in, Axes axes) {
    auto message = new_message<xf86ITEventProximity>(XF86IT_EVENT_PROXIMITY);
    message.is_prox_in = in ? 1 : 0;
    set_axes(axes, message.valuators);
    send_message(socket_, message);
}

void InputDevice::touch(std::uint32_t id, Touch what, Axes axes) {
    auto message = new_message<xf86ITEventTouch>(XF86IT_EVENT_TOUCH);
    message.touchid = id;
    message.touch_type = what == Touch::begin ? XI_TouchBegin : what == Touch::update ? XI_TouchUpdate : XI_TouchEnd;
    set_axes(axes, message.valuators);
    send_message(socket_, message);
}

void InputDevice::sync() {
    send_message(socket_, new_message<xf86ITEventWaitForSync>(XF86IT_EVENT_WAIT_FOR_SYNC));
    receive_message<xf86ITResponseSyncFinished>(socket_, "no answer to a sync");
}

}  // namespace palpa::xorg
