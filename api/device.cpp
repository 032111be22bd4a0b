#include "api/conversions.h"
#include "api/device_state.h"
#include "device/device_factory.h"

#include <utility>

namespace haptel {

namespace {

// A program's own device, as the runtime sees devices.
class OwnDevice final : public runtime::HapticDevice {
public:
    explicit OwnDevice(std::unique_ptr<Device> device) : device_(std::move(device))
    {
        info_.name = "a device of the program";
        info_.force_max_n = device_->force_max_n();
    }
    ~OwnDevice() override { device_->stop(); }

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override
    {
        Pose read;
        const runtime::DeviceStatus status = status_of(device_->read(read));
        pose.tip_m = to_glm(read.tip_m);
        pose.tail_m = to_glm(read.tail_m);
        return status;
    }
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3& torque_n_m) noexcept override
    {
        return status_of(device_->write(from_glm(force_n), from_glm(torque_n_m)));
    }
    void write_grip(double grip_force_n) noexcept override { device_->write_grip(grip_force_n); }
    void stop() noexcept override { device_->stop(); }

private:
    static runtime::DeviceStatus status_of(DeviceState state)
    {
        switch (state) {
        case DeviceState::ok: return runtime::DeviceStatus::ok;
        case DeviceState::finished: return runtime::DeviceStatus::finished;
        case DeviceState::not_ready: return runtime::DeviceStatus::not_ready;
        case DeviceState::disconnected: return runtime::DeviceStatus::disconnected;
        case DeviceState::failed: return runtime::DeviceStatus::fault;
        }
        return runtime::DeviceStatus::fault;
    }

    std::unique_ptr<Device> device_;
    runtime::DeviceInfo info_;
};

} // namespace

runtime::DeviceResult open(DeviceSource::Implementation& source, const runtime::DeviceRequest& request)
{
    if (!source.own) return device::open_device(request);
    return {std::make_unique<OwnDevice>(std::move(source.own)), {}};
}

DeviceSource::DeviceSource(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation))
{
}

DeviceSource::~DeviceSource() = default;
DeviceSource::DeviceSource(DeviceSource&&) noexcept = default;
DeviceSource& DeviceSource::operator=(DeviceSource&&) noexcept = default;

std::unique_ptr<DeviceSource::Implementation> DeviceSource::take()
{
    return std::move(implementation_);
}

DeviceSource open_device(std::string name, Stroke stroke)
{
    return DeviceSource(std::make_unique<DeviceSource::Implementation>(
        DeviceSource::Implementation{std::move(name), std::move(stroke), nullptr}));
}

DeviceSource own_device(std::unique_ptr<Device> device)
{
    return DeviceSource(
        std::make_unique<DeviceSource::Implementation>(DeviceSource::Implementation{{}, {}, std::move(device)}));
}

} // namespace haptel
