#pragma once
// Who may send logs to the desk: a code that the desk shows and a person types, then a token that the tablet keeps.
// Both are random from the system's generator and compared in constant time. No clock of their own: times are arguments.

#include <array>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::desk {

// Six digits, each code as likely as any other. Throws std::runtime_error if the system has no random numbers.
std::string random_code();

struct TryLimits {
    int tries_per_address = 5;   // wrong ones before an address is locked out
    int tries_in_total = 20;     // wrong ones of all addresses before everybody is
    double first_lock_s = 30.0;  // doubles with each wrong try after a lock
    double longest_lock_s = 3600.0;
    double forget_s = 600.0;  // one wrong try is forgotten in this time, counted from the last one and its lock's end
    std::size_t most_addresses = 1024;  // remembered; the one that has been quiet for longest goes
};

// Tries of the code. With the limits above somebody who never stops has a chance of about 2 in 10,000 a day. May be
// called by many threads.
class CodeGuard {
  public:
    CodeGuard(std::string code, const TryLimits& limits) : code_(std::move(code)), limits_(limits) {}

    enum class Answer { right, wrong, locked };
    struct Result {
        Answer answer = Answer::wrong;
        double wait_s = 0.0;      // of a lock-out: until it ends
        bool lock_began = false;  // by this try
        bool everybody = false;   // the lock-out is of all addresses
    };
    // While an address is locked out its tries are not even compared. now_s: a clock that never goes back.
    Result try_code(std::string_view code, const std::string& address, double now_s);

    std::size_t remembered() const;
    const std::string& code() const { return code_; }

  private:
    struct Tries {
        int wrong = 0;
        double last_s = 0.0;
        double locked_until_s = 0.0;
    };
    Tries& tries_of(const std::string& address);
    bool count_wrong(double now_s, int allowed, Tries& tries) const;  // true if that locks
    void forget(double now_s, Tries& tries) const;

    std::string code_;
    TryLimits limits_;
    mutable std::mutex mutex_;
    std::map<std::string, Tries> by_address_;
    Tries total_;
};

// IPv6 addresses of one network (/64) count as one, as anybody there has as many as he likes.
std::string address_group(const std::string& address);

struct SessionLimits {
    double lasts_s = 12 * 3600.0;
    std::size_t most = 256;  // the one that ends first makes room
};

// Tokens that were given out: only their SHA-256 is kept. With a file they survive the end of the program: a tablet
// whose desk was started again goes on. May be called by many threads.
class Sessions {
  public:
    // `file`: empty for none. What it holds is read if it can be, `trouble` says so if not.
    Sessions(const std::filesystem::path& file, const SessionLimits& limits, std::string& trouble);

    struct Opened {
        std::string token;  // 64 hex digits, 256 random bits
        int device = 0;     // counts up from 1: how the desk calls the tablet
    };
    // unix_s: seconds since 1970. Throws std::runtime_error if the file cannot be written.
    Opened open(double unix_s);

    // The device that has this token, nothing if there is none or it has expired.
    std::optional<int> device_of(std::string_view token, double unix_s) const;
    double lasts_s() const { return limits_.lasts_s; }

  private:
    struct Session {
        std::string token_sha256;
        int device = 0;
        double ends_unix_s = 0.0;
    };
    void read(std::string& trouble);
    void write() const;

    std::filesystem::path file_;
    SessionLimits limits_;
    mutable std::mutex mutex_;
    std::vector<Session> sessions_;
    int last_device_ = 0;
};

}  // namespace palpa::desk
