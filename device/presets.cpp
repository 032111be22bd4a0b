#include "device/presets.h"

namespace haptel::device {

namespace {

constexpr DevicePreset devices[] = {
    // mass kg, damping N s/m, Coulomb N, encoder m, force N, stiffness N/m
    {"premium", {0.075, 0.1, 0.04, 30e-6, 8.5, 800}}, {"touch", {0.045, 0.1, 0.26, 55e-6, 3.3, 400}},
    {"falcon", {0.25, 0.5, 0.5, 63e-6, 8.9, 3000}},   {"omega", {0.22, 0.5, 0.3, 10e-6, 12, 5000}},
    {"harsh", {0.075, 0.02, 0, 30e-6, 8.5, 800}}, // near the worst case for stability
};

constexpr HandPreset hands[] = {
    // mass kg, damping N s/m, stiffness N/m
    {"firm", {0.15, 5, 500}},  // a stylus held as for writing
    {"light", {0.05, 2, 150}}, // pinched
};

} // namespace

std::span<const DevicePreset> device_presets()
{
    return devices;
}
std::span<const HandPreset> hand_presets()
{
    return hands;
}

} // namespace haptel::device
