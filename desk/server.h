#pragma once
// The server of cpp-httplib on the connections of desk/connection.h. The library parses requests and writes answers; this
// file limits who is served, for how long, and how many at a time.

#include <atomic>
#include <httplib.h>
#include <map>
#include <mutex>
#include <string>

#include "desk/connection.h"

namespace palpa::desk {

struct Places {
    std::size_t in_all = 128;         // connections served at a time, a thread each; as many again may wait
    std::size_t of_one_address = 64;  // so that one client cannot take all
    int requests = 100;               // on one connection
};

class DeskServer : public httplib::Server {
  public:
    DeskServer(TlsContext tls, const Patience& patience, const Places& places);
    ~DeskServer() override;

    // Port 0 chooses any free port. Returns the port. Throws std::runtime_error with the system's reason.
    int bind(const std::string& address, int port);
    // Serves until another thread calls end(), which may come first. Requests that are under way then have a moment to
    // finish.
    void serve() { listen_after_bind(); }
    // Call it once, after bind().
    void end();

  private:
    bool process_and_close_socket(socket_t socket) override;

    TlsContext tls_;
    Patience patience_;
    Places places_;
    int listening_ =
        -1;  // a second descriptor of the socket, which can be shut down whatever the library has done with its own
    std::atomic<bool> ending_ = false;
    std::mutex mutex_;
    std::map<std::string, std::size_t> connections_;  // number of connections by address
};

}  // namespace palpa::desk
