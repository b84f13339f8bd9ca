#pragma once
// One connection of a client, with or without TLS, which nobody can hold for long: a request's head must be there in
// time, a body must come on and answers must be taken at a lowest rate.

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

// Certificate (chain) and key, TLS 1.2 or later. Throws InputError naming the file that cannot be used.
TlsContext make_tls(const std::string& cert_file, const std::string& key_file);

// SHA-256 of the certificate, "AB:CD:...", as browsers show it.
std::string fingerprint(const SSL_CTX& tls);

inline constexpr std::uint64_t kSkipped_bytes = 64 * 1024;

class Connection : public httplib::Stream {
  public:
    // Takes over the socket. tls: null for none. `ending`: set when the desk is being ended.
    Connection(int fd, SSL_CTX* tls, const Patience& patience, const std::atomic<bool>& ending);
    ~Connection() override;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool shake_hands();
    // Waits for the next request's head. 0: it is there and fine; an HTTP status to refuse it with; -1: the client
    // went, or said nothing for too long.
    int read_head();
    void refuse(int status);
    // Reads over what nobody took of a body, so that the next request can come; false if that is more than kSkipped_bytes
    // or does not come. The connection cannot go on then.
    bool skip_body();
    // Takes what a client is still sending for a moment: closed at once, it would never see the answer.
    void linger();

    bool is_readable() const override { return true; }
    bool is_writable() const override { return !broken_; }
    ssize_t read(char* out, size_t size) override;  // of the head, then the body; never beyond it
    ssize_t write(const char* bytes, size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    socket_t socket() const override { return fd_; }

  private:
    enum class Phase { handshake, idle, head, body, answer };
    void begin(Phase phase);
    double deadline_s() const;
    bool wait(short events);
    // What OpenSSL or the socket said: more than 0 bytes, 0 at the end, -1 if broken or too slow.
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
    double bytes_ = 0.0;     // of this phase
    bool broken_ = false;
    std::string received_;  // of the next requests, not looked at yet
    std::string head_;      // checked, for the HTTP library
    std::size_t head_read_ = 0;
    std::uint64_t body_left_ = 0;
};

// The client's address as text; IPv4 in IPv6 as IPv4.
std::string peer_address(int fd);

}  // namespace palpa::desk
