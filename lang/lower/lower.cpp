// Textures: their parameters' places in the block, their bodies, their entries.
#include "lang/lower/lower.h"

#include "lang/abi/abi.h"
#include "lang/ir/cost.h"
#include "lang/ir/derive/point_derivative.h"
#include "lang/ir/verify.h"
#include "lang/lower/lowering.h"
#include "lang/text/limits.h"

namespace haptel::lang {
namespace {

uint32_t size_in_block(ir::Type type)
{
    if (type == ir::Type::image) return sizeof(const haptel_image*);
    return type == ir::Type::real ? sizeof(double) : sizeof(int32_t);
}

uint32_t aligned(uint32_t offset, uint32_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

void lay_out(ir::Texture& made, const CheckedTexture& texture)
{
    uint32_t end = sizeof(haptel_block_head);
    for (const CheckedParameter& parameter : texture.parameters) {
        const size_t count = parameter.components.size();
        for (size_t i = 0; i < count; ++i) {
            ir::Parameter& place = made.parameters.emplace_back();
            place.name = parameter.tree->name.text + (count > 1 ? std::string(".") + "xyzw"[i] : "");
            place.unit = parameter.unit;
            place.doc = parameter.tree->doc;
            place.type = ir_type(parameter.symbol->type);
            place.value = parameter.components[i].value;
            place.minimum = parameter.components[i].minimum;
            place.maximum = parameter.components[i].maximum;
            place.offset = aligned(end, size_in_block(place.type));
            place.span = parameter.tree->span;
            for (const ast::Name& choice : parameter.tree->choices) place.choices.push_back(choice.text);
            end = place.offset + size_in_block(place.type);
        }
    }
    made.block_size = aligned(end, alignof(double));
}

// 12 000 000 as "1.2e7": nobody counts the digits.
std::string magnitude(uint64_t count)
{
    int exponent = 0;
    double digits = static_cast<double>(count);
    for (; digits >= 10; digits /= 10) ++exponent;
    const std::string tenths = std::to_string(static_cast<int>(digits * 10));
    return tenths.substr(0, 1) + "." + tenths.substr(1) + "e" + std::to_string(exponent);
}

} // namespace

void ModuleLowering::texture(const CheckedTexture& texture)
{
    ir::Texture made;
    made.name = texture.tree->name.text;
    made.doc = texture.tree->doc;
    made.span = texture.tree->span;
    lay_out(made, texture);

    BodyLowering body(*this, unique(made.name), texture.slot_count);
    for (const CheckedOutput& output : texture.outputs) {
        body.variable(*output.symbol) = Values(output.info->components, body.builder.real(output.info->value));
        made.writes |= output.info->writes;
        made.output_spans.push_back(output.symbol->span);
    }
    Values results = body.whole_body(*texture.tree->body, float_type);
    for (const CheckedOutput& output : texture.outputs) {
        const Values& components = body.variable(*output.symbol);
        results.insert(results.end(), components.begin(), components.end());
    }
    made.body = body.builder.finish(results);
    if (diagnostics.has_errors()) return;

    const auto refuse_long = [&](std::initializer_list<uint32_t> entries, size_t most) {
        size_t count = 0;
        for (uint32_t entry : entries) count += ir::instructions_reached(module, entry);
        if (count > most)
            diagnostics.error(texture.tree->name.span, "too-large",
                              "'" + made.name + "' and what it calls take " + std::to_string(count) +
                                  " instructions, expected at most " + std::to_string(most),
                              "what repeats is a loop; a function is made anew for each derivative of it");
        return count > most;
    };
    const auto refuse_costly = [&](uint32_t entry) {
        const uint64_t count = ir::operations_max(module, entry);
        if (count > ir::operations_limit)
            diagnostics.error(texture.tree->name.span, "too-costly",
                              "'" + made.name + "' takes up to " + magnitude(count) +
                                  " operations at one point, expected at most " + magnitude(ir::operations_limit),
                              "loops inside loops multiply: lower their bounds");
        return count > ir::operations_limit;
    };
    if (is_too_large(texture.tree->name.span) || refuse_costly(made.body)) return;
    if (refuse_long({made.body}, instructions_max)) return;
    differentiator.make_entries(made);
    if (refuse_costly(made.height_gradient)) return;
    if (refuse_long({made.height, made.height_gradient}, entry_instructions_max)) return;
    module.textures.push_back(std::move(made));
}

ir::Module lower(const CheckedProgram& program, std::string_view only_texture, Diagnostics& diagnostics)
{
    ir::Module module;
    ModuleLowering lowering(module, diagnostics);
    for (const CheckedTexture& texture : program.textures)
        if ((only_texture.empty() || texture.tree->name.text == only_texture) && !diagnostics.full())
            lowering.texture(texture);
    ir::remove_unresolved(module);
    return module;
}

} // namespace haptel::lang
