#include "lang/emit_c/function.h"

#include "lang/abi/outputs.h"
#include "lang/emit_c/operation.h"
#include "lang/emit_c/words.h"
#include "lang/ir/dead_code.h"

#include <algorithm>
#include <set>

namespace haptel::emit_c {

namespace {

// Where an input stands: in *point, or in the head of the block.
std::string place_of(ir::Input input)
{
    constexpr std::string_view names[] = {
#define INPUT(name) #name,
#include "lang/ir/inputs.def"
    };
    const std::string_view name = names[static_cast<size_t>(input)];
    const std::string of = input < ir::Input::center_x ? "point->" : "values->head.";
    switch (input) {
    case ir::Input::time: return of + "time_s";
    case ir::Input::normal_force: return of + "normal_force_n";
    case ir::Input::tool_radius: return of + "tool_radius_m";
    case ir::Input::curvature: return of + "curvature_per_m";
    case ir::Input::footprint: return of + "footprint_m";
    default: break; // a component of a vector, or of a Jacobian
    }
    const size_t last = name.rfind('_');
    std::string place = of + std::string(name.substr(0, last));
    for (const char axis : name.substr(last + 1))
        place += "[" + std::to_string(axis >= 'x' ? axis - 'x' : axis - '0') + "]";
    return place;
}

bool changes_nothing(ir::Op op)
{
    return op == ir::Op::detach || op == ir::Op::i_as_u || op == ir::Op::u_as_i;
}

std::string readable(std::string_view name)
{
    std::string word;
    for (const char c : name.substr(0, name.find_first_of("(<")))
        word += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
    return word;
}

} // namespace

class FunctionText {
public:
    // `entry`: of which texture it is the entry; null: a function that others call.
    FunctionText(ModuleText& owner, ir::Function of, const ir::Texture* entry)
        : module(owner), function(std::move(of)), texture(entry), texts(function.value_types.size())
    {
        ir::remove_dead_code(function);
        texts.resize(function.value_types.size());
        note_uses(function.body);
    }

    // The statements, with what they call written before.
    void run() { block(function.body); }
    const ir::Function& source() const { return function; }
    std::string text(ir::Value value) const { return texts[value.index].empty() ? name(value) : texts[value.index]; }
    static std::string name(ir::Value value) { return "v" + std::to_string(value.index); }
    std::string type(ir::Value value) const { return type_name(function.type(value)); }
    // Of a variable that is set once.
    std::string fixed_type(ir::Value value) const
    {
        return type(value).ends_with('*') ? type(value) + " const" : "const " + type(value);
    }
    bool is_used(ir::Value value) const { return used.contains(value.index); }

    std::string statements;
    uint64_t bytes = 0, bytes_of_callees = 0;

private:
    ModuleText& module;
    ir::Function function; // without what no result needs
    const ir::Texture* const texture;
    std::vector<std::string> texts; // by value: what stands for it and is not its own name
    std::set<uint32_t> used;        // by what is written
    std::string margin = "    ";

    std::string type_name(ir::Type type) const
    {
        switch (type) {
        case ir::Type::real: return module.is_single ? "float" : "double";
        case ir::Type::i32:
        case ir::Type::u32: return "uint32_t";
        case ir::Type::boolean: return "int";
        case ir::Type::image: return "const haptel_image*";
        }
        return {};
    }
    void note_uses(const ir::Block& block)
    {
        for (ir::Value value : block.yields) used.insert(value.index);
        for (const ir::Instruction& made : block.instructions) {
            for (ir::Value value : made.operands) used.insert(value.index);
            for (const ir::Block& inner : ir::blocks_of(made)) note_uses(inner);
        }
    }

    void line(const std::string& text) { statements += margin + text + "\n"; }
    void count(ir::Value value)
    {
        const ir::Type type = function.type(value);
        bytes += type == ir::Type::image || (type == ir::Type::real && !module.is_single) ? 8 : 4;
    }
    void define(ir::Value value, const std::string& expression)
    {
        count(value);
        line(fixed_type(value) + " " + name(value) + " = " + expression + ";");
    }
    void declare(ir::Value value)
    {
        count(value);
        line(type(value) + " " + name(value) + ";");
    }

