#include "jit/picture/image_file.h"
#include "jit/texture/band_limit.h"
#include "jit/texture/facts.h"
#include "jit/texture/texture.h"
#include "lang/parameter_value.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace haptel::jit {

namespace {

// What a binding points into.
struct BindingStorage {
    std::shared_ptr<const CompiledProgram> program;
    std::vector<std::shared_ptr<const ir::SplineImage>> images; // by Texture::parameters
    std::vector<uint64_t> block;                                // of 8 bytes for its alignment
};

// Everything wrong with a request, one line each.
class Complaints {
public:
    void add(const std::string& error, const std::string& hint = {}) { add(text, "error: " + error, hint); }
    void warn(const std::string& warning, const std::string& hint) { add(remarks, "warning: " + warning, hint); }
    void note(const std::string& note, const std::string& hint) { add(remarks, "note: " + note, hint); }
    std::string text, remarks; // errors; warnings and notes

private:
    static void add(std::string& to, const std::string& what, const std::string& hint)
    {
        to += what + "\n";
        if (!hint.empty()) to += "  hint: " + hint + "\n";
    }
};

template <typename Item>
std::string list_of(const Item& items)
{
    std::string list;
    for (const auto& item : items) list += (list.empty() ? "" : ", ") + std::string(item.name);
    return list;
}

template <typename Items>
std::string did_you_mean(std::string_view name, const Items& items, const std::string& kind)
{
    std::vector<std::string_view> names;
    for (const auto& item : items) names.push_back(item.name);
    if (names.empty()) return "it has none";
    const std::string_view nearest = nearest_name(name, names);
    if (!nearest.empty()) return "did you mean '" + std::string(nearest) + "'?";
    return "it has the " + kind + " " + list_of(items);
}

const haptel_texture* choose(const CompiledProgram& program, std::string_view name, Complaints& complaints)
{
    if (name.empty()) {
        if (program.textures().size() == 1) return &program.textures()[0];
        complaints.add(program.textures().empty() ? "this file has no texture" : "which texture of this file is meant?",
                       program.textures().empty() ? "" : "it has " + list_of(program.textures()) + ": write FILE:NAME");
        return nullptr;
    }
    const haptel_texture* texture = program.find(name);
    if (!texture)
        complaints.add("this file has no texture '" + lang::printable(name) + "'",
                       did_you_mean(name, program.textures(), "textures"));
    return texture;
}

// Values by Texture::parameters: the defaults, then what the request says.
std::vector<double> values_of(const ir::Texture& texture, const TextureRequest& request, Complaints& complaints)
{
    std::vector<double> values;
    for (const ir::Parameter& parameter : texture.parameters) values.push_back(parameter.value);
    for (const auto& [name, text] : request.parameters) {
        size_t i = 0;
        while (i < values.size() && texture.parameters[i].name != name) ++i;
        if (i == values.size()) {
            complaints.add("texture '" + texture.name + "' has no parameter '" + lang::printable(name) + "'",
                           did_you_mean(name, texture.parameters, "parameters"));
            continue;
        }
        const lang::ParameterValue parsed = lang::parse_value(text, texture.parameters[i]);
        const std::string of = "parameter '" + name + "' of texture '" + texture.name + "': ";
        if (!parsed.error.empty()) complaints.add(of + parsed.error, parsed.hint);
        if (!parsed.warning.empty()) complaints.warn(of + parsed.warning, "it is taken as it is: is the unit meant?");
        values[i] = parsed.value;
    }
    return values;
}

std::string place_of(const ir::Parameter& parameter, const ir::Texture& texture)
{
    return "parameter '" + parameter.name + "' of texture '" + texture.name + "'";
}

struct NamedImage {
    std::shared_ptr<const ir::SplineImage> image; // null: the parameter is no image, or has no picture
    std::string file;                             // as the request names it
    PictureGrain grain = {};
};

// By Texture::parameters. An image without a picture is flat, which is worth a warning.
std::vector<NamedImage> images_of(const ir::Texture& texture, const TextureRequest& request, Complaints& complaints)
{
    std::vector<NamedImage> images;
    for (const ir::Parameter& parameter : texture.parameters) {
        images.emplace_back();
        if (parameter.type != ir::Type::image) continue;
        const std::string of = place_of(parameter, texture);
        const auto given = std::find_if(request.parameters.rbegin(), request.parameters.rend(),
                                        [&](const auto& one) { return one.first == parameter.name; });
        if (given == request.parameters.rend()) {
            complaints.warn(of + " has no picture and is flat, 0 everywhere",
                            "name a file: " + parameter.name + " = \"dents.png\"");
            continue;
        }
        ImageFile read = read_image(given->second, request.folder);
        if (!read.image) complaints.add(of + ": " + read.error, read.hint);
        images.back() = {std::move(read.image), lang::printable(given->second), read.grain};
    }
    return images;
}

// What a hand may feel of the pictures' files. `facts_with` bounds the texture with images other than its own.
template <typename FactsWith>
void note_grain(const ir::Texture& texture, const std::vector<NamedImage>& images,
                std::vector<const ir::SplineImage*> views, FactsWith&& facts_with, Complaints& complaints)
{
    for (size_t i = 0; i < images.size(); ++i) {
        if (images[i].grain.level == 0 && !images[i].grain.has_blocks) continue;
        const ir::SplineImage* const own = std::exchange(views[i], &flat_image());
        const haptel_facts black = facts_with(views);
        views[i] = &white_image();
        const haptel_facts white = facts_with(views);
        views[i] = own;
        const double white_m = std::max(std::fabs(white.height_max_m - black.height_max_m),
                                        std::fabs(white.height_min_m - black.height_min_m));
        for (const GrainNote& said : grain_notes(images[i].grain, images[i].file, white_m))
            complaints.note(place_of(texture.parameters[i], texture) + ": " + said.message, said.hint);
    }
}

haptel_block_head head_of(const TextureRequest& request, Complaints& complaints)
{
    haptel_block_head head{};
    for (size_t i = 0; i < 3; ++i) {
        const double low = request.box_minimum_m[i], high = request.box_maximum_m[i];
        if (!(std::isfinite(low) && std::isfinite(high) && low <= high)) {
            complaints.add("the object's box is not a box: " + std::to_string(low) + " .. " + std::to_string(high));
            break;
        }
        head.center[i] = low / 2 + high / 2;
        head.extent[i] = high - low;
    }
    if (!(request.footprint_m >= 0 && std::isfinite(request.footprint_m)))
        complaints.add("the footprint is not a length: " + std::to_string(request.footprint_m) + " m");
    head.footprint_m = request.footprint_m;
    return head;
}

void write(std::vector<uint64_t>& block, const ir::Parameter& parameter, double value)
{
    char* place = reinterpret_cast<char*>(block.data()) + parameter.offset;
    const auto put = [&](auto held) { std::memcpy(place, &held, sizeof held); };
    switch (parameter.type) {
    case ir::Type::real: put(value); break;
    case ir::Type::i32: put(static_cast<int32_t>(value)); break;
    case ir::Type::u32: put(static_cast<uint32_t>(value)); break;
    case ir::Type::boolean: put(static_cast<int32_t>(value != 0)); break;
    case ir::Type::image: break; // write_image
    }
}

void write_image(std::vector<uint64_t>& block, const ir::Parameter& parameter, const ir::SplineImage* image)
{
    const haptel_image* view = image ? &image->view() : nullptr;
    std::memcpy(reinterpret_cast<char*>(block.data()) + parameter.offset, &view, sizeof view);
}

} // namespace

