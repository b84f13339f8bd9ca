#pragma once
// The folder in which a desk collects what tablets send:
//     DIR/<sha256>.upload   whole uploads, under a name made of their own bytes
//     DIR/index.tsv         what came when from which tablet; rows are only appended
//     DIR/aside/            uploads that are on their way; emptied at each start
//     DIR/sessions.json     which tablets are paired (desk/pairing.h)
// An upload gets its name when all of it is on the disk. Nothing is ever overwritten.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::desk {

struct UploadLimits {
    std::uint64_t upload_bytes = std::uint64_t{64} << 20;
    std::uint64_t total_bytes = std::uint64_t{16} << 30;  // of all uploads together
};

// Says why an upload is not taken, with the HTTP status.
struct UploadRefused : std::runtime_error {
    UploadRefused(int http_status, const std::string& why) : std::runtime_error(why), status(http_status) {}
    int status;
};

struct Sender {
    std::string label;  // as sane_label() leaves it
    int device = 0;     // number of the tablet (desk/pairing.h); 0 if it is not paired
    std::string address;
};

// Returns the name that a client gives its upload, 1 to 64 characters, with `_` for all but letters, digits, dot, hyphen
// and underscore.
std::string sane_label(std::string_view label);

// May be called by many threads.
class Uploads {
  public:
    // Makes the folder or continues in it; `notes` says what was found there (files that are not in the index, lines that
    // cannot be read). Throws InputError if another desk collects there, std::runtime_error if the folder cannot be written.
    Uploads(const std::filesystem::path& folder, const UploadLimits& limits, std::vector<std::string>& notes);
    ~Uploads();
    Uploads(const Uploads&) = delete;
    Uploads& operator=(const Uploads&) = delete;

    // One upload on its way. Unless finish() completes, nothing is left of it.
    class Incoming {
      public:
        ~Incoming();
        Incoming(const Incoming&) = delete;
        Incoming& operator=(const Incoming&) = delete;
        // Throws UploadRefused if there is more than was announced, or the disk is full.
        void add(std::string_view bytes);
        struct Stored {
            std::string sha256;
            std::string name;
            bool fresh = true;  // false if the same bytes were there already
        };
        // When it returns, the upload and its row of the index are on the disk. Throws UploadRefused if bytes are missing
        // or the hash differs.
        Stored finish(std::string_view expected_sha256, const Sender& sender);

      private:
        friend class Uploads;
        Incoming(Uploads& uploads, std::uint64_t bytes, std::uint64_t counted);
        Uploads& uploads_;
        std::uint64_t announced_;
        std::uint64_t counted_;  // as used
        std::uint64_t received_ = 0;
        std::filesystem::path aside_;
        int fd_ = -1;
        struct Hash;
        std::unique_ptr<Hash> hash_;
    };
    // Throws UploadRefused if there is no room for so many bytes; what is stored already, by its hash, needs none.
    // `Incoming` must not outlive this.
    std::unique_ptr<Incoming> begin(std::uint64_t bytes, std::string_view expected_sha256 = {});

    std::uint64_t stored_bytes() const { return used_; }
    const std::filesystem::path& folder() const { return folder_; }

  private:
    void lock_folder();
    void read_index(std::vector<std::string>& notes);
    void adopt(const std::filesystem::path& file, std::vector<std::string>& notes);
    void append_row(const std::string& sha256, std::uint64_t bytes, const Sender& sender);

    std::filesystem::path folder_;
    UploadLimits limits_;
    int lock_fd_ = -1;
    std::mutex mutex_;               // guards all members below
    std::set<std::string> indexed_;  // sha256
    std::set<std::string> rows_;     // sha256, label and device, so that a repeated upload has one row
    std::uint64_t next_aside_ = 1;
    std::atomic<std::uint64_t> used_ = 0;  // bytes stored and announced, with the index
};

}  // namespace palpa::desk
