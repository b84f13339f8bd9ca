#include "session/raster_trace.h"

#include <cmath>
#include <numbers>
#include <random>

namespace palpa::session {
namespace {

struct Line {
    Eigen::Vector2d from_m;
    Eigen::Vector2d to_m;
};

std::vector<Line> lines_over(const scene::Plan& plan) {
    const Eigen::Vector2d low = plan.area.centre_m - 0.45 * plan.area.size_m;
    const Eigen::Vector2d high = plan.area.centre_m + 0.45 * plan.area.size_m;
    std::vector<double> ys{plan.area.centre_m.y()};
    std::vector<double> xs;
    for (const stiffnessmaps::Nodule& nodule : plan.nodules) {
        ys.push_back(nodule.y_m);
        xs.push_back(nodule.x_m);
    }
    ys.push_back(high.y());
    xs.push_back(high.x());
    std::vector<Line> lines;
    for (const double y : ys) lines.push_back({{low.x(), y}, {high.x(), y}});
    for (const double x : xs) lines.push_back({{x, low.y()}, {x, high.y()}});
    for (std::size_t i = 1; i < lines.size(); i += 2) std::swap(lines[i].from_m, lines[i].to_m);
    return lines;
}

// A part answers along its load: strokes from where it is touched to its far side, through its middle and beside it. A load
// that goes into the picture is swept as tissue is.
std::vector<Line> lines_on_part(const scene::PartTissue& tissue) {
    const bool up = std::abs(tissue.direction_m[1]) >= std::abs(tissue.direction_m[0]);
    const Eigen::Vector2d along = up ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX();
    const Eigen::Vector2d direction = std::copysign(1.0, tissue.direction_m[up ? 1 : 0]) * along;
    const Eigen::Vector2d across = Eigen::Vector2d::Ones() - along;
    const bool pulls = tissue.options.gesture == scene::PartGesture::pull;
    std::vector<Line> lines;
    for (const scene::PartDesign& design : tissue.designs) {
        for (const double share : {0.5, 0.9, 0.1, 0.7, 0.3}) {
            const Eigen::Vector2d middle_m =
                design.origin_m + across.cwiseProduct(share * design.size_m) + along.cwiseProduct(0.5 * design.size_m);
            const double half_m = 0.5 * along.dot(design.size_m);
            Line line{middle_m - half_m * direction, middle_m + half_m * direction};
            // a pull holds what is under the pen at its start; without material there the stroke pulls nothing
            const Eigen::Vector2d step_m = design.part.voxels.frame.pitch_m * direction;
            while (pulls && !scene::is_on_part(design, line.from_m) && (line.to_m - line.from_m).dot(direction) > 0.0)
                line.from_m += step_m;
            if ((line.to_m - line.from_m).dot(direction) > 0.0) lines.push_back(line);
        }
    }
    return lines;
}

double rounded(double value, double step) { return std::round(value / step) * step; }

class Pen {
  public:
    Pen(const scene::Scene& scene, const scene::Plan& plan, const RasterOptions& options,
        const std::function<void(const platform::Sample&)>& take)
        : plan_(plan), options_(options), take_(take), random_(options.seed), force_scale_(scene.force_scale) {
        view_ = scene::make_view(scene.mapping, plan.area, {options.screen_width_px, options.screen_height_px});
    }

    void draw(const Line& line) {
        const double length_m = (line.to_m - line.from_m).norm();
        const int n = static_cast<int>(length_m / options_.speed_m_per_s * options_.rate_Hz);
        add(platform::Phase::hover, line.from_m, 0.0);
        for (int i = 0; i <= n; ++i) {
            const double s = static_cast<double>(i) / n;
            const Eigen::Vector2d jitter_m(2e-5 * normal_(random_), 2e-5 * normal_(random_));
            const double force_N = options_.force_N * (1.0 + 0.1 * std::sin(2.0 * std::numbers::pi * 0.7 * t_s_));
            add(i == 0 ? platform::Phase::down : platform::Phase::move,
                line.from_m + s * (line.to_m - line.from_m) + jitter_m, force_N);
        }
        add(platform::Phase::up, line.to_m, 0.0);
        t_s_ += 0.3;
    }

    double last_s() const { return last_s_; }  // of the samples

  private:
    void add(platform::Phase phase, const Eigen::Vector2d& p_m, double force_N) {
        platform::Sample sample;
        sample.t_host_s = rounded(t_s_, 1e-6);
        sample.t_device_s = rounded(t_s_, 1e-6);
        sample.pointer_id = 1;
        const bool finger = plan_.profile.level == calibration::LevelField::contact_area;
        sample.tool = finger ? platform::Tool::finger : platform::Tool::pen;
        sample.phase = phase;
        const Eigen::Vector2d screen_m = view_.axes * (p_m - view_.area.centre_m);
        const Eigen::Vector2d px = view_.centre_px + screen_m.cwiseProduct(view_.input_px_per_m);
        sample.x_px = rounded(px.x(), 1e-2);
        sample.y_px = rounded(px.y(), 1e-2);
        const double level = force_N > 0.0 ? calibration::level_at_force(plan_.profile, force_N / force_scale_) : 0.0;
        const double share = level / plan_.profile.level_highest;
        constexpr double kLevels = 4096.0;
        sample.pressure_raw = plan_.profile.level == calibration::LevelField::pressure_raw
                                  ? std::round(level)
                                  : std::round(share * kLevels);
        sample.pressure = rounded(share, 1.0 / kLevels);
        if (finger) calibration::set_level(plan_.profile, level, sample);
        take_(sample);
        last_s_ = t_s_;
        t_s_ += 1.0 / options_.rate_Hz;
    }

    const scene::Plan& plan_;
    RasterOptions options_;
    const std::function<void(const platform::Sample&)>& take_;
    scene::View view_;
    double t_s_ = 0.0;
    double last_s_ = 0.0;
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    double force_scale_;
};

}  // namespace

platform::TraceInfo raster_info(const RasterOptions& options) {
    platform::TraceInfo info;
    info.screen_width_px = options.screen_width_px;
    info.screen_height_px = options.screen_height_px;
    info.device = "simulated pen, raster";
    return info;
}

void draw_raster(const scene::Scene& scene, const scene::Plan& plan, const RasterOptions& options,
                 const std::function<void(const platform::Sample&)>& take) {
    Pen pen(scene, plan, options, take);
    const scene::PartTissue* part = scene::parts_of(plan.tissue);
    const bool along = part != nullptr && scene::in_plane(*part);
    const std::vector<Line> lines = along ? lines_on_part(*part) : lines_over(plan);
    for (std::size_t i = 0; pen.last_s() < options.seconds; ++i) pen.draw(lines[i % lines.size()]);
}

platform::Trace raster_trace(const scene::Scene& scene, const scene::Plan& plan, const RasterOptions& options) {
    platform::Trace trace{raster_info(options), {}};
    draw_raster(scene, plan, options, [&](const platform::Sample& sample) { trace.samples.push_back(sample); });
    return trace;
}

}  // namespace palpa::session
