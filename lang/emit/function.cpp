#include "lang/emit/function.h"

#include "lang/abi/outputs.h"
#include "lang/ir/dead_code.h"

#include <algorithm>
#include <set>

namespace haptel::emit {

namespace {

bool changes_nothing(ir::Op op)
{
    return op == ir::Op::detach || op == ir::Op::i_as_u || op == ir::Op::u_as_i;
}

std::string literal(uint32_t word)
{
    return std::to_string(word) + "u";
}

} // namespace

std::string place_of(ir::Input input, const std::string& point, const std::string& head)
{
    constexpr std::string_view names[] = {
#define INPUT(name) #name,
#include "lang/ir/inputs.def"
    };
    const std::string_view name = names[static_cast<size_t>(input)];
    const std::string& of = input < ir::Input::center_x ? point : head;
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

std::string readable(std::string_view name)
{
    std::string word;
    for (const char c : name.substr(0, name.find_first_of("(<"))) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (is_plain)
            word += c;
        else if (!word.empty() && word.back() != '_')
            word += '_';
    }
    if (word.ends_with('_')) word.pop_back();
    return word;
}

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
    ir::Type type(ir::Value value) const { return function.type(value); }
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

    void note_uses(const ir::Block& block)
    {
        for (ir::Value value : block.yields) used.insert(value.index);
        for (const ir::Instruction& made : block.instructions) {
            for (ir::Value value : made.operands) used.insert(value.index);
            for (const ir::Block& inner : ir::blocks_of(made)) note_uses(inner);
        }
    }

    void line(const std::string& text) { statements += margin + text + "\n"; }
    void count(ir::Value value) { bytes += module.dialect.bytes(type(value)); }
    void define(ir::Value value, const std::string& expression)
    {
        count(value);
        line(module.dialect.fixed(type(value)) + " " + name(value) + " = " + expression + ";");
    }
    void declare(ir::Value value)
    {
        count(value);
        line(module.dialect.variable(type(value)) + " " + name(value) + ";");
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
        texts[made.results[0].index] = module.dialect.real(constant.value);
    }
    void write(const ir::Instruction& made, const ir::WordConstant& constant)
    {
        const bool is_truth = function.type(made.results[0]) == ir::Type::boolean;
        texts[made.results[0].index] = is_truth ? module.dialect.truth(constant.bits != 0) : literal(constant.bits);
    }
    void write(const ir::Instruction& made, const ir::Operation& operation)
    {
        std::vector<std::string> operands;
        for (ir::Value operand : made.operands) operands.push_back(text(operand));
        if (changes_nothing(operation.op)) {
            texts[made.results[0].index] = operands[0];
            return;
        }
        define(made.results[0], module.dialect.expression(operation.op, operands));
    }
    void write(const ir::Instruction& made, const ir::ReadInput& read)
    {
        define(made.results[0], module.dialect.read(read.input));
    }
    void write(const ir::Instruction& made, const ir::ReadParameter& read)
    {
        define(made.results[0], module.dialect.read(*texture, texture->parameters[read.parameter]));
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
            add(module.dialect.out_argument(name(result)));
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
            line(module.dialect.variable(type(made.results[i])) + " " + name(made.results[i]) + " = " +
                 text(made.operands[i + 1]) + ";");
        }
        const std::string turn = name(body.parameters[0]);
        count(body.parameters[0]);
        line(module.dialect.variable(ir::Type::u32) + " " + turn + ";");
        const std::string ends[] = {turn, text(made.operands[0])};
        line("for (" + turn + " = 0u; " + module.dialect.expression(ir::Op::ilt, ends) + "; ++" + turn + ") {");
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
    std::string parameters, ignored, returned;
    const auto add = [&](const std::string& parameter) { parameters += (parameters.empty() ? "" : ", ") + parameter; };
    for (ir::Value parameter : made.parameters) {
        add(dialect.parameter(body.type(parameter)) + " " + body.name(parameter));
        if (!body.is_used(parameter)) ignored += dialect.unused(body.name(parameter));
    }
    for (size_t i = 0; i < results.size(); ++i) {
        if (results.size() == 1) {
            returned = "    return " + body.text(results[i]) + ";\n";
        } else {
            const std::string out = "r" + std::to_string(i);
            add(dialect.out_parameter(body.type(results[i]), out));
            returned += "    " + dialect.set_out(out, body.text(results[i])) + ";\n";
        }
    }
    const std::string type = results.size() == 1 ? dialect.type(body.type(results[0])) : "void";
    function_text += dialect.head(type, name, parameters) + "\n{\n" + ignored + body.statements + returned + "}\n\n";
    return written.emplace(index, Named{name, body.bytes + body.bytes_of_callees}).first->second;
}

const std::string& ModuleText::table(uint32_t index)
{
    std::string& name = table_names[index];
    if (!name.empty()) return name;
    const ir::Table& table = module.tables[index];
    name = prefix + "table" + std::to_string(index);
    std::string cells;
    for (size_t i = 0; i < table.size(); ++i) {
        cells += i == 0 ? "\n    " : i % 8 == 0 ? ",\n    " : ", ";
        cells += table.element == ir::Type::real ? dialect.real(table.reals[i]) : literal(table.words[i]);
    }
    table_text += dialect.table(table.element, name, table.size(), cells) + "\n\n";
    bytes_of_tables += table.size() * dialect.bytes(table.element);
    return name;
}

EntryText ModuleText::entry(const ir::Texture& texture, bool with_gradient)
{
    ir::Function source = module.functions[with_gradient ? texture.height_gradient : texture.height];
    if (with_gradient) source.body.yields.pop_back(); // the faults of the height alone
    FunctionText body(*this, std::move(source), &texture);
    body.run();
    bytes_at_most = std::max(bytes_at_most, body.bytes + body.bytes_of_callees);
    EntryText made{body.statements, {}};
    for (ir::Value result : body.source().body.yields) made.results.push_back(body.text(result));
    return made;
}

std::string stores(const EntryText& entry, const ir::Texture& texture, bool with_gradient, const std::string& sample,
                   const std::string& widening)
{
    std::string text;
    const auto store = [&](const std::string& member, const std::string& value) {
        text += "    " + sample + member + " = " + value + ";\n";
    };
    store("height_m", widening + entry.results[0]);
    store("faults", entry.results[with_gradient ? 4 : 1]);
    if (!with_gradient) return text;
    for (size_t i = 0; i < 3; ++i) store("gradient[" + std::to_string(i) + "]", widening + entry.results[1 + i]);
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        for (size_t i = 0; i < output.components; ++i)
            store(std::string(output.name) + (output.components > 1 ? "[" + std::to_string(i) + "]" : ""),
                  widening + entry.results[5 + first + i]);
    });
    return text;
}

} // namespace haptel::emit
