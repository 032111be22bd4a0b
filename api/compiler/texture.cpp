#include "jit/texture/texture.h"
#include "lang/abi/evaluate.h"

#include <haptel/compiler.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

namespace haptel {

struct Texture::State {
    TextureBinding binding;
    std::string messages;
    bool is_compiled = false;
};

namespace {

jit::TextureOptions options_for_figures()
{
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    options.precision = jit::Precision::f64;
    return options;
}

Texture bound(const jit::CompiledTextures& compiled, const std::string& name, TextureRequest request, const Box& box)
{
    auto state = std::make_shared<Texture::State>();
    state->messages = compiled.rendered();
    if (!compiled.program) return Texture(std::move(state));
    const double low[] = {box.minimum_m.x, box.minimum_m.y, box.minimum_m.z},
                 high[] = {box.maximum_m.x, box.maximum_m.y, box.maximum_m.z};
    std::copy_n(low, 3, request.box_minimum_m);
    std::copy_n(high, 3, request.box_maximum_m);
    TextureResult made = jit::make_binding(compiled.program, name, request, jit::For::figures);
    state->messages += made.diagnostics;
    state->is_compiled = made.binding.has_value();
    if (made.binding) state->binding = std::move(*made.binding);
    return Texture(std::move(state));
}

} // namespace

Texture::operator bool() const
{
    return state_->is_compiled;
}

const std::string& Texture::messages() const
{
    return state_->messages;
}

const haptel_texture& Texture::table() const
{
    return *state_->binding.texture;
}

const void* Texture::block() const
{
    return state_->binding.block;
}

const haptel_facts& Texture::facts() const
{
    return state_->binding.facts;
}

void Texture::evaluate(std::span<const Vec3> points_m, std::span<double> heights_m, std::span<Vec3> gradients) const
{
    if (!state_->is_compiled) return;
    constexpr std::size_t at_once = 256;
    std::array<haptel_point, at_once> points{};
    std::array<haptel_sample, at_once> samples{};
    for (haptel_point& point : points) point.n[2] = 1;
    const std::size_t count = std::min(points_m.size(), heights_m.size());
    for (std::size_t first = 0; first < count; first += at_once) {
        const std::size_t some = std::min(at_once, count - first);
        for (std::size_t i = 0; i < some; ++i) {
            const Vec3& p = points_m[first + i];
            points[i].p[0] = p.x, points[i].p[1] = p.y, points[i].p[2] = p.z;
        }
        haptel::evaluate(state_->binding, std::span(points).first(some), std::span(samples).first(some));
        for (std::size_t i = 0; i < some; ++i) {
            heights_m[first + i] = samples[i].height_m;
            const double* g = samples[i].gradient;
            if (first + i < gradients.size()) gradients[first + i] = {g[0], g[1], g[2]};
        }
    }
}

Texture compile(std::string_view text, const std::string& name, const Parameters& parameters, const Box& box)
{
    TextureRequest request;
    request.parameters = parameters;
    return bound(jit::compile_texture(text, options_for_figures()), name, std::move(request), box);
}

Texture compile_file(const std::string& file, const std::string& name, const Parameters& parameters, const Box& box)
{
    TextureRequest request;
    request.parameters = parameters;
    request.folder = std::filesystem::path(file).parent_path().string();
    return bound(jit::compile_texture_file(file, options_for_figures()), name, std::move(request), box);
}

} // namespace haptel
