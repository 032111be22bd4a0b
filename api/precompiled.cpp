#include "api/texture_source.h"
#include "lang/parameter_value.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace haptel {

namespace {

struct Block {
    std::vector<uint64_t> words; // for its alignment
    char* at(uint32_t offset) { return reinterpret_cast<char*>(words.data()) + offset; }
    template <typename Value>
    void put(uint32_t offset, Value value)
    {
        std::memcpy(at(offset), &value, sizeof value);
    }
};

// As the compiler had it, for whoever reads values as text.
ir::Texture described(const haptel_texture& table)
{
    ir::Texture texture;
    texture.name = table.name;
    for (uint32_t i = 0; i < table.parameter_count; ++i) {
        const haptel_parameter& own = table.parameters[i];
        ir::Parameter& parameter = texture.parameters.emplace_back();
        parameter.name = own.name;
        parameter.unit = own.unit;
        parameter.type = static_cast<ir::Type>(own.type);
        parameter.value = own.value;
        parameter.minimum = own.minimum;
        parameter.maximum = own.maximum;
        parameter.offset = own.offset;
        const bool has_choices = table.size >= sizeof(haptel_texture) && table.choices && table.choices[i];
        for (int k = 0; has_choices && k <= static_cast<int>(own.maximum); ++k)
            parameter.choices.emplace_back(table.choices[i][k]);
    }
    return texture;
}

void put(Block& block, const ir::Parameter& parameter, double value)
{
    switch (parameter.type) {
    case ir::Type::real: block.put(parameter.offset, value); break;
    case ir::Type::i32: block.put(parameter.offset, static_cast<int32_t>(value)); break;
    case ir::Type::u32: block.put(parameter.offset, static_cast<uint32_t>(value)); break;
    case ir::Type::boolean: block.put(parameter.offset, static_cast<int32_t>(value != 0)); break;
    case ir::Type::image: break; // null: flat
    }
}

haptel_block_head head_of(const TextureRequest& request)
{
    haptel_block_head head{};
    for (int i = 0; i < 3; ++i) {
        head.center[i] = request.box_minimum_m[i] / 2 + request.box_maximum_m[i] / 2;
        head.extent[i] = request.box_maximum_m[i] - request.box_minimum_m[i];
    }
    head.footprint_m = request.footprint_m;
    return head;
}

TextureResult bind(const haptel_texture& table, const TextureRequest& request)
{
    const ir::Texture texture = described(table);
    auto block = std::make_shared<Block>();
    block->words.resize((table.block_size + 7) / 8);
    block->put(0, head_of(request));
    for (const ir::Parameter& parameter : texture.parameters) put(*block, parameter, parameter.value);
    std::string said;
    for (const auto& [name, text] : request.parameters) {
        const auto [set, values] = lang::parse_values(name, text, texture);
        if (set.empty()) {
            const std::vector<std::string> names = lang::parameter_names(texture);
            const std::string_view nearest = near_name(name, {names.begin(), names.end()}).name;
            return {std::nullopt, "error: texture '" + texture.name + "' has no parameter '" + name + "'" +
                                      (nearest.empty() ? "" : ": did you mean '" + std::string(nearest) + "'?") + "\n"};
        }
        for (size_t i = 0; i < values.size(); ++i) {
            const std::string of = "parameter '" + name + "' of texture '" + texture.name + "': ";
            if (set[i].type == ir::Type::image)
                return {std::nullopt,
                        "error: " + of + "a picture needs the compiler: make the scene with compiler()\n"};
            if (!values[i].error.empty())
                return {std::nullopt, "error: " + of + values[i].error +
                                          (values[i].hint.empty() ? "" : ": " + values[i].hint) + "\n"};
            if (!values[i].warning.empty()) said += "warning: " + of + values[i].warning + "\n";
            put(*block, set[i], values[i].value);
        }
    }
    TextureBinding binding;
    binding.texture = &table;
    binding.block = block->words.data();
    binding.facts = table.facts;
    binding.owner = std::move(block);
    return {std::move(binding), std::move(said)};
}

} // namespace

TextureSource precompiled(std::vector<const haptel_texture*> textures)
{
    const auto find = [textures = std::move(textures)](const TextureRequest& request) -> TextureResult {
        const std::string_view reference = request.reference;
        const std::string_view name = reference.substr(reference.rfind(':') + 1); // without one: of all
        std::vector<std::string_view> names;
        for (const haptel_texture* table : textures) {
            if (!table) continue;
            if (table->abi != HAPTEL_ABI_VERSION)
                return {std::nullopt, "error: a texture was compiled for another version of haptel/abi.h (" +
                                          std::to_string(table->abi) + ", here " + std::to_string(HAPTEL_ABI_VERSION) +
                                          "): compile it anew\n"};
            if (table->name == name) return bind(*table, request);
            names.emplace_back(table->name);
        }
        std::string there;
        for (const std::string_view one : names) there += (there.empty() ? "" : ", ") + std::string(one);
        return {std::nullopt, "error: no precompiled texture is called '" + std::string(name) +
                                  "': " + (names.empty() ? "there is none" : "there are " + there) + "\n"};
    };
    return TextureSource(
        std::make_shared<const TextureSource::Implementation>(TextureSource::Implementation{find, nullptr}));
}

} // namespace haptel
