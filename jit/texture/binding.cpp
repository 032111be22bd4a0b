#include "jit/picture/image_file.h"
#include "jit/texture/envelope.h"
#include "jit/texture/facts.h"
#include "lang/parameter_value.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

namespace haptel::jit {

namespace {

// A parameter as a request sets it.
struct Argument {
    double value = 0;                             // SI; of an image: any
    std::shared_ptr<const ir::SplineImage> image; // null: it is no image, or has no picture
    std::string file = {};                        // of the picture, as the request names it
    PictureGrain grain = {};
};

// What a binding points into.
struct BindingStorage {
    std::shared_ptr<const CompiledProgram> program;
    std::vector<Argument> arguments; // for their images; by Texture::parameters
    std::vector<uint64_t> block;     // of 8 bytes for its alignment
};

// What there is to say about a request, one line each.
struct Findings {
    std::string errors, remarks; // the latter: warnings and notes

    void error(const std::string& what, const std::string& hint = {}) { add(errors, "error: " + what, hint); }
    void remark(const std::string& what, const std::string& hint) { add(remarks, what, hint); }

private:
    static void add(std::string& to, const std::string& what, const std::string& hint)
    {
        to += what + "\n";
        if (!hint.empty()) to += "  hint: " + hint + "\n";
    }
};

std::vector<std::string> names_of(std::span<const haptel_texture> textures)
{
    std::vector<std::string> names;
    for (const haptel_texture& texture : textures) names.emplace_back(texture.name);
    return names;
}

std::string list_of(const std::vector<std::string>& names)
{
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& names, const std::string& kind)
{
    if (names.empty()) return "it has none";
    const std::string_view nearest = near_name(name, {names.begin(), names.end()}).name;
    if (!nearest.empty()) return "did you mean '" + std::string(nearest) + "'?";
    return "it has the " + kind + " " + list_of(names);
}

void report_no_texture(const CompiledProgram& program, std::string_view name, Findings& findings)
{
    const std::span<const haptel_texture> textures = program.textures();
    if (!name.empty())
        findings.error("this file has no texture '" + lang::printable(name) + "'",
                       did_you_mean(name, names_of(textures), "textures"));
    else if (textures.empty())
        findings.error("this file has no texture");
    else
        findings.error("which texture of this file is meant?",
                       "it has " + list_of(names_of(textures)) + ": write FILE:NAME");
}

std::string place_of(std::string_view name, const ir::Texture& texture)
{
    return "parameter '" + std::string(name) + "' of texture '" + texture.name + "'";
}

// By Texture::parameters: the defaults, then what the request says. An image without a picture is flat, which is worth
// a warning.
std::vector<Argument> arguments_of(const ir::Texture& texture, const TextureRequest& request, ir::ImageParts parts,
                                   Findings& findings)
{
    std::vector<Argument> arguments;
    for (const ir::Parameter& parameter : texture.parameters) arguments.push_back({parameter.value, nullptr});
    for (const auto& [name, text] : request.parameters) {
        const auto [set, values] = lang::parse_values(name, text, texture);
        if (set.empty()) {
            findings.error("texture '" + texture.name + "' has no parameter '" + lang::printable(name) + "'",
                           did_you_mean(name, lang::parameter_names(texture), "parameters"));
            continue;
        }
        const std::string of = place_of(name, texture) + ": ";
        for (size_t i = 0; i < values.size(); ++i) {
            if (!values[i].error.empty()) findings.error(of + values[i].error, values[i].hint);
            if (!values[i].warning.empty())
                findings.remark("warning: " + of + values[i].warning, "it is taken as it is: is the unit meant?");
            ImageFile read;
            if (set[i].type == ir::Type::image) read = read_image(text, request.folder, parts);
            if (!read.error.empty()) findings.error(of + read.error, read.hint);
            arguments[static_cast<size_t>(&set[i] - texture.parameters.data())] = {
                values[i].value, std::move(read.image), lang::printable(text), read.grain};
        }
    }
    for (size_t i = 0; i < arguments.size(); ++i)
        if (texture.parameters[i].type == ir::Type::image && arguments[i].file.empty())
            findings.remark("warning: " + place_of(texture.parameters[i].name, texture) +
                                " has no picture and is flat, 0 everywhere",
                            "name a file: " + texture.parameters[i].name + " = \"dents.png\"");
    return arguments;
}

// What a hand may feel of the pictures' files. `facts_with` bounds the texture with images other than its own.
template <typename FactsWith>
void note_grain(const ir::Texture& texture, const std::vector<Argument>& arguments,
                std::vector<const ir::SplineImage*> views, FactsWith&& facts_with, Findings& findings)
{
    for (size_t i = 0; i < arguments.size(); ++i) {
        const Argument& argument = arguments[i];
        if (argument.grain.level == 0 && !argument.grain.has_blocks) continue;
        views[i] = &flat_image();
        const haptel_facts black = facts_with(views);
        views[i] = &white_image();
        const haptel_facts white = facts_with(views);
        views[i] = argument.image.get();
        const double white_m = std::max(std::fabs(white.height_max_m - black.height_max_m),
                                        std::fabs(white.height_min_m - black.height_min_m));
        for (const GrainNote& said : grain_notes(argument.grain, argument.file, white_m))
            findings.remark("note: " + place_of(texture.parameters[i].name, texture) + ": " + said.message, said.hint);
    }
}

std::string micrometres(double metres)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g um", metres * 1e6);
    return text;
}

// What a hand feels where the proof says too little.
void give_envelope(TextureBinding& binding, const FoundHeights& found, const ir::Texture& texture, Findings& findings)
{
    const haptel_facts proven = binding.facts;
    if (!give_envelope(binding, found)) return;
    const bool is_bounded = std::isfinite(proven.height_min_m) && std::isfinite(proven.height_max_m);
    findings.remark("note: the height of texture '" + texture.name + "' is " +
                        (is_bounded ? "only proven to lie within " + micrometres(proven.height_min_m) + " .. " +
                                          micrometres(proven.height_max_m)
                                    : "not proven to be bounded") +
                        "; found were " + micrometres(found.minimum_m) + " .. " + micrometres(found.maximum_m) +
                        ", and what lies beyond " + micrometres(binding.facts.height_min_m) + " .. " +
                        micrometres(binding.facts.height_max_m) + " is bent to stay within",
                    "");
}

haptel_block_head head_of(const TextureRequest& request, Findings& findings)
{
    haptel_block_head head{};
    for (size_t i = 0; i < 3; ++i) {
        const double low = request.box_minimum_m[i], high = request.box_maximum_m[i];
        if (!(std::isfinite(low) && std::isfinite(high) && low <= high)) {
            findings.error("the object's box is not a box: " + std::to_string(low) + " .. " + std::to_string(high));
            break;
        }
        head.center[i] = low / 2 + high / 2;
        head.extent[i] = high - low;
    }
    if (!(request.footprint_m >= 0 && std::isfinite(request.footprint_m)))
        findings.error("the footprint is not a length: " + std::to_string(request.footprint_m) + " m");
    head.footprint_m = request.footprint_m;
    return head;
}

void write(std::vector<uint64_t>& block, const ir::Parameter& parameter, const Argument& argument)
{
    char* place = reinterpret_cast<char*>(block.data()) + parameter.offset;
    const auto put = [&](auto held) { std::memcpy(place, &held, sizeof held); };
    switch (parameter.type) {
    case ir::Type::real: put(argument.value); break;
    case ir::Type::i32: put(static_cast<int32_t>(argument.value)); break;
    case ir::Type::u32: put(static_cast<uint32_t>(argument.value)); break;
    case ir::Type::boolean: put(static_cast<int32_t>(argument.value != 0)); break;
    case ir::Type::image: put(argument.image ? &argument.image->view() : nullptr); break;
    }
}

// `before`: at once, after that one; null: with patience.
TextureResult bound(const std::shared_ptr<const CompiledProgram>& program, std::string_view name,
                    const TextureRequest& request, For use, FoundHeights* found, const TextureBinding* before)
{
    Findings findings;
    const auto refuse = [&] { return TextureResult{std::nullopt, findings.errors}; };
    const haptel_texture* texture = program->find(name);
    if (!texture) {
        report_no_texture(*program, name, findings);
        return refuse();
    }
    const ir::Texture& source = program->source_of(*texture);
    auto storage = std::make_shared<BindingStorage>();
    storage->program = program;
    storage->arguments = arguments_of(source, request, ir::parts_read(program->module()), findings);
    const haptel_block_head head = head_of(request, findings);
    if (!findings.errors.empty()) return refuse();

    storage->block.resize((texture->block_size + 7) / 8);
    std::memcpy(storage->block.data(), &head, sizeof head);
    std::vector<double> values;
    std::vector<const ir::SplineImage*> views; // flat where there is none
    for (size_t i = 0; i < source.parameters.size(); ++i) {
        const Argument& argument = storage->arguments[i];
        write(storage->block, source.parameters[i], argument);
        values.push_back(argument.value);
        views.push_back(argument.image ? argument.image.get() : &flat_image());
    }
    const auto facts_with = [&](const std::vector<const ir::SplineImage*>& seen, Bounded what,
                                FindPlaces* places = nullptr) {
        return facts_over_box(program->module(), source, values, seen, head, request, what, places);
    };
    const Bounded bounded = use == For::figures ? Bounded::all : before ? Bounded::heights_at_once : Bounded::heights;
    FindPlaces places;
    TextureBinding binding{storage, texture, storage->block.data(), facts_with(views, bounded, &places)};
    if (const std::string slow = too_slow(*program, binding, request); !slow.empty()) {
        findings.error(slow, "fewer octaves or terms, or a lower rate_hz");
        return refuse();
    }
    binding.band_limited = is_band_limited(binding, request);
    if (before) {
        if (!texture->height_gradient || !stretch_envelope(binding, *before, request)) return {};
        return {std::move(binding), std::move(findings.remarks)};
    }
    if (use == For::hand && texture->height_gradient) {
        const FoundHeights heights =
            find_heights(binding, request, places, found ? Search::to_the_end : Search::until_clear);
        give_envelope(binding, heights, source, findings);
        if (found) *found = heights;
    }
    note_grain(
        source, storage->arguments, views, [&](const auto& seen) { return facts_with(seen, Bounded::heights); },
        findings);
    return {std::move(binding), std::move(findings.remarks)};
}

} // namespace

TextureResult make_binding(const std::shared_ptr<const CompiledProgram>& program, std::string_view name,
                           const TextureRequest& request, For use, FoundHeights* found)
{
    return bound(program, name, request, use, found, nullptr);
}

TextureResult make_binding_at_once(const std::shared_ptr<const CompiledProgram>& program, std::string_view name,
                                   const TextureRequest& request, const TextureBinding& before)
{
    return bound(program, name, request, For::hand, nullptr, &before);
}

} // namespace haptel::jit
