#pragma once
// Device files of arms and pins as JSON: for the files themselves, and for the guard, which is told by them what it drives.

#include <filesystem>

#include "devices/arm.h"
#include "devices/pins.h"
#include "files/json.h"

namespace palpa::devices {

// As read_arm_device() and read_pin_device(); `path` names the file in messages, and `compensation` is relative to it.
ArmDevice parse_arm_device(const files::Json& json, const std::filesystem::path& path);
PinDevice parse_pin_device(const files::Json& json, const std::filesystem::path& path);

// All that a parser needs to make the same device again, but the compensation, which is the loop's.
files::Json arm_device_json(const ArmDevice& arm);
files::Json pin_device_json(const PinDevice& device);

}  // namespace palpa::devices
