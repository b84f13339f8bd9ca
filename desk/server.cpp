#include "desk/server.h"

#include <arpa/inet.h>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <functional>
#include <stdexcept>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "desk/pairing.h"

namespace palpa::desk {
namespace {

constexpr int kBacklog = 128;

// Starts threads as they are needed, up to a number. When as many connections wait, the accepting thread waits too, and
// further clients wait in the queue of the system.
class ConnectionQueue : public httplib::TaskQueue {
  public:
    explicit ConnectionQueue(std::size_t most) : most_(most) {}

    void enqueue(std::function<void()> work) override {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return waiting_.size() < most_; });
        waiting_.push_back(std::move(work));
        if (idle_ < waiting_.size() && threads_.size() < most_) threads_.emplace_back([this] { serve(); });
        work_.notify_one();
    }

    void shutdown() override {
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        work_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }

  private:
    void serve() {
        std::unique_lock lock(mutex_);
        while (true) {
            ++idle_;
            work_.wait(lock, [&] { return done_ || !waiting_.empty(); });
            --idle_;
            if (waiting_.empty()) return;
            const std::function<void()> work = std::move(waiting_.front());
            waiting_.pop_front();
            room_.notify_one();
            lock.unlock();
            work();
            lock.lock();
        }
    }

    std::size_t most_;
    std::mutex mutex_;
    std::condition_variable work_, room_;
    std::deque<std::function<void()>> waiting_;
    std::vector<std::thread> threads_;
    std::size_t idle_ = 0;
    bool done_ = false;
};

}  // namespace

DeskServer::DeskServer(TlsContext tls, const Patience& patience, const Places& places)
    : tls_(std::move(tls)), patience_(patience), places_(places) {
    new_task_queue = [this] { return new ConnectionQueue(places_.in_all); };
    set_keep_alive_max_count(static_cast<std::size_t>(places_.requests));
    set_keep_alive_timeout(static_cast<time_t>(patience_.idle_s));
    // not SO_REUSEPORT, the library's default: two desks on one port would share the tablets at random
    set_socket_options([](socket_t socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
}

int DeskServer::bind(const std::string& address, int port) {
    errno = 0;
    const bool bound = port > 0 ? bind_to_port(address, port) : (port = bind_to_any_port(address)) > 0;
    if (!bound) {
        throw std::runtime_error(address + ", port " + std::to_string(port < 0 ? 0 : port) + ": cannot be listened on" +
                                 (errno != 0 ? std::string(": ") + std::strerror(errno) : std::string()));
    }
    ::listen(svr_sock_, kBacklog);  // the queue that the library asks for has five places
    listening_ = ::fcntl(svr_sock_, F_DUPFD_CLOEXEC, 0);
    if (listening_ < 0) throw std::runtime_error(address + ": cannot be listened on: " + std::strerror(errno));
    return port;
}

// The library's stop() has no effect on a server that does not accept yet. A socket that was shut down accepts nothing,
// whether the server waits on it already or only later.
void DeskServer::end() {
    ending_ = true;
    ::shutdown(listening_, SHUT_RDWR);
    ::close(listening_);  // one descriptor is free now: without any, accept() would be tried again and again
    listening_ = -1;
}

DeskServer::~DeskServer() {
    if (listening_ >= 0) ::close(listening_);
}

bool DeskServer::process_and_close_socket(socket_t socket) {
    const std::string address = address_group(peer_address(socket));
    Connection connection(socket, tls_.get(), patience_, ending_);
    {
        const std::lock_guard lock(mutex_);
        if (connections_[address] >= places_.of_one_address) return false;
        ++connections_[address];
    }
    const auto leave = [&](int*) {
        const std::lock_guard lock(mutex_);
        if (--connections_[address] == 0) connections_.erase(address);
    };
    int held = 0;
    const std::unique_ptr<int, decltype(leave)> place(&held, leave);
    if (!connection.shake_hands()) return false;
    for (int left = places_.requests; left > 0 && !ending_; --left) {
        const int refused = connection.read_head();
        if (refused < 0) return true;
        if (refused > 0) {
            connection.refuse(refused);
            break;
        }
        bool closed = false;
        const bool done = process_request(connection, left == 1, closed, nullptr);
        if (!done || closed || !connection.skip_body()) break;
    }
    connection.linger();
    return true;
}

}  // namespace palpa::desk
