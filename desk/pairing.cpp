#include "desk/pairing.h"

#include <algorithm>
#include <arpa/inet.h>
#include <cmath>
#include <cstring>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <stdexcept>

#include "files/input_error.h"
#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"

namespace palpa::desk {
namespace {

constexpr unsigned kCodes = 1000000;
constexpr std::size_t kCodeDigits = 6;
constexpr std::size_t kTokenBytes = 32;

template <std::size_t n>
std::array<unsigned char, n> random_bytes() {
    std::array<unsigned char, n> bytes{};
    if (RAND_bytes(bytes.data(), n) != 1) throw std::runtime_error("the system gives no random numbers");
    return bytes;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace

std::string random_code() {
    constexpr std::uint32_t kWhole =
        UINT32_MAX - UINT32_MAX % kCodes;  // from here on the first codes would be likelier
    while (true) {
        const auto bytes = random_bytes<4>();
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data(), sizeof value);
        if (value >= kWhole) continue;
        const std::string digits = std::to_string(value % kCodes);
        return std::string(kCodeDigits - digits.size(), '0') + digits;
    }
}

std::string address_group(const std::string& address) {
    in6_addr six{};
    if (::inet_pton(AF_INET6, address.c_str(), &six) != 1 || IN6_IS_ADDR_V4MAPPED(&six)) return address;
    std::fill(six.s6_addr + 8, six.s6_addr + 16, static_cast<unsigned char>(0));
    char text[INET6_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET6, &six, text, sizeof text);
    return std::string(text) + "/64";
}

void CodeGuard::forget(double now_s, Tries& tries) const {
    const double forgotten = std::floor((now_s - tries.last_s) / limits_.forget_s);
    if (forgotten < 1.0) return;
    tries.wrong = static_cast<int>(std::max(0.0, tries.wrong - forgotten));
    tries.last_s += forgotten * limits_.forget_s;
}

bool CodeGuard::count_wrong(double now_s, int allowed, Tries& tries) const {
    ++tries.wrong;
    tries.last_s = now_s;
    if (tries.wrong < allowed) return false;
    const double lock_s = limits_.first_lock_s * std::exp2(std::min(tries.wrong - allowed, 30));
    tries.locked_until_s = now_s + std::min(lock_s, limits_.longest_lock_s);
    tries.last_s = tries.locked_until_s;
    return true;
}

CodeGuard::Tries& CodeGuard::tries_of(const std::string& address) {
    if (by_address_.count(address) == 0 && by_address_.size() >= limits_.most_addresses) {
        // a client with that many addresses runs into the lock-out of all addresses
        by_address_.erase(std::min_element(by_address_.begin(), by_address_.end(), [](const auto& a, const auto& b) {
            return std::max(a.second.last_s, a.second.locked_until_s) <
                   std::max(b.second.last_s, b.second.locked_until_s);
        }));
    }
    return by_address_[address];
}

CodeGuard::Result CodeGuard::try_code(std::string_view code, const std::string& address, double now_s) {
    const std::lock_guard lock(mutex_);
    Tries& tries = tries_of(address_group(address));
    forget(now_s, tries);
    forget(now_s, total_);
    const double until_s = std::max(tries.locked_until_s, total_.locked_until_s);
    if (now_s < until_s) return {Answer::locked, until_s - now_s, false, total_.locked_until_s >= until_s};
    if (equal_in_constant_time(code, code_)) {
        tries = {};
        return {Answer::right};
    }
    const bool locks_one = count_wrong(now_s, limits_.tries_per_address, tries);
    const bool locks_all = count_wrong(now_s, limits_.tries_in_total, total_);
    Result result{Answer::wrong};
    result.lock_began = locks_one || locks_all;
    result.everybody = locks_all;
    if (locks_one) result.wait_s = tries.locked_until_s - now_s;
    if (locks_all) result.wait_s = std::max(result.wait_s, total_.locked_until_s - now_s);
    return result;
}

std::size_t CodeGuard::remembered() const {
    const std::lock_guard lock(mutex_);
    return by_address_.size();
}

Sessions::Sessions(const std::filesystem::path& file, const SessionLimits& limits, std::string& trouble)
    : file_(file), limits_(limits) {
    if (!file_.empty() && std::filesystem::exists(file_)) read(trouble);
}

void Sessions::read(std::string& trouble) {
    try {
        const files::Json root = files::read_json(file_);
        files::JsonReader json(root, file_.string());
        std::vector<Session> sessions;
        const int last_device = json.integer("last_device", 0, 1000000000);
        for (files::JsonReader& one : json.objects("sessions")) {
            sessions.push_back({one.text("token_sha256"), one.integer("device", 1, 1000000000),
                                one.number("ends_unix_s", files::kNotNegative)});
            one.finish();
        }
        json.finish();
        sessions_ = std::move(sessions);
        last_device_ = last_device;
    } catch (const files::InputError& error) {
        trouble = std::string(error.what()) + "; tablets must pair again";
    }
}

void Sessions::write() const {
    if (file_.empty()) return;
    files::Json json{{"last_device", last_device_}, {"sessions", files::Json::array()}};
    for (const Session& one : sessions_) {
        json["sessions"].push_back(
            {{"token_sha256", one.token_sha256}, {"device", one.device}, {"ends_unix_s", one.ends_unix_s}});
    }
    files::write_text_atomically(file_, files::json_text(json));
}

Sessions::Opened Sessions::open(double unix_s) {
    Opened opened;
    for (const unsigned char byte : random_bytes<kTokenBytes>()) {
        opened.token.push_back("0123456789abcdef"[byte >> 4]);
        opened.token.push_back("0123456789abcdef"[byte & 15]);
    }
    const std::lock_guard lock(mutex_);
    sessions_.erase(std::remove_if(sessions_.begin(), sessions_.end(),
                                   [&](const Session& one) { return one.ends_unix_s <= unix_s; }),
                    sessions_.end());
    if (sessions_.size() >= limits_.most) {
        sessions_.erase(std::min_element(sessions_.begin(), sessions_.end(), [](const Session& a, const Session& b) {
            return a.ends_unix_s < b.ends_unix_s;
        }));
    }
    opened.device = ++last_device_;
    sessions_.push_back({files::sha256_hex(opened.token), opened.device, unix_s + limits_.lasts_s});
    write();
    return opened;
}

std::optional<int> Sessions::device_of(std::string_view token, double unix_s) const {
    const std::string hash = files::sha256_hex(token);
    const std::lock_guard lock(mutex_);
    std::optional<int> device;
    for (const Session& one : sessions_) {
        if (equal_in_constant_time(hash, one.token_sha256) && unix_s < one.ends_unix_s) device = one.device;
    }
    return device;
}

}  // namespace palpa::desk
