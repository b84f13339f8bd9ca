#pragma once
// Reads a sensor in a thread of its own; the caller takes the readings by poll(), which never waits.

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "devices/force_sensor.h"
#include "devices/spsc_ring.h"

namespace palpa::devices {

class SensorReader {
  public:
    explicit SensorReader(std::unique_ptr<ForceSensor> sensor);
    ~SensorReader();
    SensorReader(const SensorReader&) = delete;
    SensorReader& operator=(const SensorReader&) = delete;

    // Appends what arrived since the last call, oldest first, until `out` holds `most`. Never blocks.
    void poll(std::vector<ForceReading>& out, std::size_t most = std::size_t(-1));
    SensorHealth health() const;
    const std::string& name() const { return name_; }

  private:
    void run();

    std::unique_ptr<ForceSensor> sensor_;  // used by the thread alone once it runs
    std::string name_;
    SpscRing<ForceReading, 1 << 16> ring_;  // nine seconds at 7 kHz
    mutable std::mutex health_guard_;       // guards the copy below; locked a hundred times a second
    SensorHealth health_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace palpa::devices
