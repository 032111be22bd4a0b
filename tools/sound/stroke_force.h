// The force on a hand that strokes a scene, tick by tick, as fast as it is asked for: nobody waits for a period.
//
// In the place of a servo thread, which has a clock to keep or a reader to wait for. What is computed is the same, bit
// for bit, as that of a servo on the virtual clock.
#pragma once

#include "runtime/files/scene_file.h"
#include "runtime/render/renderer.h"
#include "tools/sound/channels.h"

#include <cstdint>
#include <memory>
#include <string>

namespace haptel::tools::sound {

class StrokeForce {
public:
    // The calling thread computes with exact floating point from here on.
    StrokeForce(std::shared_ptr<const runtime::Scene> scene, runtime::LoadedHand hand);

    // False: the hand's recording is over, or the device failed (see error()).
    bool next(Stroked& stroked);

    const std::string& error() const { return error_; } // in words; empty: none
    uint64_t contact_ticks() const { return contact_ticks_; }
    uint64_t faults() const { return faults_; } // ticks with a fault of texture, pose or force

private:
    std::unique_ptr<runtime::HapticDevice> device_;
    runtime::Renderer renderer_;
    std::string error_;
    bool started_ = false;
    glm::dvec3 last_tip_m_{0};
    uint64_t contact_ticks_ = 0, faults_ = 0;
};

} // namespace haptel::tools::sound
