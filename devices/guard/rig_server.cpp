#include "devices/guard/rig_server.h"

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "devices/guard_link.h"
#include "devices/line_io.h"
#include "platform/real_time.h"

namespace palpa::devices::guard {
namespace {

constexpr double kReport_s = 0.01;
constexpr int kLook_ms = 2;  // from one look at lines and silences to the next

struct SensorNow {
    double m = std::numeric_limits<double>::quiet_NaN();
    double host_s = -1e9;
    double device_s = 0.0;
    std::int64_t readings = 0;
    SensorHealth health;
};

// The displacement, read in a thread of its own.
class SensorWatch {
  public:
    explicit SensorWatch(const RigSensor& sensor)
        : sensor_(sensor),
          stream_(sensor.place),
          poke_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
          thread_([this] { run(); }) {}
    ~SensorWatch() {
        ending_.store(true);
        thread_.join();
        ::close(poke_);
    }
    SensorWatch(const SensorWatch&) = delete;
    SensorWatch& operator=(const SensorWatch&) = delete;

    int poke() const { return poke_; }  // readable when there is a new reading
    SensorNow now() const {
        const std::lock_guard<std::mutex> guard(copy_guard_);
        return copy_;
    }

  private:
    void run() {
        platform::set_real_time(true, platform::kGuardPriority);
        std::vector<CountsReading> readings;
        readings.reserve(1024);
        while (!ending_.load()) {
            readings.clear();
            stream_.read(0.01, readings);
            take(readings);
        }
    }

    void take(const std::vector<CountsReading>& readings) {
        const std::lock_guard<std::mutex> guard(copy_guard_);
        copy_.health = stream_.health();
        if (readings.empty()) return;
        const CountsReading& last = readings.back();
        copy_.m = sensor_.m_per_count * (last.counts - sensor_.zero_counts);
        copy_.host_s = last.t_host_s;
        copy_.device_s = last.t_device_s;
        copy_.readings += static_cast<std::int64_t>(readings.size());
        ::eventfd_write(poke_, 1);
    }

    RigSensor sensor_;
    CountsStream stream_;
    int poke_;
    mutable std::mutex copy_guard_;
    SensorNow copy_;
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

class RigServer {
  public:
    RigServer(const ActuatorRig& rig, int socket) : rig_(rig), socket_(socket), guard_(make_rig_guard(rig)) {
        for (std::size_t i = 0; i < rig.ports.size(); ++i) lines_.push_back(std::make_unique<ActuatorLine>(rig, i));
        if (!rig.sensor.empty()) sensor_ = std::make_unique<SensorWatch>(rig.sensor.front());
        report_.measured.fill(std::numeric_limits<double>::quiet_NaN());
    }

    void run(const volatile int& ended) {
        platform::set_real_time(true, platform::kGuardPriority);
        report();
        while (ended == 0 && guard_.count[static_cast<std::size_t>(Fault::parent_gone)] == 0) look();
        latch(rig_, Fault::parent_gone, guard_);
        drive();  // all lines at once, before each is waited for
    }

  private:
    void look() {
        std::array<pollfd, 2> waiting{{{socket_, POLLIN, 0}, {sensor_ ? sensor_->poke() : -1, POLLIN, 0}}};
        ::poll(waiting.data(), waiting.size(), kLook_ms);
        const bool sensed = (waiting[1].revents & POLLIN) != 0;
        if (sensed) {
            eventfd_t ignored = 0;
            ::eventfd_read(sensor_->poke(), &ignored);
        }
        watch(rig_, steady_s(), found(),
              guard_);  // before what has queued while the guard stood still is taken for new
        const bool commanded = receive();
        watch(rig_, steady_s(), found(), guard_);
        drive();
        if (commanded || sensed || steady_s() - reported_s_ >= kReport_s) report();
    }

    // Returns whether a command came.
    bool receive() {
        bool commanded = false;
        for (GuardMessage message;;) {
            const ssize_t n = ::recv(socket_, &message, sizeof message, MSG_DONTWAIT | MSG_TRUNC);
            if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) latch_end();
            if (n <= 0) return commanded;
            if (!is_whole(message, static_cast<std::size_t>(n))) {
                latch(rig_, Fault::not_a_number, guard_);
                continue;
            }
            obey(message);
            commanded = true;
        }
    }

    void latch_end() {
        release(rig_, guard_);
        latch(rig_, Fault::parent_gone, guard_);
    }

    void obey(const GuardMessage& message) {
        switch (message.word) {
            case GuardWord::command:
                ++commands_;
                return take_command(rig_, steady_s(), {message.value, message.values}, guard_);
            case GuardWord::stop:
                return latch(rig_, Fault::stopped, guard_);
            case GuardWord::release:
                return release(rig_, guard_);
        }
    }

    // What lines and sensor say against driving.
    Fault found() {
        ready_ = relaxed_ = true;
        Fault worst = Fault::none;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            report_.line[i] = lines_[i]->health();
            const Fault fault = fault_of(report_.line[i].state);
            if (worst == Fault::none) worst = fault;
            ready_ = ready_ && report_.line[i].state == PinState::driving;
            relaxed_ = relaxed_ && report_.line[i].relaxed;
        }
        if (sensor_) {
            const SensorNow now = sensor_->now();
            const bool silent = steady_s() - now.host_s > rig_.sensor.front().silence_s;
            if (silent && worst == Fault::none) worst = Fault::silence;
            ready_ = ready_ && !silent;
        }
        return guard_.driven ? worst : Fault::none;
    }

    void drive() {
        for (const auto& line : lines_) line->send(guard_.value, !guard_.driven);
    }

    void report() {
        reported_s_ = steady_s();
        report_.fault = guard_.fault;
        report_.driven = guard_.driven;
        report_.ready = ready_;
        report_.relaxed = relaxed_ && !guard_.driven;
        report_.commands = commands_;
        report_.limited = guard_.limited;
        report_.slewed = guard_.slewed;
        report_.scaled = guard_.scaled;
        report_.sent = guard_.value;
        for (std::size_t i = 0; i < rig_.channels.size(); ++i)
            report_.measured[i] = lines_[rig_.channels[i].port]->measured(i);
        if (sensor_) {
            const SensorNow now = sensor_->now();
            report_.displacement_m = now.m;
            report_.displacement_time_s = now.host_s;
            report_.displacement_device_s = now.device_s;
            report_.displacement_count = now.readings;
            report_.sensor = now.health;
        }
        // without a reader the report is lost; the next one says the same
        static_cast<void>(::send(socket_, &report_, sizeof report_, MSG_DONTWAIT | MSG_NOSIGNAL));
    }

    ActuatorRig rig_;
    int socket_;
    RigGuard guard_;
    std::vector<std::unique_ptr<ActuatorLine>> lines_;
    std::unique_ptr<SensorWatch> sensor_;
    RigReport report_;
    double reported_s_ = 0.0;
    std::int64_t commands_ = 0;
    bool ready_ = false;
    bool relaxed_ = false;
};

}  // namespace

void serve_rig(const ActuatorRig& rig, int socket, const volatile int& ended) { RigServer(rig, socket).run(ended); }

}  // namespace palpa::devices::guard
