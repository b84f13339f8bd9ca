#include "desk/uploads.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/file.h>
#include <unistd.h>

#include "files/append_file.h"
#include "files/clock.h"
#include "files/durable.h"
#include "files/input_error.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/read_logs.h"

namespace palpa::desk {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".upload";
constexpr std::string_view kHeader = "received_utc\tsha256\tbytes\tname\tlabel\tdevice\taddress\n";
constexpr std::size_t kLongestLabel = 64;
constexpr std::uint64_t kRow_bytes = 512;  // more than a row of the index

// Returns the hash in the name of an upload, or "".
std::string hash_of_name(const fs::path& file) {
    const std::string name = file.filename().string();
    if (!std::string_view(name).ends_with(kEnding)) return "";
    const std::string hash = name.substr(0, name.size() - kEnding.size());
    return files::is_sha256_hex(hash) ? hash : "";
}

std::string row_key(std::string_view sha256, std::string_view label, std::string_view device) {
    return std::string(sha256).append("\t").append(label).append("\t").append(device);
}

}  // namespace

std::string sane_label(std::string_view label) {
    std::string out(label.substr(0, kLongestLabel));
    for (char& c : out) {
        const bool sane = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
                          c == '-' || c == '_';
        if (!sane) c = '_';
    }
    return out.empty() ? "unnamed" : out;
}

struct Uploads::Incoming::Hash {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    Hash() {
        if (context == nullptr || EVP_DigestInit_ex(context, EVP_sha256(), nullptr) != 1)
            throw std::runtime_error("OpenSSL has no SHA-256");
    }
    ~Hash() { EVP_MD_CTX_free(context); }
    Hash(const Hash&) = delete;
    Hash& operator=(const Hash&) = delete;
    void add(std::string_view bytes) { EVP_DigestUpdate(context, bytes.data(), bytes.size()); }
    std::string hex() {
        std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
        unsigned length = 0;
        EVP_DigestFinal_ex(context, digest.data(), &length);
        std::string out;
        for (unsigned i = 0; i < length; ++i) {
            out.push_back("0123456789abcdef"[digest[i] >> 4]);
            out.push_back("0123456789abcdef"[digest[i] & 15]);
        }
        return out;
    }
};

Uploads::Uploads(const fs::path& folder, const UploadLimits& limits, std::vector<std::string>& notes)
    : folder_(folder), limits_(limits) {
    std::error_code error;
    fs::create_directories(folder_ / "aside", error);
    if (error) throw std::runtime_error(folder_.string() + ": cannot be made: " + error.message());
    lock_folder();
    for (const auto& entry : fs::directory_iterator(folder_ / "aside")) {
        notes.push_back(entry.path().string() + ": an upload that did not come to its end, removed");
        fs::remove(entry.path());
    }
    if (!fs::exists(folder_ / "index.tsv") || fs::file_size(folder_ / "index.tsv") == 0)
        files::append_synced(folder_ / "index.tsv", kHeader);
    read_index(notes);
    used_ += fs::file_size(folder_ / "index.tsv");
    for (const auto& entry : fs::directory_iterator(folder_)) {
        if (hash_of_name(entry.path()).empty() || entry.is_symlink() || !entry.is_regular_file()) continue;
        used_ += entry.file_size();
        if (indexed_.count(hash_of_name(entry.path())) == 0) adopt(entry.path(), notes);
    }
}

Uploads::~Uploads() {
    if (lock_fd_ >= 0) ::close(lock_fd_);
}

void Uploads::lock_folder() {
    lock_fd_ = ::open((folder_ / "aside").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_fd_ < 0) files::fail_writing(folder_ / "aside");
    if (::flock(lock_fd_, LOCK_EX | LOCK_NB) == 0) return;
    const bool taken = errno == EWOULDBLOCK;
    ::close(lock_fd_);
    if (taken)
        throw files::bad_input(folder_.string(), "", "another palpa serve that collects here",
                               "a folder of its own for each");
    throw std::runtime_error(folder_.string() + ": cannot be locked: " + std::strerror(errno));
}

void Uploads::read_index(std::vector<std::string>& notes) {
    const fs::path file = folder_ / "index.tsv";
    const std::string text = files::read_text(file);
    std::string_view rest = study::whole_lines(text, file.string(), notes);
    for (int line = 1; !rest.empty(); ++line) {
        const std::string_view row = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(row.size() + 1);
        if (line == 1 || row.empty()) continue;
        const auto fields = files::fields_of(row, '\t');
        if (fields.size() != 7 || !files::is_sha256_hex(fields[1])) {
            notes.push_back(file.string() + ": line " + std::to_string(line) + " is left out: " + files::shown(row) +
                            " is not an upload with 7 fields");
            continue;
        }
        indexed_.emplace(fields[1]);
        rows_.insert(row_key(fields[1], fields[4], fields[5]));
    }
}

