#include "device/presets.h"

namespace haptel::device {

namespace {

const runtime::DeviceAxes two_axes{{true, true, false}, {true, true, false}};
const runtime::DeviceAxes one_axis{{true, false, false}, {true, false, false}};

const DevicePreset devices[] = {
    // mass kg, damping N s/m, Coulomb N, encoder m, force N, stiffness N/m; updates Hz, delay s, axes
    {"premium", {0.075, 0.1, 0.04, 30e-6, 8.5, 800}},
    {"touch", {0.045, 0.1, 0.26, 55e-6, 3.3, 400}},
    {"falcon", {0.25, 0.5, 0.5, 63e-6, 8.9, 3000}},
    {"omega", {0.22, 0.5, 0.3, 10e-6, 12, 5000}},
    {"harsh", {0.075, 0.02, 0, 30e-6, 8.5, 800}}, // near the worst case for stability
    // Haply's Inverse3 through its service: a state and a force in turns, some 0.5 ms there and back.
    {"inverse3", {0.35, 1, 0.2, 10e-6, 10, 1000, 0, 0.5e-3}},
    // WoodenHaptics, USB HID: a report of 1 ms each way.
    {"wooden", {0.25, 0.5, 0.2, 20e-6, 5, 1000, 1000, 2e-3}},
    // Two axes: a pantograph on a table (Haply 2DIY).
    {"2diy", {0.1, 0.3, 0.1, 35e-6, 2, 500, 0, 1e-3, two_axes}},
    // One axis: the rim of a wheel of 0.14 m, 2 N m with gears through the kernel (an effect every 2 ms), and 8 N m
    // without, at the 1 kHz of OpenFFBoard.
    {"wheel", {1.5, 3, 2, 25e-6, 15, 500, 500, 4e-3, one_axis}},
    {"openffboard", {1.0, 1, 0.5, 14e-6, 50, 1000, 1000, 2e-3, one_axis}},
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
