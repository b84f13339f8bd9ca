#include "devices/guard/shape_server.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <poll.h>
#include <sys/socket.h>

#include "devices/force_sensor.h"
#include "platform/real_time.h"

namespace palpa::devices::guard {
namespace {

constexpr double kPinsEvery_s = 0.02;  // from one look at the boards' health to the next
constexpr double kAlone_s = 0.002;     // from one rest to the next while no commands come
constexpr double kShapeReport_s = 0.01;

class ShapeServer {
  public:
    ShapeServer(const ShapeRig& rig, int socket) : rig_(rig), limits_(limits_of(rig)), socket_(socket) {
        if (rig.arm) arm_ = open_arm(*rig.arm);
        if (rig.pins) pins_ = std::make_unique<PinDriver>(*rig.pins);
    }

    void run(const volatile int& ended) {
        platform::set_real_time(true, platform::kGuardPriority);
        report();
        while (ended == 0 && !parent_gone_) look();
        latch(Fault::parent_gone, guard_);
        rest();
    }

  private:
    void look() {
        std::array<pollfd, 2> waiting{{{socket_, POLLIN, 0}, {arm_ ? arm_->fd() : -1, POLLIN, 0}}};
        ::poll(waiting.data(), waiting.size(), 1);
        const bool heard = arm_ && arm_->read(newest_);
        fresh_ = fresh_ || heard;
        readings_ += heard;
        sensed_ = sensed_ || newest_.has_sensor > 0.5;
        watch();  // before what has queued while the guard itself stood still is taken for new
        const bool commanded = receive();
        watch();
        const double now_s = steady_s();
        if (!driven_ && now_s - sent_s_ >= kAlone_s) rest();
        if (heard || commanded || now_s - reported_s_ >= kShapeReport_s) report();
    }

    void watch() {
        if (!driven_ || steady_s() - commanded_s_ <= kLoopSilence_s) return;
        latch(Fault::loop_silent, guard_);
        driven_ = false;
    }

    bool receive() {
        bool commanded = false;
        for (GuardMessage message;;) {
            const ssize_t n = ::recv(socket_, &message, sizeof message, MSG_DONTWAIT | MSG_TRUNC);
            if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) parent_gone_ = true;
            if (n <= 0) return commanded;
            commanded = true;
            if (!is_whole(message, static_cast<std::size_t>(n))) {
                latch(Fault::not_a_number, guard_);
            } else if (message.word == GuardWord::stop) {
                devices::stop(guard_);
            } else if (message.word == GuardWord::release) {
                devices::release(guard_);
            } else {
                drive({message.value, message.values});
            }
        }
    }

    void drive(std::span<const double> values) {
        const std::size_t pins = rig_.pins ? rig_.pins->pins.size() : 0;
        if (values.size() != kArmValues + pins) return latch(Fault::not_a_number, guard_);
        driven_ = true;
        commanded_s_ = steady_s();
        send({values[0], values[1], values[2], values[3]}, values.subspan(kArmValues));
    }

    void rest() {
        const std::vector<double> heights_m(rig_.pins ? rig_.pins->pins.size() : 0, limits_.pin_rest_m);
        send({}, heights_m);
    }

    // Nothing reaches a wire but through here.
    void send(ArmCommand command, std::span<const double> wanted_m) {
        sent_s_ = steady_s();
        if (pins_ && sent_s_ >= pins_due_s_) {
            pins_due_s_ = sent_s_ + kPinsEvery_s;
            found_ = fault_of(pins_->health().state);
        }
        const bool unfelt = sensed_ && rig_.arm && is_unfelt(*rig_.arm, newest_);
        const Fault found = found_ == Fault::none && unfelt ? Fault::silence : found_;
        begin_tick(limits_, sent_s_, fresh_ || !arm_, arm_ ? &newest_ : nullptr, guard_, found);
        fresh_ = false;
        if (arm_) {
            guard_arm(limits_, command, guard_);
            arm_->send(command);
        }
        if (!pins_ || wanted_m.empty()) return;
        std::array<double, kMostPins> heights_m{};
        const std::size_t n = std::min(wanted_m.size(), kMostPins);
        std::copy_n(wanted_m.begin(), n, heights_m.begin());
        guard_pins(limits_, std::span(heights_m).first(n), guard_);
        pins_->send(std::span(heights_m).first(n));
    }

    void report() {
        reported_s_ = steady_s();
        report_.fault = guard_.fault;
        report_.count = guard_.count;
        report_.limited = guard_.limited;
        report_.slewed = guard_.slewed;
        report_.arm = newest_;
        report_.arm_readings = readings_;
        report_.arm_heard = readings_ > 0;
        if (pins_) report_.pins = pins_->health();
        if (arm_) {
            const LinkHealth& link = arm_->health();
            report_.sent = link.sent;
            report_.unsent = link.unsent;
            report_.arm_rested = link.arm_rested;
            report_.arm_feedback = link.feedback;
        }
        const bool sensed = !rig_.arm || !rig_.arm->sensor || newest_.has_sensor > 0.5;
        report_.ready = (!arm_ || readings_ > 0) && sensed && (!pins_ || report_.pins.state == PinState::driving);
        // without a reader the report is lost; the next one says the same
        static_cast<void>(::send(socket_, &report_, sizeof report_, MSG_DONTWAIT | MSG_NOSIGNAL));
    }

    ShapeRig rig_;
    Limits limits_;
    int socket_;
    Guard guard_;
    std::unique_ptr<ArmPort> arm_;
    std::unique_ptr<PinDriver> pins_;
    ArmFeedback newest_;
    ShapeReport report_;
    Fault found_ = Fault::none;
    std::int64_t readings_ = 0;
    bool fresh_ = false;
    bool sensed_ = false;  // the force sensor has had its zero
    bool driven_ = false;
    bool parent_gone_ = false;
    double commanded_s_ = 0.0;
    double sent_s_ = 0.0;
    double reported_s_ = 0.0;
    double pins_due_s_ = 0.0;
};

}  // namespace

void serve_shape(const ShapeRig& rig, int socket, const volatile int& ended) { ShapeServer(rig, socket).run(ended); }

}  // namespace palpa::devices::guard
