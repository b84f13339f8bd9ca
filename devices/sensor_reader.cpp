#include "devices/sensor_reader.h"

#include <time.h>

namespace palpa::devices {

double steady_s() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

SensorReader::SensorReader(std::unique_ptr<ForceSensor> sensor)
    : sensor_(std::move(sensor)), name_(sensor_->name()), thread_([this] { run(); }) {}

SensorReader::~SensorReader() {
    stop_.store(true);
    thread_.join();
}

void SensorReader::run() {
    std::vector<ForceReading> arrived;
    arrived.reserve(4096);
    std::int64_t overflowed = 0;
    while (!stop_.load()) {
        arrived.clear();
        sensor_->read(0.01, arrived);
        for (const ForceReading& reading : arrived) overflowed += !ring_.push(reading);
        const std::lock_guard<std::mutex> guard(health_guard_);
        health_ = sensor_->health();
        health_.overflowed = overflowed;
    }
}

void SensorReader::poll(std::vector<ForceReading>& out, std::size_t most) {
    ForceReading reading;
    while (out.size() < most && ring_.pop(reading)) out.push_back(reading);
}

SensorHealth SensorReader::health() const {
    const std::lock_guard<std::mutex> guard(health_guard_);
    return health_;
}

}  // namespace palpa::devices
