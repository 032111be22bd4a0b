#include "tools/plot/texture_picture.h"

#include "jit/check/oracle.h"
#include "lang/abi/evaluate.h"
#include "tools/plot/plot_texture.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace haptel::tools {

namespace {

const plot::TextureKind* find_kind(const std::string& name)
{
    for (const plot::TextureKind& kind : plot::texture_kinds())
        if (kind.name == name) return &kind;
    return nullptr;
}

// The texture over a cube of the window's size round its centre, its parameters set.
TextureRequest request_of(const PictureOptions& options)
{
    TextureRequest request;
    request.parameters = options.parameters;
    request.footprint_m = options.footprint_m;
    for (int axis = 0; axis < 3; ++axis) {
        request.box_minimum_m[axis] = options.center_m[axis] - options.window_m / 2;
        request.box_maximum_m[axis] = options.center_m[axis] + options.window_m / 2;
    }
    return request;
}

// The plane z = const faces +z; mesh coordinates run from 0 to 1 over the window.
haptel_point point_of(const PictureOptions& options, const glm::dvec3& p)
{
    haptel_point point{};
    for (int axis = 0; axis < 3; ++axis) point.p[axis] = p[axis];
    point.n[2] = 1;
    for (int axis = 0; axis < 2; ++axis) {
        point.uv[axis] = (p[axis] - options.center_m[axis]) / options.window_m + 0.5;
        point.uv_dp[axis][axis] = 1 / options.window_m;
    }
    return point;
}

} // namespace

jit::TextureOptions compile_options(const PictureOptions& options)
{
    jit::TextureOptions compile;
    compile.entries = jit::Entries::both_and_batches;
    compile.only_texture = options.texture.name;
    if (options.kind == "gradient-error") compile.precision = jit::Precision::f64; // whose error it is
    return compile;
}

std::optional<plot::Picture> draw_texture(const std::shared_ptr<const jit::CompiledProgram>& program,
                                          const PictureOptions& options,
                                          const std::function<void(const std::string&)>& say)
{
    const TextureResult texture =
        jit::make_binding(program, options.texture.name, request_of(options), jit::For::figures);
    if (!texture.diagnostics.empty()) say(texture.diagnostics);
    if (!texture.binding) return std::nullopt;

    plot::TextureView view;
    view.title =
        fmt::format("{}:{}", std::filesystem::path(options.texture.file).filename().string(), options.texture.name);
    for (const auto& [name, value] : options.parameters) view.title += fmt::format("  {} = {}", name, value);
    view.on_plane = [&](const glm::dvec3& p_m) { return point_of(options, p_m); };
    view.samples = [&](std::span<const haptel_point> points, std::span<haptel_sample> samples) {
        evaluate(*texture.binding, points, samples);
    };
    jit::Oracle oracle(program, *texture.binding);
    view.true_gradient = [&](const glm::dvec3& p) {
        const jit::OracleSample truth = oracle.sample(point_of(options, p));
        return glm::dvec3(truth.gradient[0], truth.gradient[1], truth.gradient[2]);
    };
    view.center_m = options.center_m;
    view.section_m = options.section_m;
    if (options.direction) {
        const glm::dvec3 half_m = options.window_m / 2 * *options.direction;
        view.section_m.emplace(options.center_m - half_m, options.center_m + half_m);
    }
    view.is_bounded =
        std::isfinite(texture.binding->facts.height_min_m) && std::isfinite(texture.binding->facts.height_max_m);
    view.say = [&](const std::string& text) { say(options.texture.file + ": " + text + "\n"); };
    view.window_m = options.window_m;
    view.size_px = options.size_px;
    return find_kind(options.kind)->draw(view);
}

} // namespace haptel::tools
