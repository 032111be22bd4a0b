#include "tools/explore/explore_control.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace haptel::tools {

ExploreControl::ExploreControl(uint16_t port, ExploreHands& hands, ExploreTextures& textures, ExploreScene& scene)
    : hands_(hands), textures_(textures), scene_(scene), server_(port, *this)
{
}

std::string ExploreControl::greeting() const
{
    return fmt::format("osc: listens on {}\n", fmt::join(server_.bound_addresses(), " and "));
}

void ExploreControl::serve(std::chrono::milliseconds at_most)
{
    if (at_most.count() > 0) server_.wait(at_most);
    server_.serve();
}

ControlAnswer ExploreControl::set(uint32_t object, const std::string& parameter, const std::string& value)
{
    return textures_.set(object, parameter, value);
}

ControlAnswer ExploreControl::choose_preset(uint32_t object, const std::string& name)
{
    return textures_.choose_preset(object, name);
}

ControlAnswer ExploreControl::load_scene(const std::string& file)
{
    return {scene_.follow(file), {}};
}

ControlAnswer ExploreControl::start_recording()
{
    return hands_.start_recording();
}

ControlAnswer ExploreControl::stop_recording()
{
    return hands_.stop_recording();
}

void ExploreControl::withhold_force(bool is_withheld)
{
    hands_.withhold_force(is_withheld);
}

bool ExploreControl::is_force_withheld() const
{
    return hands_.is_force_withheld();
}

std::vector<ControlledHand> ExploreControl::hands() const
{
    return hands_.felt();
}

std::vector<ControlledObject> ExploreControl::objects() const
{
    return textures_.controlled();
}

uint64_t ExploreControl::objects_version() const
{
    return textures_.version();
}

} // namespace haptel::tools
