// Devices and hands that the simulation knows by name.
//
// Masses, frictions, encoders and force limits as published or as used by CHAI3D; damping coefficients of devices and
// all constants of hands are engineering values, good to a factor of two. Of `inverse3` and what follows it only
// forces, stiffnesses, rates and delays are others' figures.
#pragma once

#include "device/hand.h"
#include "runtime/hand/haptic_device.h"

#include <span>
#include <string_view>

namespace haptel::device {

// Lumped at the tip, equal in all directions.
struct DeviceModel {
    double mass_kg = 0;
    double damping_n_s_per_m = 0;
    double coulomb_n = 0; // friction, static and dynamic
    double encoder_m = 0; // step of the measured position; 0: exact
    double force_max_n = 0;
    double stiffness_max_n_per_m = 0; // recommended at 1 kHz
    double update_hz = 0;             // how often it takes a new force; 0: as often as it is sent one
    double delay_s = 0;               // from a force that is sent to the motor; a period at least
    runtime::DeviceAxes axes = {};
};

struct DevicePreset {
    std::string_view name;
    DeviceModel model;
};

struct HandPreset {
    std::string_view name;
    HandImpedance impedance;
};

std::span<const DevicePreset> device_presets(); // premium (the default) first
std::span<const HandPreset> hand_presets();     // firm (the default) first

} // namespace haptel::device