    void block(const ir::Block& block)
    {
        for (const ir::Instruction& made : block.instructions)
            std::visit([&](const auto& kind) { write(made, kind); }, made.kind);
    }
    void inner_block(const ir::Block& inner, const std::vector<ir::Value>& results)
    {
        block(inner);
        for (size_t i = 0; i < results.size(); ++i) line(name(results[i]) + " = " + text(inner.yields[i]) + ";");
    }

    void write(const ir::Instruction& made, const ir::RealConstant& constant)
    {
        texts[made.results[0].index] = literal(constant.value, module.is_single);
    }
    void write(const ir::Instruction& made, const ir::WordConstant& constant)
    {
        const bool is_truth = function.type(made.results[0]) == ir::Type::boolean;
        texts[made.results[0].index] = is_truth ? std::to_string(constant.bits != 0) : literal(constant.bits);
    }
    void write(const ir::Instruction& made, const ir::Operation& operation)
    {
        std::vector<std::string> operands;
        for (ir::Value operand : made.operands) operands.push_back(text(operand));
        if (changes_nothing(operation.op)) {
            texts[made.results[0].index] = operands[0];
            return;
        }
        define(made.results[0], expression(operation.op, operands, module.is_single));
    }
    void write(const ir::Instruction& made, const ir::ReadInput& read)
    {
        define(made.results[0], (module.is_single ? "(float)" : "") + place_of(read.input));
    }
    void write(const ir::Instruction& made, const ir::ReadParameter& read)
    {
        const ir::Parameter& parameter = texture->parameters[read.parameter];
        const std::string member = "values->" + member_name(*texture, parameter);
        switch (parameter.type) {
        case ir::Type::real: return define(made.results[0], (module.is_single ? "(float)" : "") + member);
        case ir::Type::i32:
        case ir::Type::u32: return define(made.results[0], "(uint32_t)" + member);
        case ir::Type::boolean: return define(made.results[0], member + " != 0");
        case ir::Type::image: return define(made.results[0], member);
        }
    }
    void write(const ir::Instruction& made, const ir::ReadTable& read)
    {
        define(made.results[0], module.table(read.table) + "[" + text(made.operands[0]) + "]");
    }
    void write(const ir::Instruction& made, const ir::Call& call)
    {
        const ModuleText::Named& callee = module.function(call.function);
        bytes_of_callees = std::max(bytes_of_callees, callee.bytes);
        std::string arguments;
        const auto add = [&](const std::string& argument) { arguments += (arguments.empty() ? "" : ", ") + argument; };
        for (ir::Value operand : made.operands) add(text(operand));
        if (made.results.size() == 1) return define(made.results[0], callee.name + "(" + arguments + ")");
        for (ir::Value result : made.results) {
            declare(result);
            add("&" + name(result));
        }
        line(callee.name + "(" + arguments + ");");
    }
    void write(const ir::Instruction&, const ir::PointDerivative&) {} // in no program that is verified
    void write(const ir::Instruction& made, const ir::If& choice)
    {
        for (ir::Value result : made.results) declare(result);
        line("if (" + text(made.operands[0]) + ") {");
        for (size_t i = 0; i < 2; ++i) {
            margin += "    ";
            inner_block(choice.arms[i], made.results);
            margin.resize(margin.size() - 4);
            line(i == 0 ? "} else {" : "}");
        }
    }
    // The results hold the carried values between iterations.
    void write(const ir::Instruction& made, const ir::For& loop)
    {
        const ir::Block& body = loop.body[0];
        for (size_t i = 0; i < made.results.size(); ++i) {
            count(made.results[i]);
            line(type(made.results[i]) + " " + name(made.results[i]) + " = " + text(made.operands[i + 1]) + ";");
        }
        const std::string turn = name(body.parameters[0]);
        count(body.parameters[0]);
        line("uint32_t " + turn + ";");
        line("for (" + turn + " = 0; (int32_t)" + turn + " < (int32_t)" + text(made.operands[0]) + "; ++" + turn +
             ") {");
        margin += "    ";
        for (size_t i = 0; i < made.results.size(); ++i)
            if (is_used(body.parameters[i + 1])) define(body.parameters[i + 1], name(made.results[i]));
        inner_block(body, made.results);
        margin.resize(margin.size() - 4);
        line("}");
    }
};

// Recurses as deep as functions call each other, which is 128 at most (lang/check/call_graph.cpp).
const ModuleText::Named& ModuleText::function(uint32_t index)
{
    if (const auto known = written.find(index); known != written.end()) return known->second;
    const ir::Function& source = module.functions[index];
    FunctionText body(*this, source, nullptr);
    body.run();
    const ir::Function& made = body.source();
    const std::vector<ir::Value>& results = made.body.yields;
    const std::string name = prefix + std::to_string(index) + "_" + readable(source.name);
    std::string arguments, ignored, returned;
    const auto add = [&](const std::string& argument) { arguments += (arguments.empty() ? "" : ", ") + argument; };
    for (ir::Value parameter : made.parameters) {
        add(body.fixed_type(parameter) + " " + body.name(parameter));
        if (!body.is_used(parameter)) ignored += "    (void)" + body.name(parameter) + ";\n";
    }
    for (size_t i = 0; i < results.size(); ++i) {
        if (results.size() == 1) {
            returned = "    return " + body.text(results[i]) + ";\n";
        } else {
            add(body.type(results[i]) + "* const r" + std::to_string(i));
            returned += "    *r" + std::to_string(i) + " = " + body.text(results[i]) + ";\n";
        }
    }
    const std::string type = results.size() == 1 ? body.type(results[0]) : "void";
    function_text += "/* " + in_comment(source.name, " * ") + " */\nstatic " + type + " " + name + "(" +
                     (arguments.empty() ? "void" : arguments) + ")\n{\n" + ignored + body.statements + returned +
                     "}\n\n";
    return written.emplace(index, Named{name, body.bytes + body.bytes_of_callees}).first->second;
}

const std::string& ModuleText::table(uint32_t index)
{
    std::string& name = table_names[index];
    if (!name.empty()) return name;
    const ir::Table& table = module.tables[index];
    name = prefix + "table" + std::to_string(index);
    const bool is_real = table.element == ir::Type::real;
    const std::string type = !is_real ? "uint32_t" : is_single ? "float" : "double";
    table_text += "static const " + type + " " + name + "[" + std::to_string(table.size()) + "] = {";
    for (size_t i = 0; i < table.size(); ++i) {
        table_text += i % 8 == 0 ? "\n    " : " ";
        table_text += (is_real ? literal(table.reals[i], is_single) : literal(table.words[i])) + ",";
    }
    table_text += "\n};\n\n";
    bytes_of_tables += uint64_t{table.size()} * (type == "double" ? 8 : 4);
    return name;
}

std::string ModuleText::entry(const LibraryTexture& of, bool with_gradient)
{
    const ir::Texture& texture = *of.texture;
    const uint32_t index = with_gradient ? texture.height_gradient : texture.height;
    ir::Function source = module.functions[index];
    if (with_gradient) source.body.yields.pop_back(); // the faults of the height alone
    FunctionText body(*this, std::move(source), &texture);
    body.run();
    const std::vector<ir::Value>& results = body.source().body.yields;
    std::string stores;
    const auto store = [&](const std::string& member, ir::Value value, bool is_real = true) {
        const bool widens = is_real && is_single;
        stores += "    sample->" + member + " = " + (widens ? "(double)" : "") + body.text(value) + ";\n";
    };
    store("height_m", results[0]);
    store("faults", results[with_gradient ? 4 : 1], false);
    if (with_gradient) {
        for (size_t i = 0; i < 3; ++i) store("gradient[" + std::to_string(i) + "]", results[1 + i]);
        for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
            for (size_t i = 0; i < output.components; ++i)
                store(std::string(output.name) + (output.components > 1 ? "[" + std::to_string(i) + "]" : ""),
                      results[5 + first + i]);
        });
        for_each_output(outputs_always_written & ~texture.writes, [&](const OutputInfo& output, size_t) {
            stores += "    sample->" + std::string(output.name) + " = " + literal(output.value) + ";\n";
        });
    }
    const std::string name = prefix + std::to_string(index) + (with_gradient ? "_height_gradient" : "_height");
    function_text += "static void " + name +
                     "(const haptel_point* const point, const void* const block, haptel_sample* const sample)\n{\n"
                     "    const " +
                     block_type(texture) + "* const values = (const " + block_type(texture) +
                     "*)block;\n    (void)point;\n    (void)values;\n" + body.statements + stores + "}\n\n";
    bytes_at_most = std::max(bytes_at_most, body.bytes + body.bytes_of_callees);
    return name;
}

} // namespace haptel::emit_c
