// Devices as `--device NAME` opens them, and how long a test goes on with one.
#pragma once

#include "device/device_factory.h"
#include "tests/support/catch.h"

#include <cstdlib>
#include <memory>
#include <string>

namespace haptel::device {

inline std::unique_ptr<runtime::HapticDevice> open_by_name(const std::string& name)
{
    runtime::DeviceRequest request;
    request.name = name;
    runtime::DeviceResult result = open_device(request);
    INFO(name << ": " << result.error);
    REQUIRE(result.device);
    return std::move(result.device);
}

inline std::string why_not_opened(const std::string& name)
{
    runtime::DeviceRequest request;
    request.name = name;
    return open_device(request).error;
}

inline double exchange_seconds()
{
    const char* wanted = std::getenv("HAPTEL_VM_SECONDS");
    return wanted ? std::atof(wanted) : 5;
}

} // namespace haptel::device
