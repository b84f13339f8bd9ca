// Arm and pins live: the thread at 1 kHz, and what stands on the other side of it.

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <sys/prctl.h>
#include <thread>

#include "files/cache.h"
#include "files/clock.h"
#include "session/tactile_run_sink.h"
#include "tactile/simulate.h"

namespace palpa::session {
namespace {

constexpr double kReady_s = 8.0;  // proving the boards takes about a second
constexpr std::size_t kRing = 4096;

}  // namespace

// The loop in its thread. A press, if there is one and the touch leads, is read on the grid of its own time, each moment
// once; else the latest contact that was handed over counts.
class TactileThread {
  public:
    TactileThread(std::shared_ptr<const tactile::TactilePlan> plan, std::vector<devices::PressRow> press)
        : plan_(std::move(plan)), port_(*plan_), loop_(make_tactile_loop(plan_)), press_(std::move(press)) {
        on_grid_ = plan_->options.leads == scene::Leads::touch && !press_.empty();
        steps_ = steps_of(press_);
        port_.wait_until_ready(kReady_s);
    }
    ~TactileThread() { end(); }
    TactileThread(const TactileThread&) = delete;
    TactileThread& operator=(const TactileThread&) = delete;

    void start() {
        thread_ = std::thread([this] { run(); });
    }
    void end() {
        ending_ = true;
        if (thread_.joinable()) thread_.join();
    }
    bool finished() const { return finished_; }
    bool take(StepRecord& out) { return ring_->pop(out); }
    tactile::DevicePort& port() { return port_; }
    DeviceLoop<TactileLoop>& loop() { return *loop_; }
    // Once it has ended:
    std::int64_t lost_steps() const { return lost_; }
    DeviceReport report() const {
        DeviceReport report = loop_->report;
        report.late_periods = late_so_far();
        return report;
    }

  private:
    void run() noexcept {
        ::prctl(PR_SET_TIMERSLACK, 1000UL);  // ns; sleeps of ordinary threads end up to 50 us late else
        loop_->report.real_time = platform::set_real_time(true);
        run_ticks(1.0 / tactile::kStep_s, ending_, loop_->report, [this](double now_s) { tick(now_s); });
        finished_ = true;
    }

    void tick(double now_s) noexcept {
        if (began_s_ < 0.0) began_s_ = now_s;
        const double elapsed_s = now_s - began_s_;
        bool sends = false;
        if (on_grid_) {
            const auto due = std::min(steps_, 1 + static_cast<std::int64_t>(std::floor(elapsed_s / tactile::kStep_s)));
            for (; done_ < due; ++done_) {
                const double after_s = tactile::kStep_s * static_cast<double>(done_);
                PenContact contact = contact_of(devices::press_at(press_, press_.front().t_s + after_s, at_));
                contact.time_s = press_.front().t_s + after_s;
                late_ += elapsed_s - after_s > 1e-3;
                sends = step(contact.time_s, &contact) || sends;
            }
        } else {
            PenContact contact;
            const bool touched = loop_->pen.take(contact);
            sends = step(elapsed_s, touched ? &contact : nullptr);
        }
        if (sends) port_.send(now_s, record_.command);
        if (!press_.empty() && elapsed_s >= tactile::kStep_s * static_cast<double>(steps_)) ending_ = true;
    }

    bool step(double time_s, const PenContact* touch) noexcept {
        const std::int64_t before_ns = files::steady_ns();
        const bool sends = tactile_step(time_s, touch, port_, *loop_, record_.command);
        const devices::ArmFeedback& arm = loop_->memory.in.feedback.arm;
        record_.host_s = 1e-9 * static_cast<double>(before_ns);
        record_.sensor_N = arm.sensor_N;
        record_.has_sensor = arm.has_sensor;
        record_.round_trip_s = arm.round_trip_s;
        record_.arm_age_s = arm.age_s;
        record_.lost = port_.link() != nullptr ? port_.link()->feedback.lost : 0;
        record_.late = late_so_far();
        record_.fault = port_.fault();
        record_.fault_words = fault_words(record_.fault, silent_now(arm));
        record_.step_ns = static_cast<double>(files::steady_ns() - before_ns);
        if (sends && !ring_->push(record_)) ++lost_;
        return sends;
    }

    // Of several steps that one period catches up on, each counts.
    std::int64_t late_so_far() const noexcept { return on_grid_ ? late_ : loop_->report.late_periods; }

    Silent silent_now(const devices::ArmFeedback& arm) const noexcept {
        Silent silent;
        silent.arm = plan_->arm && arm.age_s > plan_->arm->silence_s;
        silent.sensor = plan_->arm && devices::is_unfelt(*plan_->arm, arm);
        silent.pins = devices::fault_of(port_.pins().state) == devices::Fault::silence;
        return silent;
    }

