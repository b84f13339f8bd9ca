#pragma once
// Who may send logs to the desk: a code that the desk shows and a person types, then a token that the tablet keeps.
// Both come from the system's random generator and are compared in constant time. The caller passes in all times.

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
    int tries_per_address = 5;   // wrong tries before an address is locked out
    int tries_in_total = 20;     // wrong tries of all addresses before everybody is locked out
    double first_lock_s = 30.0;  // doubles with each wrong try after a lock
    double longest_lock_s = 3600.0;
    double forget_s = 600.0;            // forgets one wrong try, counted from the last try or the end of its lock-out
    std::size_t most_addresses = 1024;  // remembered; the one that was quiet for longest is dropped
};

// Counts the tries of the code. With the limits above, a client that never stops guessing succeeds with a probability of
// about 2 in 10,000 a day. May be called by many threads.
class CodeGuard {
  public:
    CodeGuard(std::string code, const TryLimits& limits) : code_(std::move(code)), limits_(limits) {}

    enum class Answer { right, wrong, locked };
    struct Result {
        Answer answer = Answer::wrong;
        double wait_s = 0.0;      // until the lock-out ends
        bool lock_began = false;  // a lock-out began with this try
        bool everybody = false;   // the lock-out concerns all addresses
    };
    // While an address is locked out, its tries are not even compared. now_s comes from a clock that never goes back.
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
    bool count_wrong(double now_s, int allowed, Tries& tries) const;  // true if this locks out
    void forget(double now_s, Tries& tries) const;

    std::string code_;
    TryLimits limits_;
    mutable std::mutex mutex_;
    std::map<std::string, Tries> by_address_;
    Tries total_;
};

// IPv6 addresses of one network (/64) count as one, since a client there has as many as it likes.
std::string address_group(const std::string& address);

struct SessionLimits {
    double lasts_s = 12 * 3600.0;
    std::size_t most = 256;  // the token that expires first makes room for a new one
};

// The tokens given out, of which only the SHA-256 is kept. With a file they survive the end of the program, so that a
// tablet can go on after the desk was started again. May be called by many threads.
class Sessions {
  public:
    // `file` is empty for none. If its content cannot be read, `trouble` says why.
    Sessions(const std::filesystem::path& file, const SessionLimits& limits, std::string& trouble);

    struct Opened {
        std::string token;  // 64 hex digits, 256 random bits
        int device = 0;     // number of the tablet, from 1 upwards
    };
    // unix_s is in seconds since 1970. Throws std::runtime_error if the file cannot be written.
    Opened open(double unix_s);

    // Returns the device that has this token, or nothing if there is none or the token has expired.
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
