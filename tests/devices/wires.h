#pragma once
// What tests of wires share: bytes as text, streams cut in two, rigs of each protocol.

#include <cstdint>
#include <cstdio>
#include <doctest/doctest.h>
#include <string>
#include <vector>

#include "devices/rig.h"

namespace palpa::test {

inline std::string hex_of(std::span<const std::uint8_t> bytes) {
    std::string text;
    char two[4];
    for (const std::uint8_t byte : bytes) {
        std::snprintf(two, sizeof two, "%02X", byte);
        text += (text.empty() ? "" : " ") + std::string(two);
    }
    return text;
}

inline void add_bytes(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& to) {
    to.insert(to.end(), bytes.begin(), bytes.end());
}

inline devices::ActuatorRig rig_from(const std::string& text) {
    const files::Json json = files::parse_json(text, "rig.json");
    return devices::read_rig(files::JsonReader(json, "rig.json"));
}

// Two cables and a cavity, with a sensor: by our frames, by Dynamixel and Alicat, by Maestro, or by a sketch.
inline std::string rig_text(const std::string& kind) {
    const std::string sensor =
        R"("sensor": {"path": "/dev/null", "counts_per_mm": 1000, "silence_ms": 1000}, "total_force_N": 9})";
    if (kind == "framed")
        return R"({"ports": [{"name": "board", "protocol": "framed", "path": "/dev/null"}], "actuators": [
            {"name": "left", "port": "board", "id": 0, "drive": "force", "range_N": [0, 5.5], "rate_N_per_s": 200, "counts_per_N": 10000},
            {"name": "right", "port": "board", "id": 2, "drive": "force", "range_N": [0, 5.5], "rate_N_per_s": 200, "counts_per_N": 10000}],)" +
               sensor;
    if (kind == "regulator")
        return R"({"ports": [{"name": "motors", "protocol": "dynamixel", "path": "/dev/null"},
                            {"name": "air", "protocol": "alicat", "path": "/dev/null"}], "actuators": [
            {"name": "a", "port": "motors", "id": 1, "drive": "force", "range_N": [0, 5], "rate_N_per_s": 200, "counts_per_N": 300},
            {"name": "b", "port": "motors", "id": 2, "drive": "length", "range_mm": [20, 60], "relaxed_mm": 58, "rate_mm_per_s": 500,
             "counts_per_mm": -40, "zero_counts": 4000, "current_limit_counts": 400},
            {"name": "air", "port": "air", "unit": "C", "drive": "pressure", "range_kPa": [0, 5], "rate_kPa_per_s": 200,
             "counts_per_kPa": 10, "area_mm2": 1443}],)" +
               sensor;
    if (kind == "maestro")
        return R"({"ports": [{"name": "servos", "protocol": "maestro", "path": "/dev/null"}], "actuators": [
            {"name": "a", "port": "servos", "id": 3, "drive": "length", "range_mm": [10, 14], "relaxed_mm": 14, "rate_mm_per_s": 200,
             "counts_per_mm": -200, "zero_counts": 3900},
            {"name": "b", "port": "servos", "id": 4, "drive": "length", "range_mm": [10, 14], "relaxed_mm": 14, "rate_mm_per_s": 200,
             "counts_per_mm": 200, "zero_counts": -900}],)" +
               sensor;
    return R"({"ports": [{"name": "board", "protocol": "sketch", "path": "/dev/null"}], "actuators": [
            {"name": "a", "port": "board", "id": 0, "drive": "length", "range_mm": [0, 30], "relaxed_mm": 30, "rate_mm_per_s": 300, "counts_per_mm": 6}],)" +
           sensor;
}

}  // namespace palpa::test
