// Textures: their parameters' places in the block, their bodies, their entries.
#include "lang/lower/lower.h"

#include "lang/abi/outputs.h"
#include "lang/ir/cost.h"
#include "lang/ir/dead_code.h"
#include "lang/ir/derive/point_derivative.h"
#include "lang/ir/verify.h"
#include "lang/lower/lowering.h"
#include "lang/program/builtins.h"
#include "lang/text/limits.h"

#include <algorithm>
#include <map>
#include <utility>

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

// What of the results shapes the energy that a surface holds: it must be of the place alone, for that to be a
// potential.
std::vector<bool> energy_results(const ir::Texture& texture)
{
    std::vector<bool> results(1 + output_components(texture.writes));
    results[0] = true;
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        results[1 + first] = output.writes == HAPTEL_WRITES_STIFFNESS_SCALE;
    });
    return results;
}

std::string_view input_name(ir::Input input)
{
    for (uint32_t name = input_name_count; name-- > static_cast<uint32_t>(InputName::velocity);)
        if (input >= first_input[name] && input <= ir::Input::curvature) return builtin_inputs[name].name;
    return {};
}

} // namespace

// Height and stiffness that something of the contact shapes, told where it is first used for them.
bool ModuleLowering::refuse_contact(const ir::Texture& texture)
{
    const ir::Function& body = module.functions[texture.body];
    const std::vector<bool> needed = ir::NeededValues(module).of(texture.body, energy_results(texture));
    std::map<uint32_t, const ir::Instruction*> contact; // by Value::index, until told
    ir::for_each_instruction(body.body, [&](const ir::Instruction& made) {
        if (const auto* read = std::get_if<ir::ReadInput>(&made.kind);
            read && !input_name(read->input).empty() && needed[made.results[0].index])
            contact.emplace(made.results[0].index, &made);
    });
    if (contact.empty()) return false;
    const auto [value, read] = *contact.begin();
    Span span = read->span;
    bool is_found = false;
    ir::for_each_instruction(body.body, [&](const ir::Instruction& made) {
        const bool uses = std::ranges::any_of(made.operands, [&](ir::Value used) { return used.index == value; });
        const bool matters =
            std::ranges::any_of(made.results, [&](ir::Value result) { return bool(needed[result.index]); });
        if (uses && matters && !std::exchange(is_found, true)) span = made.span;
    });
    diagnostics.error(
        span, "contact-input",
        "the height or stiffness of '" + texture.name + "' depends on '" +
            std::string(input_name(std::get<ir::ReadInput>(read->kind).input)) + "' here, which is for other outputs",
        "what a surface stores is of the place alone, and has a gradient there; use it for friction_scale, "
        "damping_scale or vibration_n");
    return true;
}

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
    if (refuse_long({made.body}, instructions_max) || refuse_contact(made)) return;
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
