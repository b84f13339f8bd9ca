#pragma once
// `palpa serve` as a process of its own, and clients that talk to it over real sockets and real TLS.

#include <arpa/inet.h>
#include <chrono>
#include <cstdlib>
#include <fcntl.h>
#include <httplib.h>
#include <memory>
#include <mutex>
#include <poll.h>
#include <signal.h>
#include <stdexcept>
#include <string>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "tests/temporary_folder.h"

namespace palpa::test {

inline void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// A certificate for 127.0.0.1, made once in a folder: cert.pem and key.pem.
inline void make_certificate(const TemporaryFolder& folder) {
    const std::string at = folder.path().string();
    const std::string command =
        "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=palpa -addext "
        "subjectAltName=IP:127.0.0.1,DNS:desk.test -keyout " +
        at + "/key.pem -out " + at + "/cert.pem 2>/dev/null";
    if (std::system(command.c_str()) != 0) throw std::runtime_error("no certificate: " + command);
}

class DeskProcess {
  public:
    // Starts `palpa serve --json ARGUMENTS` and waits until it listens. Throws if it ends instead.
    explicit DeskProcess(std::vector<std::string> arguments) {
        ::signal(SIGPIPE, SIG_IGN);  // clients here write to desks that were killed
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        arguments.insert(arguments.begin(), {PALPA_PROGRAM, "serve", "--json"});
        pid_ = ::fork();
        if (pid_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that dies takes its desk along
            ::dup2(ends[1], 1);
            std::vector<char*> words;
            for (std::string& word : arguments) words.push_back(word.data());
            words.push_back(nullptr);
            ::execv(PALPA_PROGRAM, words.data());
            ::_exit(127);
        }
        ::close(ends[1]);
        reader_ = std::thread([this, fd = ends[0]] { read_lines(fd); });
        for (int i = 0; i < 1200 && events().empty() && !closed_; ++i) sleep_s(0.05);
        if (events().empty()) {
            end(SIGKILL);
            throw std::runtime_error("palpa serve did not start");
        }
        const files::Json first = events().front();
        port = first["port"].get<int>();
        code = first.value("code", "");
    }
    ~DeskProcess() { end(SIGKILL); }
    DeskProcess(const DeskProcess&) = delete;
    DeskProcess& operator=(const DeskProcess&) = delete;

    // The exit status; -1 if it was killed.
    int end(int signal = SIGTERM) {
        if (pid_ <= 0) return status_;
        ::kill(pid_, signal);
        int status = 0;
        ::waitpid(pid_, &status, 0);
        pid_ = -1;
        reader_.join();
        return status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    // What it has said so far.
    std::vector<files::Json> events() const {
        const std::lock_guard lock(mutex_);
        return events_;
    }
    int count(const std::string& event) const {
        int n = 0;
        for (const files::Json& one : events()) n += one["event"] == event ? 1 : 0;
        return n;
    }

    // A figure of /proc/PID/status in MB: VmHWM, the most memory that was ever resident.
    double memory_MB(const std::string& figure) const {
        const std::string text = files::read_text("/proc/" + std::to_string(pid_) + "/status");
        return std::atof(text.c_str() + text.find(figure) + figure.size() + 1) / 1024.0;
    }
    int threads() const {
        const std::string text = files::read_text("/proc/" + std::to_string(pid_) + "/status");
        return std::atoi(text.c_str() + text.find("Threads:") + 8);
    }

    int port = 0;
    std::string code;

  private:
    void read_lines(int fd) {
        std::string text;
        char buffer[4096];
        for (ssize_t n; (n = ::read(fd, buffer, sizeof buffer)) > 0;) {
            text.append(buffer, static_cast<std::size_t>(n));
            for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
                const std::lock_guard lock(mutex_);
                events_.push_back(files::Json::parse(text.substr(0, end)));
                text.erase(0, end + 1);
            }
        }
        ::close(fd);
        closed_ = true;
    }

    pid_t pid_ = -1;
    int status_ = -1;
    std::thread reader_;
    mutable std::mutex mutex_;
    std::vector<files::Json> events_;
    std::atomic<bool> closed_ = false;
};

// A tablet: verifies the desk's certificate, keeps its connection.
inline std::unique_ptr<httplib::SSLClient> tablet(const TemporaryFolder& certificate, int port) {
    auto client = std::make_unique<httplib::SSLClient>("127.0.0.1", port);
    client->set_ca_cert_path((certificate / "cert.pem").c_str());
    client->enable_server_certificate_verification(true);
    client->set_keep_alive(true);
    client->set_connection_timeout(60);
    client->set_read_timeout(60);
    return client;
}

inline httplib::Result pair_with(const std::string& code, httplib::SSLClient& client) {
    return client.Post("/api/pair", "{\"code\": \"" + code + "\"}", "application/json");
}

// "" if the desk refuses.
inline std::string token_of(const std::string& code, httplib::SSLClient& client) {
    const auto result = pair_with(code, client);
    return result && result->status == 200 ? files::Json::parse(result->body)["token"].get<std::string>() : "";
}

inline httplib::Headers upload_headers(const std::string& token, const std::string& sha256) {
    return {{"Authorization", "Bearer " + token}, {"X-Content-SHA256", sha256}};
}

inline httplib::Result upload(const std::string& label, const std::string& bytes, const std::string& token,
                              httplib::SSLClient& client) {
    return client.Put("/api/logs/" + label, upload_headers(token, files::sha256_hex(bytes)), bytes, "application/json");
}

// A bare socket, for what no decent client says. `from`: its own address, 127.0.0.x.
class RawClient {
  public:
    RawClient(int port, const std::string& from = "127.0.0.1") : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in own{}, desk{};
        own.sin_family = desk.sin_family = AF_INET;
        ::inet_pton(AF_INET, from.c_str(), &own.sin_addr);
        ::inet_pton(AF_INET, "127.0.0.1", &desk.sin_addr);
        desk.sin_port = htons(static_cast<std::uint16_t>(port));
        ::bind(fd_, reinterpret_cast<sockaddr*>(&own), sizeof own);
        connected_ = ::connect(fd_, reinterpret_cast<sockaddr*>(&desk), sizeof desk) == 0;
    }
    ~RawClient() { ::close(fd_); }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    bool connected() const { return connected_; }
    bool send(const std::string& bytes) {
        return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
    }
    // Everything until the desk closes, or nothing more comes for so long.
    std::string receive(double patience_s = 20.0) {
        std::string out;
        char buffer[4096];
        while (true) {
            pollfd what{fd_, POLLIN, 0};
            if (::poll(&what, 1, static_cast<int>(1e3 * patience_s)) <= 0) return out;
            const ssize_t n = ::recv(fd_, buffer, sizeof buffer, 0);
            closed_ = n <= 0;
            if (n <= 0) return out;
            out.append(buffer, static_cast<std::size_t>(n));
        }
    }
    bool closed() const { return closed_; }  // by the desk, as receive() saw

  private:
    int fd_;
    bool connected_ = false;
    bool closed_ = false;
};

}  // namespace palpa::test
