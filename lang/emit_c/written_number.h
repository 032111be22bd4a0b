// A number of lang/math/elementary_*.h that is C text: each step appends the line that computes it.
//
// So the text has the bits of the interpreter by construction, as machine code has (jit/codegen/codegen_math.cpp).
// Lines that no result is made from are left out: compilers warn of them.
#pragma once

#include "lang/emit_c/words.h"
#include "lang/math/elementary_number.h"

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::emit_c {

// The body of one function in the making: every variable is set once and named by its number.
class Lines {
public:
    static std::string name(int variable) { return "t" + std::to_string(variable); }

    int parameter() { return count++; }
    int add(std::string_view type, std::string_view expression, std::initializer_list<int> uses)
    {
        const int made = count++;
        lines.push_back({"    const " + std::string(type) + " " + name(made) + " = " + std::string(expression) + ";\n",
                         {made},
                         uses});
        return made;
    }
    // As it is; sets variables that new_variables() has named.
    void add_text(std::string text, std::vector<int> sets, std::initializer_list<int> uses)
    {
        lines.push_back({std::move(text), std::move(sets), uses});
    }
    int new_variable() { return count++; }

    std::string text_of(int result) const
    {
        std::vector<bool> needed(static_cast<size_t>(count));
        needed[static_cast<size_t>(result)] = true;
        std::string text;
        for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
            bool is_needed = false;
            for (int set : line->sets) is_needed = is_needed || needed[static_cast<size_t>(set)];
            if (!is_needed) continue;
            for (int use : line->uses)
                if (use >= 0) needed[static_cast<size_t>(use)] = true;
            text.insert(0, line->text);
        }
        return text;
    }

private:
    struct Line {
        std::string text;
        std::vector<int> sets, uses;
    };
    std::vector<Line> lines;
    int count = 0;
};

struct WrittenTruth {
    Lines* lines;
    int variable;
};

// A word for each number, of its width.
class WrittenWord {
public:
    WrittenWord(Lines& to, int made, int of_width) : lines(&to), variable(made), width(of_width) {}

    friend WrittenWord operator+(WrittenWord a, uint64_t b) { return a.with("+", b); }
    friend WrittenWord operator&(WrittenWord a, uint64_t b) { return a.with("&", b); }
    friend WrittenWord operator|(WrittenWord a, uint64_t b) { return a.with("|", b); }
    friend WrittenWord operator^(WrittenWord a, WrittenWord b)
    {
        return a.made(a.text() + " ^ " + b.text(), {a.variable, b.variable});
    }
    friend WrittenWord operator<<(WrittenWord a, int count)
    {
        return a.made(a.text() + " << " + std::to_string(count), {a.variable});
    }
    friend WrittenWord operator>>(WrittenWord a, int count)
    {
        return a.made(a.text() + " >> " + std::to_string(count), {a.variable});
    }
    friend WrittenTruth is_set(WrittenWord a)
    {
        return {a.lines, a.lines->add("int", a.text() + " != 0", {a.variable})};
    }
    std::string text() const { return Lines::name(variable); }
    int number() const { return variable; }

private:
    Lines* lines;
    int variable, width;

    WrittenWord made(const std::string& expression, std::initializer_list<int> uses) const
    {
        return {*lines, lines->add(width == 64 ? "uint64_t" : "uint32_t", expression, uses), width};
    }
    WrittenWord with(const std::string& op, uint64_t word) const
    {
        const std::string other = width == 64 ? std::to_string(word) + "u" : literal(static_cast<uint32_t>(word));
        return made(text() + " " + op + " " + other, {variable});
    }
};

template <typename F>
class Written {
public:
    using Float = F;
    static constexpr bool is_single = sizeof(F) == sizeof(float);
    static constexpr std::string_view type = is_single ? "float" : "double";

    Written(Lines& to, int made) : lines(&to), variable(made) {}
    Written(double constant_number) : number(constant_number) {}

