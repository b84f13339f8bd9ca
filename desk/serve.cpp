#include "desk/serve.h"

#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <poll.h>
#include <signal.h>
#include <stdexcept>
#include <thread>
#include <unistd.h>

#include "desk/qr.h"
#include "desk/routes.h"
#include "files/input_error.h"

namespace palpa::desk {
namespace {

namespace fs = std::filesystem;

// The addresses for "this machine only" and "all networks" differ between IPv4 and IPv6.
struct Binding {
    bool six = false;
    bool loopback = false;
    bool any = false;
};

Binding binding_of(const std::string& address) {
    in_addr four{};
    in6_addr six{};
    if (::inet_pton(AF_INET, address.c_str(), &four) == 1) {
        return {false, (ntohl(four.s_addr) >> 24) == 127, four.s_addr == 0};
    }
    if (::inet_pton(AF_INET6, address.c_str(), &six) == 1) {
        return {true, IN6_IS_ADDR_LOOPBACK(&six) != 0, IN6_IS_ADDR_UNSPECIFIED(&six) != 0};
    }
    throw files::bad_input("--bind", "", files::shown(address),
                           "an IP address, such as 127.0.0.1 (this machine alone) or 0.0.0.0 (all)");
}

void check_options(const ServeOptions& options, const Binding& binding) {
    const bool tls = !options.tls_cert.empty();
    if (tls != !options.tls_key.empty())
        throw files::bad_input("--tls-cert, --tls-key", "", "one of them", "both or none");
    if (!tls && !binding.loopback) {
        throw files::bad_input("--bind", "", files::shown(options.bind) + " without --tls-cert and --tls-key",
                               "both, as others can be on that network: scripts/run --tablet makes them");
    }
    if (!options.web.empty() && !fs::is_regular_file(options.web / "index.html")) {
        throw files::bad_input("--web", "", files::shown(options.web.string()), "a folder with index.html");
    }
}

// The addresses under which tablets find the desk.
std::vector<std::string> addresses(const std::string& bind, const Binding& binding) {
    if (!binding.any) return {bind};
    std::vector<std::string> out;
    ifaddrs* list = nullptr;
    if (::getifaddrs(&list) != 0) return {"127.0.0.1"};
    for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
        if (one->ifa_addr == nullptr || (one->ifa_flags & IFF_LOOPBACK) != 0 || (one->ifa_flags & IFF_UP) == 0)
            continue;
        char text[INET6_ADDRSTRLEN] = "";
        if (one->ifa_addr->sa_family == AF_INET) {
            ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr, text, sizeof text);
        } else if (one->ifa_addr->sa_family == AF_INET6 && binding.six) {
            const auto& six = reinterpret_cast<const sockaddr_in6*>(one->ifa_addr)->sin6_addr;
            if (!IN6_IS_ADDR_LINKLOCAL(&six)) ::inet_ntop(AF_INET6, &six, text, sizeof text);
        }
        if (text[0] != '\0') out.emplace_back(text);
    }
    ::freeifaddrs(list);
    if (out.empty()) out.emplace_back("127.0.0.1");
    return out;
}

std::vector<std::string> urls_of(const ServeOptions& options, const Binding& binding, int port) {
    std::vector<std::string> urls;
    for (const std::string& address : addresses(options.bind, binding)) {
        const bool six = address.find(':') != std::string::npos;
        urls.push_back((options.tls_cert.empty() ? "http://" : "https://") + (six ? "[" + address + "]" : address) +
                       ":" + std::to_string(port) + "/");
    }
    return urls;
}

void print_start(const ServeOptions& options, const std::vector<std::string>& urls, const std::string& code,
                 const std::string& print, int port) {
    if (options.json) {
        files::Json json{{"event", "listening"}, {"port", port}, {"urls", urls}, {"pairing", !code.empty()}};
        if (!code.empty()) json["code"] = code;
        if (!print.empty()) json["certificate_sha256"] = print;
        std::printf("%s\n", json.dump().c_str());
        std::fflush(stdout);
        return;
    }
    if (!code.empty())
        std::printf("%s\n", qr_text(urls.front() + "#code=" + code, ::isatty(STDOUT_FILENO) != 0).c_str());
    for (const std::string& url : urls) std::printf("%s\n", url.c_str());
    if (!code.empty()) std::printf("code  %s %s\n", code.substr(0, 3).c_str(), code.substr(3).c_str());
    if (!print.empty()) std::printf("certificate, SHA-256  %s\n", print.c_str());
    std::printf("web app  %s\n", options.web.empty() ? "none is built; only /api and /files" : options.web.c_str());
    std::printf("logs  %s\n", options.collect.empty() ? "not taken (no --collect)" : options.collect.c_str());
    std::printf("^C ends it\n");
    std::fflush(stdout);
}

