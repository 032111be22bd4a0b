#include "tools/library/library_test.h"

#include "lang/abi/evaluate.h"
#include "lang/ir/cost.h"
#include "libraries/manifest.h"
#include "libraries/places.h"
#include "tools/arguments/texture_argument.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <random>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

// A test that measures along lines does the work of many places at each.
constexpr uint64_t points_most = 4000, points_least = 250, operations_tried = 80'000'000;
constexpr uint64_t seed_of_tries = 1;
constexpr double flat_m = 1e-9;

// The height of a texture where it is not flat, in words; empty: it is flat wherever it was tried.
std::string not_flat(const TextureBinding& binding, uint64_t points)
{
    std::mt19937_64 random(seed_of_tries);
    std::uniform_real_distribution<double> within(-library_box_m / 2, library_box_m / 2);
    for (uint64_t i = 0; i < points; ++i) {
        haptel_point point{};
        for (double& p : point.p) p = within(random);
        point.n[2] = 1;
        haptel_sample sample{};
        evaluate(binding, {&point, 1}, {&sample, 1});
        if (std::abs(sample.height_m) > flat_m || sample.faults != 0)
            return fmt::format("is not flat, as it is where what it tests holds: {} m at {}, {}, {}{}", sample.height_m,
                               point.p[0], point.p[1], point.p[2], sample.faults != 0 ? ", with a fault" : "");
    }
    return {};
}

} // namespace

bool is_library_test(const fs::path& file)
{
    std::error_code fault;
    const fs::path whole = fs::absolute(file, fault).lexically_normal();
    const fs::path manifest = libraries::nearest_file(whole.parent_path(), libraries::manifest_name);
    return !manifest.empty() &&
           whole.lexically_relative(manifest.parent_path()).generic_string().starts_with(tests_folder);
}

std::string why_not_held(const std::shared_ptr<const jit::CompiledProgram>& tests, const std::string& name)
{
    const TextureResult bound = jit::make_binding(tests, name, request_in_cube(library_box_m)); // needs no bounds
    if (!bound.binding) return bound.diagnostics;
    const uint32_t body = tests->source_of(*tests->find(name)).height_gradient;
    const uint64_t operations = std::max<uint64_t>(ir::operations_max(tests->module(), body), 1);
    return not_flat(*bound.binding, std::clamp(operations_tried / operations, points_least, points_most));
}

} // namespace haptel::tools