    friend Written operator+(Written a, Written b) { return made(a, " + ", b); }
    friend Written operator-(Written a, Written b) { return made(a, " - ", b); }
    friend Written operator*(Written a, Written b) { return made(a, " * ", b); }
    friend Written operator/(Written a, Written b) { return made(a, " / ", b); }
    friend Written operator-(Written a) { return a.held("-" + a.text(), {a.variable}); }
    friend WrittenTruth operator<(Written a, Written b) { return compared(a, " < ", b); }
    friend WrittenTruth operator>(Written a, Written b) { return compared(a, " > ", b); }
    friend WrittenTruth operator==(Written a, Written b) { return compared(a, " == ", b); }

    friend Written abs(Written a) { return a.called("fabs"); }
    friend Written sqrt(Written a) { return a.called("sqrt"); }
    friend Written select(WrittenTruth condition, Written a, Written b)
    {
        Lines& lines = *condition.lines;
        const std::string text = Lines::name(condition.variable) + " ? " + a.text() + " : " + b.text();
        return {lines, lines.add(type, text, {condition.variable, a.variable, b.variable})};
    }
    friend Written constant(Written like, double number)
    {
        Written made(number);
        made.lines = like.lines;
        return made;
    }

    friend WrittenWord bits(Written a)
    {
        constexpr int width = ir::elementary::Format<F>::width;
        const std::string text = "haptel_bits" + std::to_string(width) + "(" + a.text() + ")";
        return {*a.lines, a.lines->add(is_single ? "uint32_t" : "uint64_t", text, {a.variable}), width};
    }
    friend Written with_bits(Written like, WrittenWord bits)
    {
        return like.held((is_single ? "haptel_real32(" : "haptel_real64(") + bits.text() + ")", {bits.number()});
    }

    friend Written<float> narrow(Written a)
    {
        return {*a.lines, a.lines->add("float", "(float)" + a.text(), {a.variable})};
    }
    friend Written<double> widen(Written a)
    {
        return {*a.lines, a.lines->add("double", "(double)" + a.text(), {a.variable})};
    }

    friend void reduce_where(WrittenTruth condition, Written a, ir::elementary::Angle<Written>& angle)
    {
        Written* const parts[] = {&angle.quarters, &angle.high, &angle.low};
        std::string text, places;
        std::vector<int> sets;
        for (Written* part : parts) {
            sets.push_back(a.lines->new_variable());
            const std::string name = Lines::name(sets.back());
            text += "    double " + name + " = " + part->text() + ";\n";
            places += ", &" + name;
        }
        text += "    if (" + Lines::name(condition.variable) + ") haptel_reduce_angle(" + a.text() + places + ");\n";
        a.lines->add_text(text, sets,
                          {condition.variable, a.variable, parts[0]->variable, parts[1]->variable, parts[2]->variable});
        for (size_t i = 0; i < 3; ++i) *parts[i] = Written(*a.lines, sets[i]);
    }

    int result() const { return variable; }

private:
    Lines* lines = nullptr; // null: a constant on its way
    int variable = -1;      // below 0: it is a constant
    double number = 0;

    std::string text() const { return variable < 0 ? literal(number, is_single) : Lines::name(variable); }
    Written held(const std::string& expression, std::initializer_list<int> uses) const
    {
        return {*lines, lines->add(type, expression, uses)};
    }
    Written called(const std::string& function) const
    {
        return held(function + (is_single ? "f(" : "(") + text() + ")", {variable});
    }
    static Lines& lines_of(Written a, Written b) { return a.lines ? *a.lines : *b.lines; }
    static Written made(Written a, const char* op, Written b)
    {
        Lines& to = lines_of(a, b);
        return {to, to.add(type, a.text() + op + b.text(), {a.variable, b.variable})};
    }
    static WrittenTruth compared(Written a, const char* op, Written b)
    {
        Lines& to = lines_of(a, b);
        return {&to, to.add("int", a.text() + op + b.text(), {a.variable, b.variable})};
    }
};

} // namespace haptel::emit_c