    std::shared_ptr<const tactile::TactilePlan> plan_;
    tactile::DevicePort port_;
    std::unique_ptr<DeviceLoop<TactileLoop>> loop_;
    std::vector<devices::PressRow> press_;
    bool on_grid_ = false;
    std::int64_t steps_ = 0;
    std::int64_t done_ = 0;
    std::int64_t late_ = 0;
    std::int64_t lost_ = 0;
    std::size_t at_ = 0;
    double began_s_ = -1.0;
    StepRecord record_;
    std::unique_ptr<devices::SpscRing<StepRecord, kRing>> ring_ =
        std::make_unique<devices::SpscRing<StepRecord, kRing>>();
    std::atomic<bool> ending_{false};
    std::atomic<bool> finished_{false};
    std::thread thread_;
};

namespace {

// Heights that were wanted, kept to be compared with the simulated pins' true ones once these have been written.
struct WantedHeights {
    std::vector<double> host_s;
    std::vector<char> pressed;
    std::vector<double> height_m;
};

void keep(const StepRecord& record, WantedHeights& wanted) {
    wanted.host_s.push_back(record.host_s);
    wanted.pressed.push_back(record.command.pressed ? 1 : 0);
    const auto n = static_cast<std::ptrdiff_t>(record.command.pins);
    wanted.height_m.insert(wanted.height_m.end(), record.command.wanted_m.begin(), record.command.wanted_m.begin() + n);
}

// The mismatch against the latest true heights at each step.
void compare(const WantedHeights& wanted, const std::vector<tactile::TrueHeights>& truth,
             tactile::MismatchMeter& mismatch) {
    if (wanted.host_s.empty() || truth.empty()) return;
    const std::size_t n = wanted.height_m.size() / wanted.host_s.size();
    mismatch = {};
    std::size_t at = 0;
    for (std::size_t k = 0; k < wanted.host_s.size(); ++k) {
        while (at + 1 < truth.size() && truth[at + 1].host_s <= wanted.host_s[k]) ++at;
        if (truth[at].height_m.size() != n) return;
        tactile::add({wanted.height_m.data() + k * n, n}, truth[at].height_m, wanted.pressed[k] != 0, mismatch);
    }
}

void take_all(TactileThread& thread, TactileSink& sink, WantedHeights* wanted) {
    for (StepRecord record; thread.take(record);) {
        sink.take(record, {});
        if (wanted != nullptr && record.fault == devices::Fault::none) keep(record, *wanted);
    }
    sink.take_rows(thread.loop().recorded);
}

void take_devices(TactileThread& thread, const tactile::TactilePlan& plan, TactileSink& sink) {
    tactile::DeviceFigures& devices = sink.result.devices;
    devices.guard = thread.port().guarded().guard;
    if (thread.port().link() != nullptr) tactile::take_link(*thread.port().link(), devices);
    devices.reached_by = plan.pins ? "estimate" : "nothing";
    sink.lost_steps = thread.lost_steps();
}

}  // namespace

TactileResult run_live_press(std::shared_ptr<const tactile::TactilePlan> plan, const TactileRunOptions& options,
                             const std::filesystem::path& heights) {
    TactileThread thread(plan, options.press);
    TactileSink sink(*plan, options.log, rows_in(options.log));
    thread.start();
    WantedHeights wanted;
    WantedHeights* const keeps = heights.empty() ? nullptr : &wanted;
    while (!thread.finished() && !(options.ends && options.ends())) {
        take_all(thread, sink, keeps);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    sink.result.cut = !thread.finished();
    thread.end();
    take_all(thread, sink, keeps);
    take_devices(thread, *plan, sink);
    sink.finish(thread.report());
    if (keeps != nullptr) {
        compare(wanted, tactile::read_heights(heights), sink.result.mismatch);
        sink.result.devices.reached_by = "simulator";
    }
    return std::move(sink.result);
}

struct TactileLive::Works {
    std::shared_ptr<const scene::Plan> scene_plan;  // holds the tissue
    std::shared_ptr<tactile::TactilePlan> plan;
    std::unique_ptr<tactile::Simulators> simulators;
    bool simulated = false;
    std::unique_ptr<TactileSink> sink;
    std::unique_ptr<TactileThread> thread;
    devices::TimeHistogram round_trip;
    TactileMoment moment;
};

namespace {

void fill_moment(const tactile::TactilePlan& plan, const StepRecord& record, TactileMoment& out) {
    const tactile::LoopCommand& step = record.command;
    const bool rendered = record.fault == devices::Fault::none;
    out.time_s = step.time_s;
    out.x_m = step.x_m;
    out.y_m = step.y_m;
    out.depth_m = step.depth_m;
    out.force_N = step.force_N;
    out.sensor_N = record.has_sensor > 0.5 ? record.sensor_N : TactileMoment::kNone;
    out.wanted_m = step.wanted_m;
    out.reached_m = step.reached_m;
    if (!rendered) out.reached_m.fill(plan.pin_rest_m);  // the step knows what was wanted, the guard lets the pins rest
    out.shape_scale = step.shape_scale;
    out.clipped = step.clipped;
    out.linearity = step.linearity;
    out.over_edge = step.over_edge;
    out.held = step.held;
    const bool arm_silent = plan.arm && record.arm_age_s > plan.arm->silence_s;
    out.fault = record.fault_words;
    out.silent_s = arm_silent ? record.arm_age_s : TactileMoment::kNone;
    out.stopped = devices::latches(record.fault);
    out.lost = record.lost;
    const double delay_s = tactile::kStep_s + record.round_trip_s;
    out.stiffness_delay_N_s_per_m = plan.arm ? plan.greatest_stiffness_N_per_m * delay_s : 0.0;
    if (arm_silent) out.stiffness_delay_N_s_per_m = TactileMoment::kNone;  // that of an answer that is over
    double sum_m2 = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(step.pins); ++i) {
        const double off_m = out.reached_m[i] - step.wanted_m[i];
        sum_m2 += off_m * off_m;
    }
    out.mismatch_m = step.pins > 0 ? std::sqrt(sum_m2 / step.pins) : TactileMoment::kNone;
}

TactileMoment moment_at_rest(const tactile::TactilePlan& plan) {
    TactileMoment moment;
    moment.arm = plan.options.arm.has_value();
    moment.force_limit_N = plan.options.force_limit_N;
    if (!plan.pins) return moment;
    moment.rows = plan.pins->grid.rows;
    moment.columns = plan.pins->grid.columns;
    moment.stroke_m = plan.pins->grid.stroke_m;
    moment.reached = ReachedBy::estimate;
    return moment;
}

}  // namespace

TactileLive::TactileLive(const scene::Scene& scene, std::shared_ptr<const scene::Plan> plan,
                         const TactileLiveOptions& options)
    : works_(std::make_unique<Works>()) {
    Works& works = *works_;
    works.scene_plan = std::move(plan);
    works.plan = std::make_shared<tactile::TactilePlan>(tactile::make_tactile_plan(scene, *works.scene_plan));
    if (works.plan->options.leads == scene::Leads::touch) works.plan->input = tactile::InputKind::force;
    works.simulated = options.simulate;
    if (options.simulate) works.simulators = tactile::start_simulators({}, options.seed, *works.plan);
    tactile::make_table_meanwhile(files::cache_folder(), *works.plan);
    works.moment = moment_at_rest(*works.plan);
    works.thread = std::make_unique<TactileThread>(works.plan, std::vector<devices::PressRow>{});
    works.sink = std::make_unique<TactileSink>(*works.plan, options.log, options.rows);
    works.thread->start();
}

TactileLive::~TactileLive() = default;

bool TactileLive::latest(TactileMoment& out) {
    Works& works = *works_;
    bool any = false;
    StepRecord record;
    while (works.thread->take(record)) {
        any = true;
        works.sink->take(record, {});
        if (record.round_trip_s > 0.0) works.round_trip.add(record.round_trip_s);
    }
    works.sink->take_rows(works.thread->loop().recorded);
    if (!any) return false;
    fill_moment(*works.plan, record, works.moment);
    const tactile::StepFigures& figures = works.sink->result.steps;
    works.moment.mismatch_s = tactile::lag_s(works.sink->result.mismatch);
    works.moment.steps = figures.steps;
    works.moment.held_steps = figures.held_steps;
    works.moment.late_steps = record.late;
    works.moment.step_p50_s = 1e-9 * works.sink->step.quantile_ns(0.5);
    works.moment.step_p99_s = 1e-9 * works.sink->step.quantile_ns(0.99);
    works.moment.round_trip_p50_s = works.round_trip.quantile_s(0.5);
    works.moment.round_trip_p99_s = works.round_trip.quantile_s(0.99);
    out = works.moment;
    return true;
}

void TactileLive::hand_over(const PenContact& contact) noexcept { works_->thread->loop().pen.put(contact); }
void TactileLive::stop() noexcept { works_->thread->port().stop(); }
void TactileLive::restart() noexcept { works_->thread->port().release(); }

std::vector<TactileDevice> TactileLive::devices() const { return devices_of(*works_->plan, works_->simulated); }

files::Json TactileLive::report() {
    Works& works = *works_;
    works.thread->end();
    take_all(*works.thread, *works.sink, nullptr);
    take_devices(*works.thread, *works.plan, *works.sink);
    works.sink->finish(works.thread->report());
    const TactileResult& result = works.sink->result;
    return tactile::figures_json(*works.plan, result.steps, result.mismatch, result.devices);
}

std::vector<TactileDevice> devices_of(const tactile::TactilePlan& plan, bool simulated) {
    std::vector<TactileDevice> out;
    if (plan.arm) {
        out.push_back({"arm", plan.arm->name, plan.arm->host + ":" + std::to_string(plan.arm->port), simulated});
        if (plan.arm->sensor)
            out.push_back({"force sensor", plan.arm->name,
                           plan.arm->sensor->host + ":" + std::to_string(plan.arm->sensor->port), simulated});
    }
    if (plan.pin_device) out.push_back({"pins", plan.pin_device->name, plan.pin_device->port, simulated});
    return out;
}

}  // namespace palpa::session
