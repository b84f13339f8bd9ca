#pragma once
// A table that a simulator writes while it runs, by a thread of its own: a disk that is busy for a tenth of a second must not
// silence the simulated device.

#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace palpa::devices::simulators {

class TruthFile {
  public:
    // An empty path: nothing is written. Throws std::runtime_error if the file cannot be written.
    explicit TruthFile(const std::string& path)
        : path_(path), file_(path.empty() ? nullptr : std::fopen(path.c_str(), "w")) {
        if (path.empty()) return;
        if (file_ == nullptr) throw std::runtime_error(path + ": cannot be written");
        thread_ = std::thread([this] { run(); });
    }
    ~TruthFile() {
        if (file_ == nullptr) return;
        ending_.store(true);
        thread_.join();
        if (std::fclose(file_) != 0 || failed_)
            std::fprintf(stderr, "%s: could not be written to its end\n", path_.c_str());
    }
    TruthFile(const TruthFile&) = delete;
    TruthFile& operator=(const TruthFile&) = delete;

    bool wanted() const { return file_ != nullptr; }
    void add(const std::string& line) {
        const std::lock_guard<std::mutex> guard(text_guard_);
        text_ += line;
    }

  private:
    void run() {
        for (bool ending = false; !ending;) {
            ending = ending_.load();
            std::string text;
            {
                const std::lock_guard<std::mutex> guard(text_guard_);
                text.swap(text_);
            }
            failed_ = std::fwrite(text.data(), 1, text.size(), file_) != text.size() || failed_;
            failed_ = std::fflush(file_) != 0 || failed_;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

    std::string path_;
    std::FILE* file_;
    bool failed_ = false;  // of the thread, until it has ended
    std::mutex text_guard_;
    std::string text_;
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

}  // namespace palpa::devices::simulators
