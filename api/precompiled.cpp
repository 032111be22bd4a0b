#include "api/texture_source.h"
#include "lang/parameter_value.h"
#include "lang/text/near_name.h"

#include <cstddef>
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

// What is wrong with a table that somebody wrote by hand; empty: nothing.
std::string fault_of(const haptel_texture& table)
{
    if (table.block_size < sizeof(haptel_block_head)) return "its block is smaller than haptel_block_head";
    if (table.parameter_count > 0 && !table.parameters) return "it has no table of its parameters";
    for (uint32_t i = 0; i < table.parameter_count; ++i) {
        const haptel_parameter& own = table.parameters[i];
        const uint32_t bytes = own.type == HAPTEL_FLOAT || own.type == HAPTEL_IMAGE ? 8 : 4;
        if (!own.name) return "a parameter has no name";
        if (own.type > HAPTEL_IMAGE) return std::string("parameter '") + own.name + "' has no type of haptel/abi.h";
        if (own.offset < sizeof(haptel_block_head) || own.offset % bytes != 0 ||
            uint64_t{own.offset} + bytes > table.block_size)
            return std::string("parameter '") + own.name + "' does not lie in its block";
    }
    return {};
}

// As the compiler had it, for whoever reads values as text.
ir::Texture described(const haptel_texture& table)
{
    ir::Texture texture;
    texture.name = table.name;
    for (uint32_t i = 0; i < table.parameter_count; ++i) {
        const haptel_parameter& own = table.parameters[i];
        ir::Parameter& parameter = texture.parameters.emplace_back();
        parameter.name = own.name;
        parameter.unit = own.unit ? own.unit : "";
        parameter.type = static_cast<ir::Type>(own.type);
        parameter.value = own.value;
        parameter.minimum = own.minimum;
        parameter.maximum = own.maximum;
        parameter.offset = own.offset;
        constexpr size_t choices_end = offsetof(haptel_texture, choices) + sizeof table.choices;
        const bool has_choices = table.size >= choices_end && table.choices && table.choices[i];
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
    if (const std::string fault = fault_of(table); !fault.empty())
        return {std::nullopt, std::string("error: texture '") + table.name + "' cannot be used: " + fault + "\n"};
    const ir::Texture texture = described(table);
    auto block = std::make_shared<Block>();
    block->words.resize((table.block_size + 7) / 8);
    block->put(0, head_of(request));
    for (const ir::Parameter& parameter : texture.parameters) put(*block, parameter, parameter.value);
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
            if (!values[i].warning.empty())
                return {std::nullopt, "error: " + of + values[i].warning + ": its bounds hold for its range alone\n"};
            put(*block, set[i], values[i].value);
        }
    }
    TextureBinding binding;
    binding.texture = &table;
    binding.block = block->words.data();
    binding.facts = table.facts;
    binding.owner = std::move(block);
    return {std::move(binding), {}};
}

} // namespace

TextureSource precompiled(std::vector<const haptel_texture*> textures)
{
    const auto find = [textures = std::move(textures)](const TextureRequest& request) -> TextureResult {
        const std::string_view reference = request.reference;
        const std::string_view name = reference.substr(reference.rfind(':') + 1); // without one: of all
        std::vector<std::string_view> names;
        for (const haptel_texture* table : textures) {
            if (!table || !table->name) continue;
            names.emplace_back(table->name);
            if (table->name != name) continue;
            if (table->abi != HAPTEL_ABI_VERSION)
                return {std::nullopt, "error: texture '" + std::string(name) +
                                          "' was compiled for another version of haptel/abi.h (" +
                                          std::to_string(table->abi) + ", here " + std::to_string(HAPTEL_ABI_VERSION) +
                                          "): compile it anew\n"};
            return bind(*table, request);
        }
        std::string there;
        for (const std::string_view one : names) there += (there.empty() ? "" : ", ") + std::string(one);
        return {std::nullopt, "error: no precompiled texture is called '" + std::string(name) +
                                  "': " + (names.empty() ? "there is none" : "there are " + there) + "\n"};
    };
    return TextureSource(
        std::make_shared<const TextureSource::Implementation>(TextureSource::Implementation{find, find, nullptr}));
}

} // namespace haptel
