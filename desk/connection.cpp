#include "desk/connection.h"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <ctime>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "desk/request_head.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/regular_file.h"

namespace palpa::desk {
namespace {

constexpr double kSlice_s = 0.2;  // how often a waiting connection looks whether the desk is being ended
// A client that has not read the answer yet loses it if the desk closes while the client still sends: what it sends after the
// answer is taken for so long without a pause, and in all.
constexpr double kLingerPause_s = 1.0;
constexpr double kLinger_s = 30.0;

std::string tls_trouble() {
    std::array<char, 256> text{};
    ERR_error_string_n(ERR_get_error(), text.data(), text.size());
    ERR_clear_error();
    return text.data();
}

using AddressOf = int (*)(int, sockaddr*, socklen_t*);

void address_of(int fd, AddressOf which, std::string& ip, int& port) {
    sockaddr_storage storage{};
    socklen_t length = sizeof storage;
    ip.clear();
    port = 0;
    if (which(fd, reinterpret_cast<sockaddr*>(&storage), &length) != 0) return;
    char text[INET6_ADDRSTRLEN] = "";
    if (storage.ss_family == AF_INET) {
        const auto* four = reinterpret_cast<const sockaddr_in*>(&storage);
        ::inet_ntop(AF_INET, &four->sin_addr, text, sizeof text);
        port = ntohs(four->sin_port);
    } else if (storage.ss_family == AF_INET6) {
        const auto* six = reinterpret_cast<const sockaddr_in6*>(&storage);
        const bool mapped = IN6_IS_ADDR_V4MAPPED(&six->sin6_addr);
        if (mapped) ::inet_ntop(AF_INET, six->sin6_addr.s6_addr + 12, text, sizeof text);
        if (!mapped) ::inet_ntop(AF_INET6, &six->sin6_addr, text, sizeof text);
        port = ntohs(six->sin6_port);
    }
    ip = text;
}

}  // namespace

TlsContext make_tls(const std::string& cert_file, const std::string& key_file) {
    files::check_input(cert_file);
    files::check_input(key_file);
    TlsContext tls(SSL_CTX_new(TLS_server_method()));
    if (!tls) throw std::runtime_error("TLS cannot be started: " + tls_trouble());
    SSL_CTX_set_min_proto_version(tls.get(), TLS1_2_VERSION);
    SSL_CTX_set_options(tls.get(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
    SSL_CTX_set_mode(tls.get(),
                     SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER | SSL_MODE_RELEASE_BUFFERS);
    SSL_CTX_set_session_cache_mode(tls.get(), SSL_SESS_CACHE_OFF);
    if (SSL_CTX_use_certificate_chain_file(tls.get(), cert_file.c_str()) != 1) {
        throw files::bad_input(cert_file, "", tls_trouble(), "a certificate in PEM");
    }
    if (SSL_CTX_use_PrivateKey_file(tls.get(), key_file.c_str(), SSL_FILETYPE_PEM) != 1 ||
        SSL_CTX_check_private_key(tls.get()) != 1) {
        throw files::bad_input(key_file, "", tls_trouble(), "the private key in PEM that belongs to " + cert_file);
    }
    return tls;
}

std::string fingerprint(const SSL_CTX& tls) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    std::string out;
    const X509* certificate = SSL_CTX_get0_certificate(&tls);
    if (certificate == nullptr || X509_digest(certificate, EVP_sha256(), digest.data(), &length) != 1) return out;
    for (unsigned i = 0; i < length; ++i) {
        if (i > 0) out.push_back(':');
        out.push_back("0123456789ABCDEF"[digest[i] >> 4]);
        out.push_back("0123456789ABCDEF"[digest[i] & 15]);
    }
    return out;
}

std::string out_of_date(const SSL_CTX& tls) {
    const X509* certificate = SSL_CTX_get0_certificate(&tls);
    if (certificate == nullptr) return "";
    const ASN1_TIME* from = X509_get0_notBefore(certificate);
    const ASN1_TIME* until = X509_get0_notAfter(certificate);
    const bool early = X509_cmp_current_time(from) > 0;
    if (!early && X509_cmp_current_time(until) > 0) return "";
    std::tm utc{};
    std::array<char, 32> text{};
    if (ASN1_TIME_to_tm(early ? from : until, &utc) == 1)
        std::strftime(text.data(), text.size(), " %Y-%m-%d %H:%M UTC", &utc);
    return std::string(early ? "the certificate is not good before" : "the certificate was good until") + text.data() +
           ": browsers warn of it or refuse the desk";
}

std::string peer_address(int fd) {
    std::string ip;
    int port = 0;
    address_of(fd, ::getpeername, ip, port);
    return ip;
}

Connection::Connection(int fd, SSL_CTX* tls, const Patience& patience, const std::atomic<bool>& ending)
    : fd_(fd), patience_(patience), ending_(ending) {
    ::fcntl(fd_, F_SETFL, ::fcntl(fd_, F_GETFL) | O_NONBLOCK);
    ::fcntl(fd_, F_SETFD, FD_CLOEXEC);
    const int yes = 1;
    ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    if (tls != nullptr) {
        ssl_.reset(SSL_new(tls));
        broken_ = !ssl_ || SSL_set_fd(ssl_.get(), fd_) != 1;
    }
    begin(Phase::handshake);
}

Connection::~Connection() {
    if (ssl_ && !broken_) SSL_shutdown(ssl_.get());
    ERR_clear_error();  // else the next client of this thread would see the errors of this one
    ::close(fd_);
}

void Connection::begin(Phase phase) {
    phase_ = phase;
    began_s_ = last_s_ = files::steady_s();
    bytes_ = 0.0;
}

double Connection::deadline_s() const {
    const Patience& p = patience_;
    double until_s = began_s_ + p.wait_s;
    if (phase_ == Phase::idle) until_s = ending_ ? 0.0 : began_s_ + p.idle_s;
    if (phase_ == Phase::body || phase_ == Phase::answer) {
        until_s = std::min(last_s_ + p.wait_s, began_s_ + 2.0 * p.wait_s + bytes_ / p.slowest_bytes_per_s);
    }
    return ended_s_ < 0.0 ? until_s : std::min(until_s, ended_s_ + p.end_s);
}

bool Connection::wait(short events) {
    while (true) {
        if (ending_ && ended_s_ < 0.0) ended_s_ = files::steady_s();
        const double left_s = deadline_s() - files::steady_s();
        if (left_s <= 0.0) return false;
        pollfd what{fd_, events, 0};
        const int ready = ::poll(&what, 1, static_cast<int>(1e3 * std::min(left_s, kSlice_s)) + 1);
        if (ready > 0) return true;
        if (ready < 0 && errno != EINTR) return false;
    }
}

template <class Tls, class Plain>
ssize_t Connection::transfer(Tls&& tls, Plain&& plain, short events) {
    while (!broken_) {
        short wanted = events;
        if (ssl_) {
            ERR_clear_error();
            const int n = tls(ssl_.get());
            if (n > 0) return n;
            const int trouble = SSL_get_error(ssl_.get(), n);
            if (trouble == SSL_ERROR_ZERO_RETURN) return 0;
            if (trouble != SSL_ERROR_WANT_READ && trouble != SSL_ERROR_WANT_WRITE) break;
            wanted = trouble == SSL_ERROR_WANT_READ ? POLLIN : POLLOUT;
        } else {
            const ssize_t n = plain(fd_);
            if (n >= 0) return n;
            if (errno == EINTR) continue;
            if (errno != EAGAIN && errno != EWOULDBLOCK) break;
        }
        if (!wait(wanted)) break;
    }
    broken_ = true;
    return -1;
}

bool Connection::shake_hands() {
    if (!ssl_) return true;
    return transfer([](SSL* ssl) { return SSL_accept(ssl); }, [](int) { return ssize_t{0}; }, POLLIN) > 0;
}

ssize_t Connection::receive(char* out, size_t size) {
    const auto n =
        transfer([&](SSL* ssl) { return SSL_read(ssl, out, static_cast<int>(std::min<size_t>(size, 1 << 20))); },
                 [&](int fd) { return ::recv(fd, out, size, 0); }, POLLIN);
    if (n > 0) {
        bytes_ += static_cast<double>(n);
        last_s_ = files::steady_s();
    }
    return n;
}

int Connection::read_head() {
    begin(phase_ == Phase::handshake ? Phase::head : Phase::idle);
    head_.clear();
    head_read_ = 0;
    body_left_ = 0;
    std::array<char, 4096> buffer;
    std::size_t end = 0;
    while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
        if (received_.size() > kLongestHead_bytes) return 431;
        const ssize_t n = receive(buffer.data(), buffer.size());
        if (n <= 0) return -1;
        if (phase_ == Phase::idle) begin(Phase::head);
        received_.append(buffer.data(), static_cast<std::size_t>(n));
    }
    if (end > kLongestHead_bytes) return 431;
    no_body_ = received_.starts_with("HEAD ");
    const CheckedHead head = check_head(std::string_view(received_).substr(0, end + 4));
    received_.erase(0, end + 4);
    head_ = head.text;
    body_left_ = head.content_bytes;
    return head.refused;
}

void Connection::refuse(int status) {
    const std::string body = std::string("{\"error\":\"") + why_refused(status) + "\"}\n";
    const std::string answer =
        "HTTP/1.1 " + std::to_string(status) +
        " Refused\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
        "\r\nConnection: close\r\n\r\n" + (no_body_ ? "" : body);
    write(answer.data(), answer.size());
}

ssize_t Connection::read(char* out, size_t size) {
    if (head_read_ < head_.size()) {
        const std::size_t n = head_.copy(out, size, head_read_);
        head_read_ += n;
        return static_cast<ssize_t>(n);
    }
    size = static_cast<size_t>(std::min<std::uint64_t>(size, body_left_));
    if (size == 0) return 0;
    if (phase_ != Phase::body) begin(Phase::body);
    if (!received_.empty()) {
        const std::size_t n = received_.copy(out, size);
        received_.erase(0, n);
        body_left_ -= n;
        return static_cast<ssize_t>(n);
    }
    const ssize_t n = receive(out, size);
    if (n > 0) body_left_ -= static_cast<std::uint64_t>(n);
    if (n == 0) broken_ = true;  // the client left in the middle of its body
    return n;
}

bool Connection::skip_body() {
    if (broken_ || body_left_ > kSkipped_bytes) return false;
    std::array<char, 4096> buffer;
    while (body_left_ > 0) {
        if (read(buffer.data(), buffer.size()) <= 0) return false;
    }
    return true;
}

ssize_t Connection::write(const char* bytes, size_t size) {
    if (size == 0) return 0;
    if (phase_ != Phase::answer) begin(Phase::answer);
    const auto n =
        transfer([&](SSL* ssl) { return SSL_write(ssl, bytes, static_cast<int>(std::min<size_t>(size, 1 << 20))); },
                 [&](int fd) { return ::send(fd, bytes, size, MSG_NOSIGNAL); }, POLLOUT);
    if (n > 0) {
        bytes_ += static_cast<double>(n);
        last_s_ = files::steady_s();
    }
    return n > 0 ? n : -1;
}

void Connection::linger() {
    if (broken_) return;
    if (ssl_) SSL_shutdown(ssl_.get());
    ::shutdown(fd_, SHUT_WR);
    broken_ = true;  // nothing more is sent
    std::vector<char> buffer(std::size_t{1} << 16);
    const double until_s = files::steady_s() + kLinger_s;
    double heard_s = files::steady_s();
    for (double now_s = heard_s; now_s < until_s && now_s < heard_s + kLingerPause_s && !ending_;
         now_s = files::steady_s()) {
        pollfd what{fd_, POLLIN, 0};
        if (::poll(&what, 1, static_cast<int>(1e3 * kSlice_s)) <= 0) continue;
        if (::recv(fd_, buffer.data(), buffer.size(), 0) <= 0) return;
        heard_s = files::steady_s();
    }
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const { address_of(fd_, ::getpeername, ip, port); }
void Connection::get_local_ip_and_port(std::string& ip, int& port) const { address_of(fd_, ::getsockname, ip, port); }

}  // namespace palpa::desk
