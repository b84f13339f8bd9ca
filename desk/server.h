#pragma once
// cpp-httplib's server on connections of desk/connection.h: it parses requests and writes answers, and this says
// who is listened to, how long, and how many at a time.

#include <atomic>
#include <httplib.h>
#include <map>
#include <mutex>
#include <string>

#include "desk/connection.h"

namespace palpa::desk {

struct Places {
    std::size_t in_all = 128;         // connections served at a time, a thread each; as many again may wait
    std::size_t of_one_address = 64;  // so that one client never takes all
    int requests = 100;               // of one connection
};

class DeskServer : public httplib::Server {
  public:
    DeskServer(TlsContext tls, const Patience& patience, const Places& places);
    ~DeskServer() override;

    // Port 0: any that is free. Returns the port. Throws std::runtime_error with the system's reason.
    int bind(const std::string& address, int port);
    // Serves until end() is called, by another thread, before or after; then what is under way is let come to its end,
    // for a moment.
    void serve() { listen_after_bind(); }
    // Once, after bind().
    void end();

  private:
    bool process_and_close_socket(socket_t socket) override;

    TlsContext tls_;
    Patience patience_;
    Places places_;
    int listening_ =
        -1;  // the socket a second time, so that it can be shut down whatever the library has done with its own
    std::atomic<bool> ending_ = false;
    std::mutex mutex_;
    std::map<std::string, std::size_t> connections_;  // by address
};

}  // namespace palpa::desk
