#include "devices/pin_calibration.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "files/text.h"

namespace palpa::devices {
namespace {

std::string pin_name(const PinDevice& device, std::size_t pin) {
    const auto columns = static_cast<std::size_t>(device.columns);
    return "the pin in row " + std::to_string(pin / columns + 1) + ", column " + std::to_string(pin % columns + 1);
}

struct PulseLine {
    double zero_us = 0.0;
    double us_per_m = 0.0;  // signed
};

PulseLine fit_pulses(const PinDevice& device, const PinMeasurements& measured, std::size_t pin) {
    const auto n = static_cast<double>(measured.wanted_m.size());
    double mean_m = 0.0, mean_us = 0.0;
    const auto pulse_us = [&](std::size_t i) {
        return 0.25 * quarter_us_of(device, device.pins[pin], measured.wanted_m[i]);
    };
    for (std::size_t i = 0; i < measured.wanted_m.size(); ++i) {
        mean_m += measured.height_m[i][pin] / n;
        mean_us += pulse_us(i) / n;
    }
    double squares = 0.0, products = 0.0;
    for (std::size_t i = 0; i < measured.wanted_m.size(); ++i) {
        const double off_m = measured.height_m[i][pin] - mean_m;
        squares += off_m * off_m;
        products += off_m * (pulse_us(i) - mean_us);
    }
    const double spread_m = std::sqrt(squares / n);
    constexpr double kLeastSpread = 0.03;  // of the stroke: a tenth, evenly spread
    if (!(spread_m > kLeastSpread * device.stroke_m))
        throw std::runtime_error("calibrate: " + pin_name(device, pin) +
                                 " hardly moved: stuck, or on another channel?");
    const double slope = products / squares;
    return {mean_us - slope * mean_m, slope};
}

void check_range(const PinDevice& device, const PulseLine& line, std::size_t pin) {
    for (const double pulse_us : {line.zero_us, line.zero_us + line.us_per_m * device.stroke_m}) {
        if (pulse_us >= device.lowest_us && pulse_us <= device.highest_us) continue;
        throw std::runtime_error("calibrate: " + pin_name(device, pin) + " needs a pulse of " +
                                 files::short_number(pulse_us) + " us, outside of the boards' range: turn its horn");
    }
}

}  // namespace

PinCalibration calibrate(const PinDevice& device, const PinMeasurements& measured) {
    assert(measured.wanted_m.size() >= 2 && measured.height_m.size() == measured.wanted_m.size());
    PinCalibration out;
    out.device = device;
    double before = 0.0, after = 0.0;
    for (std::size_t p = 0; p < device.pins.size(); ++p) {
        const PulseLine line = fit_pulses(device, measured, p);
        check_range(device, line, p);
        PinServo& servo = out.device.pins[p];
        servo.zero_us = line.zero_us;
        servo.us_per_mm = 1e-3 * std::abs(line.us_per_m);
        servo.direction = line.us_per_m > 0.0 ? 1.0 : -1.0;
        for (std::size_t i = 0; i < measured.wanted_m.size(); ++i) {
            const double height_m = measured.height_m[i][p];
            const double told_m = height_m_of(servo, quarter_us_of(device, device.pins[p], measured.wanted_m[i]));
            before += std::pow(height_m - measured.wanted_m[i], 2);
            after += std::pow(height_m - told_m, 2);
        }
    }
    const double count = static_cast<double>(device.pins.size() * measured.wanted_m.size());
    out.before_m = std::sqrt(before / count);
    out.after_m = std::sqrt(after / count);
    return out;
}

}  // namespace palpa::devices