constexpr std::array<int, 3> kEndSignals{SIGINT, SIGTERM, SIGHUP};
constexpr char kAsked = 'a';
constexpr char kEnded = 'e';

int notes_to_main = -1;  // the end of a pipe, for the handler

extern "C" void note_end_signal(int) {
    const int error = errno;
    [[maybe_unused]] const ssize_t n = ::write(notes_to_main, &kAsked, 1);
    errno = error;
}

void set_end_handler(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : kEndSignals) ::sigaction(signal, &action, nullptr);
}

void mask_end_signals(int how) {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : kEndSignals) sigaddset(&set, signal);
    ::pthread_sigmask(how, &set, nullptr);
}

// A signal that ends the desk is passed on through a pipe. Blocking the signals and waiting for them is not enough:
// libraries start threads before main() that block no signal, and one of them would take it and end the program.
class EndNotes {
  public:
    EndNotes() {
        if (::pipe2(ends_.data(), O_CLOEXEC | O_NONBLOCK) != 0)
            throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
        notes_to_main = ends_[1];
        set_end_handler(note_end_signal);
    }
    ~EndNotes() {
        set_end_handler(SIG_DFL);
        for (const int fd : ends_) ::close(fd);
    }
    EndNotes(const EndNotes&) = delete;
    EndNotes& operator=(const EndNotes&) = delete;

    void tell_ended() const { [[maybe_unused]] const ssize_t n = ::write(ends_[1], &kEnded, 1); }
    // Waits for the first note. Returns whether it asks for the end.
    bool wait_for_asked() const {
        pollfd waiting{ends_[0], POLLIN, 0};
        char note = 0;
        while (::read(ends_[0], &note, 1) != 1) ::poll(&waiting, 1, -1);
        return note == kAsked;
    }

  private:
    std::array<int, 2> ends_{};
};

}  // namespace

fs::path web_folder_beside(const fs::path& assets) {
    const fs::path root = assets.parent_path();
    // the place in a build of the sources, then the place of an installation, beside the assets
    for (const fs::path& place : {root / "build/web/site", root / "web"}) {
        std::error_code none;
        if (fs::is_regular_file(place / "index.html", none)) return place;
    }
    return {};
}

void serve(const ServeOptions& options) {
    const Binding binding = binding_of(options.bind);
    check_options(options, binding);
    const bool with_tls = !options.tls_cert.empty();
    TlsContext tls = with_tls ? make_tls(options.tls_cert, options.tls_key) : TlsContext();
    X509* certificate = tls ? SSL_CTX_get0_certificate(tls.get()) : nullptr;
    const std::string print = tls ? fingerprint(*tls) : "";
    std::vector<std::string> notes;
    if (const std::string note = tls ? out_of_date(*tls) : ""; !note.empty()) notes.push_back(note);

    std::string trouble;
    Desk desk{options,
              with_tls,
              certificate,
              CodeGuard(random_code(), options.tries),
              Sessions(options.collect.empty() ? fs::path() : fs::path(options.collect) / "sessions.json",
                       options.sessions, trouble),
              std::nullopt,
              DeskEvents(options.json)};

    const EndNotes notes_of_end;
    ::signal(SIGPIPE, SIG_IGN);

    DeskServer server(std::move(tls), options.patience, {});
    set_routes(desk, server);
    const int port = server.bind(options.bind, options.port);
    // only now: a desk that finds its port taken leaves no folder
    if (!options.collect.empty()) desk.uploads.emplace(options.collect, options.uploads, notes);
    print_start(options, urls_of(options, binding, port), with_tls ? desk.codes.code() : "", print, port);
    if (!trouble.empty()) desk.events.tell("note", trouble, {{"what", trouble}});
    for (const std::string& note : notes) desk.events.tell("note", note, {{"what", note}});

    mask_end_signals(SIG_BLOCK);  // the threads of the server inherit this and are never interrupted
    std::thread serving([&] {
        server.serve();
        notes_of_end.tell_ended();
    });
    mask_end_signals(SIG_UNBLOCK);
    const bool asked = notes_of_end.wait_for_asked();
    set_end_handler(SIG_DFL);  // a second signal ends the program at once
    server.end();
    serving.join();
    if (!asked) throw std::runtime_error("the port cannot be listened on any longer");
    desk.events.tell("ended", "uploads under way have come to their end or are sent again");
}

}  // namespace palpa::desk
