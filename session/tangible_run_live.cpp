// A soft device live: the thread at the loop's rate, and what stands on the other side of it.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "devices/guard_process.h"
#include "devices/spsc_ring.h"
#include "files/clock.h"
#include "mechanics/band_matrix.h"
#include "session/tangible_body.h"
#include "session/tangible_run_sink.h"

namespace palpa::session {
namespace {

using tangible::TangibleCommand;
using tangible::TangibleFeedback;
using tangible::TangiblePlan;

constexpr double kReady_s = 8.0;  // proving lines takes a second or two
constexpr std::size_t kRing = 1024;
constexpr double kShapeEvery_s = 1.0 / 30.0;

}  // namespace

// The device's ports behind the guard, which is a process of its own.
class TangibleRigPort {
  public:
    TangibleRigPort(const TangiblePlan& plan, const std::vector<std::string>& ports)
        : plan_(plan), rig_(tangible_rig(*plan.model, ports)), guard_(rig_) {
        guard_.wait_until_ready(kReady_s);
    }

    TangibleFeedback read(double began_s) noexcept {
        guard_.poll(report_);
        TangibleFeedback out;
        if (report_.displacement_count > 0) {  // NaN before the first
            out.sensor_m = report_.displacement_m;
            out.sensor_s = report_.displacement_time_s - began_s;
            out.has_sensor = 1.0;
        }
        out.stopped = report_.fault != devices::Fault::none ? 1.0 : 0.0;
        return out;
    }

    // The guard has the last word on every value; a silent loop is one of its faults.
    void send(const TangibleCommand& command) noexcept {
        std::array<double, tangible::kMostActuators> values{};
        for (std::size_t j = 0; j < rig_.channels.size(); ++j)
            values[j] = rig_.channels[j].drive == devices::Drive::length ? command.length[j] : command.actuation[j];
        guard_.send({values.data(), rig_.channels.size()});
    }

    void stop() noexcept { guard_.stop(); }
    void release() noexcept { guard_.release(); }
    const devices::RigReport& report() const noexcept { return report_; }

  private:
    const TangiblePlan& plan_;
    devices::ActuatorRig rig_;
    devices::GuardProcess guard_;
    devices::RigReport report_;
};

// The loop in its thread, on a plant or on ports.
class TangibleThread {
  public:
    TangibleThread(std::shared_ptr<const TangiblePlan> plan, const std::optional<tangible::Plant>& plant,
                   const std::vector<std::string>& ports, const Finger& finger, bool pen_pushes, std::uint64_t seed)
        : plan_(std::move(plan)), plant_(plant), loop_(make_tangible_loop(plan_)), shape_nodes_(surface_nodes(*plan_)) {
        if (plant_) {
            model_.emplace(*plan_, *plant_, finger, seed);
            model_->pen_pushes = pen_pushes;
        } else {
            rig_.emplace(*plan_, ports);
        }
        seconds_ = pen_pushes || (!plant_ && finger.seconds <= 0.0) ? std::numeric_limits<double>::infinity()
                                                                    : seconds_of(finger);
    }
    ~TangibleThread() { end(); }
    TangibleThread(const TangibleThread&) = delete;
    TangibleThread& operator=(const TangibleThread&) = delete;

    void start() {
        mechanics::bring_back_threads();  // the guard has been forked
        thread_ = std::thread([this] { run(); });
    }
    void end() {
        ending_ = true;
        if (thread_.joinable()) thread_.join();
    }
    bool finished() const { return finished_; }
    bool has_end() const { return std::isfinite(seconds_); }  // else it goes on until somebody ends it
    devices::RigReport guard() const { return rig_ ? rig_->report() : devices::RigReport{}; }  // once it has ended
    bool take(TickRecord& out) { return ring_->pop(out); }
    bool take(TangibleShape& out) { return shapes_->take(out); }
    DeviceLoop<TangibleLoop>& loop() { return *loop_; }
    std::int64_t lost_ticks() const { return lost_; }  // once it has ended
    bool simulated() const { return plant_.has_value(); }
    void stop() noexcept {
        stopped_ = true;
        if (rig_) rig_->stop();
    }
    void release() noexcept {
        stopped_ = false;
        if (rig_) rig_->release();
    }

  private:
    void run() noexcept {
        loop_->report.real_time = platform::set_real_time(true);
        run_ticks(plan_->loop.rate_Hz, ending_, loop_->report, [this](double now_s) { tick(now_s); });
        finished_ = true;
    }

    void tick(double now_s) noexcept {
        const std::int64_t before_ns = files::steady_ns();
        if (began_s_ < 0.0) began_s_ = now_s;
        const double time_s = now_s - began_s_;
        PenContact contact;
        const bool touched = loop_->pen.take(contact);
        if (touched && model_) model_->pen_N = contact.down > 0.5 ? plan_->world.finger_share * contact.normal_N : 0.0;
        TangibleFeedback feedback = model_ ? model_->read(time_s) : rig_->read(began_s_);
        if (stopped_) feedback.stopped = 1.0;
        const bool sends = tangible_step(time_s, touched ? &contact : nullptr, feedback, *loop_, record_.command);
        record_.tick_ns = static_cast<double>(files::steady_ns() - before_ns);
        if (sends && model_) {
            model_->send(time_s, record_.command);
            record_.rendered_N = model_->rendered_N();
        } else if (sends) {
            rig_->send(record_.command);
        }
        record_.sensor_m = feedback.sensor_m;
        if (rig_) record_.guard = rig_->report().fault;
        record_.missed = loop_->report.missed_periods;
        record_.period_ns = last_ns_ > 0 ? static_cast<double>(before_ns - last_ns_) : 0.0;
        last_ns_ = before_ns;
        if (sends && !ring_->push(record_)) ++lost_;
        if (time_s >= shape_due_s_) hand_on_shape(time_s);
        if (time_s >= seconds_) ending_ = true;
    }

