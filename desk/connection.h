#pragma once
// One connection of a client, with or without TLS. No client can hold it for long: the head of a request must arrive in
// time, and bodies and answers must move at a lowest rate.

#include <atomic>
#include <cstdint>
#include <httplib.h>
#include <memory>
#include <string>

#include "desk/time_limits.h"

namespace palpa::desk {

struct FreeTls {
    void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
    void operator()(SSL* session) const { SSL_free(session); }
};
using TlsContext = std::unique_ptr<SSL_CTX, FreeTls>;

// Loads the certificate (chain) and the key, for TLS 1.2 or later. Throws InputError naming the file that cannot be used.
TlsContext make_tls(const std::string& cert_file, const std::string& key_file);

// Returns the SHA-256 of the certificate as browsers show it, "AB:CD:...".
std::string fingerprint(const SSL_CTX& tls);

// Says that the certificate has ended, or does not begin yet, and when; empty: it is good now.
std::string out_of_date(const SSL_CTX& tls);

inline constexpr std::uint64_t kSkipped_bytes = 64 * 1024;

class Connection : public httplib::Stream {
  public:
    // Takes over the socket. tls is null for none; `ending` becomes true when the desk is being ended.
    Connection(int fd, SSL_CTX* tls, const Patience& patience, const std::atomic<bool>& ending);
    ~Connection() override;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool shake_hands();
    // Waits for the head of the next request. Returns 0 if it is there and fine, the HTTP status to refuse it with, or -1
    // if the client went away or sent nothing for too long.
    int read_head();
    void refuse(int status);  // says why in the body, unless the request was HEAD
    // Skips the rest of a body that was not read, so that the next request can follow. Returns false if the rest is more
    // than kSkipped_bytes or does not arrive: the connection must then be closed.
    bool skip_body();
    // Reads for a moment what a client is still sending: if the socket closed at once, the client would not see the answer.
    void linger();

    bool is_readable() const override { return true; }
    bool is_writable() const override { return !broken_; }
    ssize_t read(char* out, size_t size) override;  // the head, then the body; never what follows it
    ssize_t write(const char* bytes, size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return fd_; }

  private:
    enum class Phase { handshake, idle, head, body, answer };
    void begin(Phase phase);
    double deadline_s() const;
    bool wait(short events);
    // Returns the number of bytes, 0 at the end, -1 if the connection is broken or too slow.
    template <class Tls, class Plain>
    ssize_t transfer(Tls&& tls, Plain&& plain, short events);
    ssize_t receive(char* out, size_t size);

    int fd_;
    std::unique_ptr<SSL, FreeTls> ssl_;
    Patience patience_;
    const std::atomic<bool>& ending_;
    Phase phase_ = Phase::handshake;
    double began_s_ = 0.0;
    double last_s_ = 0.0;
    double ended_s_ = -1.0;  // when `ending` was first seen
    double bytes_ = 0.0;     // moved in this phase
    bool broken_ = false;
    std::string received_;  // bytes of the next requests, not looked at yet
    std::string head_;      // checked, for the HTTP library
    std::size_t head_read_ = 0;
    bool no_body_ = false;  // the request was HEAD, so its answer has none
    std::uint64_t body_left_ = 0;
};

// Returns the address of the client as text; an IPv4 address inside IPv6 as IPv4.
std::string peer_address(int fd);

}  // namespace palpa::desk
