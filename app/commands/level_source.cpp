#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <stdexcept>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "app/commands/record_calibration.h"
#include "app/screens/calibrate_screen.h"
#include "calibration/record/acquisition.h"
#include "files/input_error.h"
#include "files/text.h"
#include "platform/window.h"
#include "render/gl.h"

namespace palpa::app {
namespace {

// Reads one number per line as it arrives; a level of 0 means that the pen does not touch. The samples have it in the field that
// the profile reads.
class LevelStream : public LevelSource {
  public:
    LevelStream(const std::string& path, const calibration::Profile& profile) : path_(path), profile_(profile) {
        fd_ = path == "-" ? ::dup(0)
                          : ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);  // a pipe may have no writer yet
        if (fd_ < 0) throw files::InputError(path + ": cannot be read: " + std::strerror(errno));
        struct stat status {};
        if (::fstat(fd_, &status) == 0 && S_ISDIR(status.st_mode)) {
            ::close(fd_);
            throw files::bad_input(path, "", "a folder", "a file or a pipe with a level a line");
        }
    }
    ~LevelStream() override { ::close(fd_); }

    bool poll(double wait_s, std::vector<platform::Sample>& out) override {
        pollfd waiting{fd_, POLLIN, 0};
        if (::poll(&waiting, 1, static_cast<int>(std::ceil(1e3 * wait_s))) <= 0) return true;
        std::array<char, 4096> bytes;
        const ssize_t n = ::read(fd_, bytes.data(), bytes.size());
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) return true;
        if (n <= 0) return false;
        const double now_s = devices::steady_s();
        for (ssize_t i = 0; i < n; ++i) {
            if (bytes[static_cast<std::size_t>(i)] != '\n') {
                text_.push_back(bytes[static_cast<std::size_t>(i)]);
                if (text_.size() > kLongest)
                    throw files::bad_input(path_, "line " + std::to_string(line_ + 1),
                                           "more than " + std::to_string(kLongest) + " bytes", "a level a line");
                continue;
            }
            out.push_back(sample(now_s));
            text_.clear();
        }
        return true;
    }

  private:
    static constexpr std::size_t kLongest = 100;  // of a line

    platform::Sample sample(double now_s) {
        ++line_;
        double level = 0.0;
        if (!files::parse_number(text_, level) || !(level >= 0.0) || std::isinf(level)) {
            throw files::bad_input(path_, "line " + std::to_string(line_), files::shown(text_),
                                   "a level >= 0, one a line");
        }
        platform::Sample sample;
        sample.t_host_s = now_s;
        sample.tool = platform::Tool::pen;
        sample.phase = level > 0.0 ? platform::Phase::move : platform::Phase::hover;
        sample.pressure = level;
        sample.pressure_raw = level;
        if (profile_.level == calibration::LevelField::contact_area) {
            calibration::set_level(profile_, level, sample);
            sample.tool = platform::Tool::finger;
        }
        return sample;
    }

    std::string path_;
    const calibration::Profile& profile_;
    std::string text_;
    std::size_t line_ = 0;
    int fd_ = -1;
};

// A window to press on, with the guide that the app's screen shows.
class LevelWindow : public LevelSource {
  public:
    LevelWindow() : window_(options()), gui_(window_) { guide_.makes_profile = false; }  // palpa calibrate fit does

    bool poll(double wait_s, std::vector<platform::Sample>& out) override {
        window_.poll(wait_s, out);
        return !window_.close_requested() && !stopped_;
    }

    void show(calibration::Recording& recording) override {
        constexpr double kShowEvery_s = 1.0 / 60.0;
        const double now_s = window_.now_s();
        if (now_s - shown_s_ < kShowEvery_s) return;
        gui_.begin_frame(now_s - shown_s_, true);
        shown_s_ = now_s;
        refresh_fit(recording, guide_);
        stopped_ = draw_guide(recording, gui_, guide_).stop;
        gui_.end_frame();
        render::clear_screen(window_.width_px(), window_.height_px());
        gui_.draw();
        window_.present();
    }

  private:
    static platform::WindowOptions options() {
        platform::WindowOptions options;
        options.title = "Palpa calibration: press here";
        return options;
    }
    platform::Window window_;
    Gui gui_;
    Guide guide_;
    double shown_s_ = 0.0;
    bool stopped_ = false;
};

}  // namespace

std::unique_ptr<LevelSource> open_level_stream(const std::string& path, const calibration::Profile& profile) {
    return std::make_unique<LevelStream>(path, profile);
}

std::unique_ptr<LevelSource> open_level_window() {
    try {
        return std::make_unique<LevelWindow>();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(
            std::string(error.what()) +
            "\nThe pen's level comes from a window; without a display give levels as text: --levels FILE");
    }
}

}  // namespace palpa::app
