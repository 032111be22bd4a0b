#include "lang/ir/print.h"
#include "lang/ir/op_info.h"

#include <bit>
#include <charconv>
#include <cmath>

namespace haptel::ir {

std::string_view to_string(Input input)
{
    constexpr std::string_view names[] = {
#define INPUT(name) #name,
#include "lang/ir/inputs.def"
    };
    return names[static_cast<size_t>(input)];
}

namespace {

// Shortest digits that read back as the same bits; a NaN other than the usual one shows its bits.
std::string number(double value)
{
    if (std::isnan(value)) {
        auto bits = std::bit_cast<uint64_t>(value);
        if (bits == 0x7ff8000000000000u) return "nan";
        char text[24];
        auto end = std::to_chars(text, text + sizeof text, bits, 16).ptr;
        return "nan:" + std::string(text, end);
    }
    char text[32];
    auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

std::string word(Type type, uint32_t bits)
{
    return type == Type::i32 ? std::to_string(static_cast<int32_t>(bits)) : std::to_string(bits);
}

std::string quoted(std::string_view text)
{
    std::string result = "\"";
    for (char c : text) {
        if (c == '\n') {
            result += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + '"';
}

class Printer {
public:
    explicit Printer(const Module& whole) : module(whole) {}

    std::string text;

    void print(const Table& table)
    {
        text += "table " + quoted(table.name) + " " + std::string(to_string(table.element)) + " [";
        for (uint32_t i = 0; i < table.size(); ++i) {
            if (i) text += ", ";
            text += table.element == Type::real ? number(table.reals[i]) : word(table.element, table.words[i]);
        }
        text += "]\n";
    }

    void print(const Function& source)
    {
        function = &source;
        names.assign(source.value_types.size(), UINT32_MAX);
        next_name = 0;
        text += "function " + quoted(source.name) + " (";
        for (size_t i = 0; i < source.parameters.size(); ++i) {
            if (i) text += ", ";
            text += define(source.parameters[i]) + ": " + std::string(to_string(source.type(source.parameters[i])));
        }
        text += ")";
        if (source.first_argument_size) text += " first " + std::to_string(source.first_argument_size);
        if (source.is_library) text += " library";
        for (size_t r = 0; r < source.facts.size(); ++r) {
            text += r == 0 ? " facts" : " next";
            print(source.facts[r]);
        }
        text += " {\n";
        print(source.body, "return", 1);
        text += "}\n";
    }

    void print(const Texture& texture)
    {
        text += "texture " + quoted(texture.name) + " {\n";
        if (!texture.doc.empty()) text += "  doc " + quoted(texture.doc) + "\n";
        for (const Parameter& parameter : texture.parameters) {
            text += "  parameter " + quoted(parameter.name) + " " + std::string(to_string(parameter.type)) + " " +
                    number(parameter.value) + " in " + number(parameter.minimum) + " .. " + number(parameter.maximum) +
                    " unit " + quoted(parameter.unit) + " offset " + std::to_string(parameter.offset);
            if (!parameter.doc.empty()) text += " doc " + quoted(parameter.doc);
            text += "\n";
        }
        text += "  block " + std::to_string(texture.block_size) + " reads " + std::to_string(texture.reads) +
                " writes " + std::to_string(texture.writes) + "\n";
        auto entry = [&](const char* role, uint32_t index) {
            if (index != UINT32_MAX)
                text += "  " + std::string(role) + " " + quoted(module.functions[index].name) + "\n";
        };
        entry("body", texture.body);
        entry("height", texture.height);
        entry("height_gradient", texture.height_gradient);
        text += "}\n";
    }

private:
    const Module& module;
    const Function* function = nullptr;
    std::vector<uint32_t> names; // by Value::index: number in order of appearance
    uint32_t next_name = 0;

    std::string define(Value value)
    {
        names[value.index] = next_name++;
        return use(value);
    }
    std::string use(Value value) const { return "%" + std::to_string(names[value.index]); }

    template <typename Name>
    void list(const std::vector<Value>& values, size_t first, const Name& name)
    {
        for (size_t i = first; i < values.size(); ++i) text += (i > first ? ", " : "") + name(values[i]);
    }
    void uses(const std::vector<Value>& values, size_t first = 0)
    {
        list(values, first, [&](Value value) { return use(value); });
    }
    void definitions(const std::vector<Value>& values)
    {
        list(values, 0, [&](Value value) { return define(value); });
    }

    void print(const Facts& facts)
    {
        if (facts.value_minimum) text += " minimum " + number(*facts.value_minimum);
        if (facts.value_maximum) text += " maximum " + number(*facts.value_maximum);
        if (facts.slope) text += " slope " + number(*facts.slope);
        if (facts.curvature) text += " curvature " + number(*facts.curvature);
        if (facts.continuity) text += " class " + std::string(to_string(*facts.continuity));
        if (facts.proven) text += " proven";
    }

    void print(const Block& block, std::string_view ending, size_t depth)
    {
        const std::string margin(2 * depth, ' ');
        for (const Instruction& made : block.instructions) {
            text += margin;
            definitions(made.results);
            text += " = ";
            std::visit([&](const auto& kind) { print(made, kind, depth); }, made.kind);
            text += "\n";
        }
        text += margin + std::string(ending);
        if (!block.yields.empty()) text += " ";
        uses(block.yields);
        text += "\n";
    }

    void print(const Instruction& made, const Operation& operation, size_t)
    {
        text += std::string(op_info(operation.op).name) + " ";
        uses(made.operands);
    }
    void print(const Instruction&, const RealConstant& constant, size_t) { text += "real " + number(constant.value); }
    void print(const Instruction& made, const WordConstant& constant, size_t)
    {
        Type type = function->type(made.results[0]);
        const bool is_truth = type == Type::boolean;
        text += std::string(to_string(type)) + " ";
        text += !is_truth ? word(type, constant.bits) : constant.bits ? "true" : "false";
    }
    void print(const Instruction&, const ReadInput& read, size_t)
    {
        text += "input " + std::string(to_string(read.input));
    }
    void print(const Instruction& made, const ReadParameter& read, size_t)
    {
        text += "parameter " + std::to_string(read.parameter) + " " +
                std::string(to_string(function->type(made.results[0])));
    }
    void print(const Instruction& made, const ReadTable& read, size_t)
    {
        text += "table " + std::to_string(read.table) + " ";
        uses(made.operands);
    }
    void print(const Instruction& made, const Call& call, size_t)
    {
        text += "call " + quoted(module.functions[call.function].name) + " (";
        uses(made.operands);
        text += ")";
    }
    void print(const Instruction& made, const PointDerivative& derivative, size_t)
    {
        text += "d_dp " + std::to_string(derivative.axis) + " ";
        uses(made.operands);
    }
    void print(const Instruction& made, const If& choice, size_t depth)
    {
        text += "if ";
        uses(made.operands);
        text += " {\n";
        print(choice.arms[0], "yield", depth + 1);
        text += std::string(2 * depth, ' ') + "} else {\n";
        print(choice.arms[1], "yield", depth + 1);
        text += std::string(2 * depth, ' ') + "}";
    }
    void print(const Instruction& made, const For& loop, size_t depth)
    {
        text += "for " + use(made.operands[0]) + " max " + std::to_string(loop.trip_max) + " (";
        definitions(loop.body[0].parameters);
        text += ") from (";
        uses(made.operands, 1);
        text += ") {\n";
        print(loop.body[0], "yield", depth + 1);
        text += std::string(2 * depth, ' ') + "}";
    }
};

} // namespace

std::string print(const Module& module)
{
    Printer printer(module);
    for (const Table& table : module.tables) printer.print(table);
    for (const Function& function : module.functions) printer.print(function);
    for (const Texture& texture : module.textures) printer.print(texture);
    return std::move(printer.text);
}

std::string print(const Module& module, const Function& function)
{
    Printer printer(module);
    printer.print(function);
    return std::move(printer.text);
}

} // namespace haptel::ir