TextureResult make_binding(const std::shared_ptr<const CompiledProgram>& program, std::string_view name,
                           const TextureRequest& request, Unbounded unbounded)
{
    Complaints complaints;
    const haptel_texture* texture = choose(*program, name, complaints);
    if (!texture) return {std::nullopt, complaints.text};
    const ir::Texture& source = program->source_of(*texture);
    const std::vector<double> values = values_of(source, request, complaints);
    const std::vector<NamedImage> images = images_of(source, request, complaints);
    const haptel_block_head head = head_of(request, complaints);
    if (!complaints.text.empty()) return {std::nullopt, complaints.text};

    std::vector<const ir::SplineImage*> views; // flat where there is none
    for (const NamedImage& named : images) views.push_back(named.image ? named.image.get() : &flat_image());
    const auto facts_with = [&](const std::vector<const ir::SplineImage*>& seen) {
        return facts_over_box(program->module(), source, values, seen, head, request);
    };
    const haptel_facts facts = facts_with(views);
    const bool is_bounded = std::isfinite(facts.height_min_m) && std::isfinite(facts.height_max_m);
    if (!is_bounded && unbounded == Unbounded::refused) {
        complaints.add("the height of texture '" + source.name +
                           "' is not bounded over this object, and a hand cannot "
                           "be kept above a surface of unknown height",
                       "bound it where it grows, for example return clamp(height, -1mm, 1mm); or give its parameters "
                       "ranges");
        return {std::nullopt, complaints.text};
    }

    auto storage = std::make_shared<BindingStorage>();
    storage->program = program;
    storage->block.resize((texture->block_size + 7) / 8);
    std::memcpy(storage->block.data(), &head, sizeof head);
    for (size_t i = 0; i < values.size(); ++i) write(storage->block, source.parameters[i], values[i]);
    for (size_t i = 0; i < images.size(); ++i) {
        storage->images.push_back(images[i].image);
        if (source.parameters[i].type == ir::Type::image)
            write_image(storage->block, source.parameters[i], images[i].image.get());
    }
    note_grain(source, images, views, facts_with, complaints);
    const void* block = storage->block.data();
    TextureBinding binding{std::move(storage), texture, block, facts};
    binding.band_limited = is_band_limited(binding, request);
    return {std::move(binding), std::move(complaints.remarks)};
}

} // namespace haptel::jit
