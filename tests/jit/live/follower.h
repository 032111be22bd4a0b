// A live texture of a folder, and what it called back.
#pragma once

#include "jit/live/live_texture.h"
#include "jit/texture/resolver.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/folder.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace haptel::test {

// A live texture and what it called back; heights are micrometres at the origin.
class Follower {
public:
    Follower(const Folder& folder, std::vector<std::pair<std::string, std::string>> parameters = {},
             double servo_period_s = 1e-3)
    {
        TextureRequest request = request_over(0.05);
        request.reference = folder.file("t.haptel:t");
        request.parameters = std::move(parameters);
        jit::LiveOptions options;
        options.cache = std::make_shared<jit::ProgramCache>();
        jit::make_resolver(options.cache)(request); // what a scene has done before
        request.servo_period_s = servo_period_s;
        jit::LiveCallbacks callbacks;
        callbacks.publish = [this](TextureBinding binding) {
            if (refuses) throw std::runtime_error("no room in the hand");
            const std::lock_guard lock(mutex);
            height_um = 1e6 * sample_at(binding, {0, 0, 0}).height_m;
            ++published;
            ranges.push_back(range_of(binding));
            held = std::move(binding);
            changed.notify_all();
        };
        callbacks.report = [this](std::string_view text) {
            const std::lock_guard lock(mutex);
            reported += text;
            changed.notify_all();
        };
        texture = std::make_unique<jit::LiveTexture>(request, callbacks, options);
    }

    ~Follower() { texture.reset(); } // before what its callbacks use

    bool comes_to(double um)
    {
        return comes_true([&] { return std::fabs(height_um - um) < 1e-9; });
    }
    bool comes_to_publications(int count)
    {
        return comes_true([&] { return published == count; });
    }
    bool says(const std::string& part)
    {
        return comes_true([&] { return contains(reported, part); });
    }
    int publications()
    {
        const std::lock_guard lock(mutex);
        return published;
    }
    // Comes to be felt by this range.
    bool comes_to_range(std::pair<double, double> range)
    {
        return comes_true([&] { return !ranges.empty() && ranges.back() == range; });
    }
    // Of what was published, in their order.
    std::vector<std::pair<double, double>> ranges_so_far()
    {
        const std::lock_guard lock(mutex);
        return ranges;
    }
    static std::pair<double, double> range_of(const TextureBinding& binding)
    {
        return {binding.facts.height_min_m, binding.facts.height_max_m};
    }
    std::string said()
    {
        const std::lock_guard lock(mutex);
        return reported;
    }

    std::atomic<bool> refuses{false}; // to publish throws
    std::unique_ptr<jit::LiveTexture> texture;

private:
    template <typename Condition>
    bool comes_true(Condition&& condition)
    {
        std::unique_lock lock(mutex);
        return changed.wait_for(lock, std::chrono::seconds(20), condition);
    }

    std::mutex mutex;
    std::condition_variable changed;
    double height_um = -1;
    int published = 0;
    std::string reported;
    std::vector<std::pair<double, double>> ranges;
    TextureBinding held;
};

inline std::string constant(const std::string& um)
{
    return "texture t(float depth = " + um + "um in 0um .. 1mm) { return depth; }";
}

} // namespace haptel::test