// The program can be killed after a file got its name and before its row is written.
void Uploads::adopt(const fs::path& file, std::vector<std::string>& notes) {
    Incoming::Hash hash;
    const int fd = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    std::array<char, 1 << 16> buffer;
    ssize_t n = 0;
    while (fd >= 0 && (n = ::read(fd, buffer.data(), buffer.size())) > 0)
        hash.add({buffer.data(), static_cast<std::size_t>(n)});
    if (fd >= 0) ::close(fd);
    if (fd < 0 || n < 0 || hash.hex() != hash_of_name(file)) {
        notes.push_back(file.string() +
                        ": its content is not what its name says; it is left alone and not in the index");
        return;
    }
    notes.push_back(file.string() + ": was not in the index, added");
    append_row(hash_of_name(file), fs::file_size(file), {"unknown", 0, "unknown"});
}

void Uploads::append_row(const std::string& sha256, std::uint64_t bytes, const Sender& sender) {
    const std::string device = std::to_string(sender.device);
    const std::string key = row_key(sha256, sender.label, device);
    if (rows_.count(key) != 0) return;
    const std::string row = files::utc_now() + "\t" + sha256 + "\t" + std::to_string(bytes) + "\t" + sha256 +
                            std::string(kEnding) + "\t" + sender.label + "\t" + device + "\t" + sender.address + "\n";
    files::append_synced(folder_ / "index.tsv", row);
    used_ += row.size();
    rows_.insert(key);
    indexed_.insert(sha256);
}

std::unique_ptr<Uploads::Incoming> Uploads::begin(std::uint64_t bytes, std::string_view expected_sha256) {
    if (bytes > limits_.upload_bytes) {
        throw UploadRefused(
            413, std::to_string(bytes) + " bytes, at most " + std::to_string(limits_.upload_bytes) + " in one upload");
    }
    std::uint64_t counted = bytes;
    {
        const std::lock_guard lock(mutex_);
        if (indexed_.count(std::string(expected_sha256)) != 0) counted = 0;
        if (counted > 0 && used_ + counted + kRow_bytes > limits_.total_bytes)
            throw UploadRefused(507, "the desk has taken as much as it may");
        used_ += counted;
    }
    try {
        return std::unique_ptr<Incoming>(new Incoming(*this, bytes, counted));
    } catch (...) {
        used_ -= counted;
        throw;
    }
}

Uploads::Incoming::Incoming(Uploads& uploads, std::uint64_t bytes, std::uint64_t counted)
    : uploads_(uploads), announced_(bytes), counted_(counted), hash_(std::make_unique<Hash>()) {
    std::string name;
    {
        const std::lock_guard lock(uploads_.mutex_);
        name = std::to_string(uploads_.next_aside_++) + ".part";
    }
    aside_ = uploads_.folder_ / "aside" / name;
    fd_ = ::open(aside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (fd_ < 0) files::fail_writing(aside_);
}

Uploads::Incoming::~Incoming() {
    if (fd_ >= 0) ::close(fd_);
    ::unlink(aside_.c_str());
    uploads_.used_ -= counted_;  // 0 once it is stored
}

void Uploads::Incoming::add(std::string_view bytes) {
    received_ += bytes.size();
    if (received_ > announced_) throw UploadRefused(400, "more bytes than announced");
    hash_->add(bytes);
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) throw UploadRefused(507, std::string("the desk's disk takes no more: ") + std::strerror(errno));
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

Uploads::Incoming::Stored Uploads::Incoming::finish(std::string_view expected_sha256, const Sender& sender) {
    if (received_ != announced_) throw UploadRefused(400, "fewer bytes than announced");
    Stored stored;
    stored.sha256 = hash_->hex();
    if (stored.sha256 != expected_sha256) throw UploadRefused(422, "the bytes have another SHA-256: " + stored.sha256);
    stored.name = stored.sha256 + std::string(kEnding);
    if (::fsync(fd_) != 0)
        throw UploadRefused(507, std::string("the desk's disk takes no more: ") + std::strerror(errno));
    const fs::path target = uploads_.folder_ / stored.name;
    stored.fresh = files::rename_to_new(aside_, target);
    if (stored.fresh) {  // these bytes stay counted as used
        uploads_.used_ += received_ - counted_;
        counted_ = 0;
    }
    if (!stored.fresh && fs::file_size(target) != received_) {
        throw std::runtime_error(target.string() + ": is there with another content than its name says");
    }
    files::sync_folder(uploads_.folder_);
    const std::lock_guard lock(uploads_.mutex_);
    uploads_.append_row(stored.sha256, received_, sender);
    return stored;
}

}  // namespace palpa::desk
