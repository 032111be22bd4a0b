// An exploration under the control of other programs of this machine, while it runs.
#pragma once

#include "tools/control/osc_server.h"
#include "tools/explore/explore_hands.h"
#include "tools/explore/explore_scene.h"
#include "tools/explore/explore_textures.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace haptel::tools {

class ExploreControl final : private Controlled {
public:
    // See error(). All of them outlive this.
    ExploreControl(uint16_t port, ExploreHands& hands, ExploreTextures& textures, ExploreScene& scene);

    const std::string& error() const { return server_.error(); }
    std::string greeting() const; // where it listens, a line

    // Takes and sends messages; waits for one at most so long.
    void serve(std::chrono::milliseconds at_most);
    void tell(const std::string& messages) { server_.tell(messages); }
    void end(const std::string& why) { server_.end(why); }

private:
    ControlAnswer set(uint32_t object, const std::string& parameter, const std::string& value) override;
    ControlAnswer choose_preset(uint32_t object, const std::string& name) override;
    ControlAnswer load_scene(const std::string& file) override;
    ControlAnswer start_recording() override;
    ControlAnswer stop_recording() override;
    void withhold_force(bool is_withheld) override;
    bool is_force_withheld() const override;
    std::vector<ControlledHand> hands() const override;
    std::vector<ControlledObject> objects() const override;
    uint64_t objects_version() const override;

    ExploreHands& hands_;
    ExploreTextures& textures_;
    ExploreScene& scene_;
    OscServer server_;
};

} // namespace haptel::tools