    void hand_on_shape(double time_s) noexcept {
        shape_due_s_ = time_s + kShapeEvery_s;
        fill_shape(*plan_, shape_nodes_, loop_->memory.state.device, shape_);
        shapes_->put(shape_);
    }

    std::shared_ptr<const TangiblePlan> plan_;
    std::optional<tangible::Plant> plant_;
    std::optional<PlantPort> model_;
    std::optional<TangibleRigPort> rig_;
    std::unique_ptr<DeviceLoop<TangibleLoop>> loop_;
    std::vector<int> shape_nodes_;
    double seconds_ = 0.0;
    double began_s_ = -1.0;
    double shape_due_s_ = 0.0;
    std::int64_t last_ns_ = 0;
    std::int64_t lost_ = 0;
    TickRecord record_;
    TangibleShape shape_;
    std::unique_ptr<LatestValue<TangibleShape>> shapes_ = std::make_unique<LatestValue<TangibleShape>>();
    std::unique_ptr<devices::SpscRing<TickRecord, kRing>> ring_ =
        std::make_unique<devices::SpscRing<TickRecord, kRing>>();
    std::atomic<bool> stopped_{false};
    std::atomic<bool> ending_{false};
    std::atomic<bool> finished_{false};
    std::thread thread_;
};

TangibleResult run_tangible_live(std::shared_ptr<const TangiblePlan> plan, const std::optional<tangible::Plant>& plant,
                                 const std::vector<std::string>& ports, const TangibleRunOptions& options) {
    TangibleThread thread(plan, plant, ports, options.finger, false, options.seed);
    const std::filesystem::path rows =
        options.log.empty() ? options.log : device_rows_of(options.log / "press.tsv", "tangible");
    TangibleSink sink(*plan, options.log, rows);
    thread.start();
    TickRecord record;
    const auto take_all = [&] {
        while (thread.take(record)) sink.take(record);
        sink.take_rows(thread.loop().recorded);
    };
    while (!thread.finished() && !(options.ends && options.ends())) {
        take_all();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    sink.result.cut = !thread.finished() && thread.has_end();
    thread.end();
    take_all();
    sink.lost_ticks = thread.lost_ticks();
    const devices::RigReport guard = thread.guard();
    sink.result.guard = guard.fault;
    sink.result.guarded = {guard.commands, guard.limited, guard.slewed, guard.scaled};
    sink.finish(thread.loop().report);
    return std::move(sink.result);
}

struct TangibleLive::Works {
    std::shared_ptr<const scene::Plan> scene_plan;  // holds the tissue
    std::shared_ptr<const TangiblePlan> plan;
    std::unique_ptr<TangibleSink> sink;
    std::unique_ptr<TangibleThread> thread;
    TangibleBody body;
    TangibleMoment moment;
};

TangibleLive::TangibleLive(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan,
                           const TangibleLiveOptions& options)
    : works_(std::make_unique<Works>()) {
    Works& works = *works_;
    works.scene_plan = std::move(plan);
    TangiblePlan made = tangible::make_tangible_plan(scene, *works.scene_plan);
    std::string name = scene.tangible->plant;
    if (name.empty() && options.simulate) name = "exact";
    if (name.empty()) tangible::command_as_wired(false, made);
    works.plan = std::make_shared<const TangiblePlan>(std::move(made));
    std::optional<tangible::Plant> plant;
    if (!name.empty()) plant = make_plant(works.plan->model, tangible::read_plant(name), works.plan->loop);
    works.thread = std::make_unique<TangibleThread>(works.plan, plant, std::vector<std::string>{}, Finger{},
                                                    plant.has_value(), options.seed);
    works.body = body_of(*works.plan, plant ? "plant" : "model");
    works.sink = std::make_unique<TangibleSink>(*works.plan, options.log, options.rows);
    works.thread->start();
}

TangibleLive::~TangibleLive() = default;

bool TangibleLive::latest(TangibleMoment& out) {
    Works& works = *works_;
    bool any = false;
    TickRecord record;
    while (works.thread->take(record)) {
        any = true;
        works.sink->take(record);
    }
    works.sink->take_rows(works.thread->loop().recorded);
    if (!any) return false;
    fill_moment(record, *works.sink, works.plan->loop.rate_Hz, works.moment);
    out = works.moment;
    return true;
}

bool TangibleLive::latest(TangibleShape& out) { return works_->thread->take(out); }
void TangibleLive::hand_over(const PenContact& contact) noexcept { works_->thread->loop().pen.put(contact); }
void TangibleLive::stop() noexcept { works_->thread->stop(); }
void TangibleLive::restart() noexcept { works_->thread->release(); }
const TangibleBody& TangibleLive::body() const { return works_->body; }

std::vector<TactileDevice> TangibleLive::devices() const {
    return devices_of(*works_->plan, works_->thread->simulated());
}

files::Json TangibleLive::report() {
    Works& works = *works_;
    works.thread->end();
    TickRecord record;
    while (works.thread->take(record)) works.sink->take(record);
    works.sink->take_rows(works.thread->loop().recorded);
    works.sink->finish(works.thread->loop().report);
    return tangible::figures_json(*works.plan, works.sink->result.ticks, works.sink->result.clock);
}

}  // namespace palpa::session
