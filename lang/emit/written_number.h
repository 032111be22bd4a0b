// A number of lang/math/elementary_*.h that is text of a language: each step appends the line that computes it.
//
// `Words`, of a language and a width, say how it is written: number, word and truth are what declares variables that
// are set once, type is that of a number, fabs and sqrt are names of functions, to_bits and to_number of those that
// read bits as the other, and literal() writes a constant. Single and Double are the words of the two widths.
//
// So the text has the bits of the interpreter by construction, as machine code has (jit/codegen/codegen_math.cpp).
// Lines that no result is made from are left out: compilers warn of them.
#pragma once

#include "lang/math/elementary_number.h"

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::emit {

// The body of one function in the making: every variable is set once and named by its number.
class Lines {
public:
    static std::string name(int variable) { return "t" + std::to_string(variable); }

    int parameter() { return count++; }
    int add(std::string_view type, std::string_view expression, std::initializer_list<int> uses)
    {
        const int made = count++;
        lines.push_back(
            {"    " + std::string(type) + " " + name(made) + " = " + std::string(expression) + ";\n", {made}, uses});
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
template <typename Words>
class WrittenWord {
public:
    WrittenWord(Lines& to, int made) : lines(&to), variable(made) {}

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
        return {a.lines, a.lines->add(Words::truth, a.text() + " != 0u", {a.variable})};
    }
    std::string text() const { return Lines::name(variable); }
    int number() const { return variable; }

private:
    Lines* lines;
    int variable;

    WrittenWord made(const std::string& expression, std::initializer_list<int> uses) const
    {
        return {*lines, lines->add(Words::word, expression, uses)};
    }
    WrittenWord with(const std::string& op, uint64_t word) const
    {
        using Bits = typename ir::elementary::Format<typename Words::Float>::Bits;
        return made(text() + " " + op + " " + std::to_string(static_cast<Bits>(word)) + "u", {variable});
    }
};

template <typename Words>
class Written {
public:
    using Float = typename Words::Float;
    static constexpr bool is_single = sizeof(Float) == sizeof(float);

    Written(Lines& to, int made) : lines(&to), variable(made) {}
    Written(double constant_number) : number(constant_number) {}

    friend Written operator+(Written a, Written b) { return made(a, " + ", b); }
    friend Written operator-(Written a, Written b) { return made(a, " - ", b); }
    friend Written operator*(Written a, Written b) { return made(a, " * ", b); }
    friend Written operator/(Written a, Written b) { return made(a, " / ", b); }
    friend Written operator-(Written a) { return a.held("-" + a.text()); }
    friend WrittenTruth operator<(Written a, Written b) { return compared(a, " < ", b); }
    friend WrittenTruth operator>(Written a, Written b) { return compared(a, " > ", b); }
    friend WrittenTruth operator==(Written a, Written b) { return compared(a, " == ", b); }

    friend Written abs(Written a) { return a.called(Words::fabs); }
    friend Written sqrt(Written a) { return a.called(Words::sqrt); }
    friend Written select(WrittenTruth condition, Written a, Written b)
    {
        Lines& lines = *condition.lines;
        const std::string text = Lines::name(condition.variable) + " ? " + a.text() + " : " + b.text();
        return {lines, lines.add(Words::number, text, {condition.variable, a.variable, b.variable})};
    }
    friend Written constant(Written like, double number)
    {
        Written made(number);
        made.lines = like.lines;
        return made;
    }

    friend WrittenWord<Words> bits(Written a)
    {
        const std::string text = std::string(Words::to_bits) + "(" + a.text() + ")";
        return {*a.lines, a.lines->add(Words::word, text, {a.variable})};
    }
    friend Written with_bits(Written like, WrittenWord<Words> bits)
    {
        const std::string text = std::string(Words::to_number) + "(" + bits.text() + ")";
        return {*like.lines, like.lines->add(Words::number, text, {bits.number()})};
    }

    friend auto narrow(Written a) { return a.template as<typename Words::Single>(); }
    friend auto widen(Written a) { return a.template as<typename Words::Double>(); }

    // In C alone, whose f64 it is for.
    friend void reduce_where(WrittenTruth condition, Written a, ir::elementary::Angle<Written>& angle)
    {
        Written* const parts[] = {&angle.quarters, &angle.high, &angle.low};
        std::string text, places;
        std::vector<int> sets;
        for (Written* part : parts) {
            sets.push_back(a.lines->new_variable());
            const std::string name = Lines::name(sets.back());
            text += "    " + std::string(Words::type) + " " + name + " = " + part->text() + ";\n";
            places += ", &" + name;
        }
        text += "    if (" + Lines::name(condition.variable) + ") haptel_reduce_angle(" + a.text() + places + ");\n";
        a.lines->add_text(text, sets,
                          {condition.variable, a.variable, parts[0]->variable, parts[1]->variable, parts[2]->variable});
        for (size_t i = 0; i < 3; ++i) *parts[i] = Written(*a.lines, sets[i]);
    }

    // The result of a function of the language.
    Written called(std::string_view function) const { return held(std::string(function) + "(" + text() + ")"); }
    int result() const { return variable; }

private:
    Lines* lines = nullptr; // null: a constant on its way
    int variable = -1;      // below 0: it is a constant
    double number = 0;

    std::string text() const { return variable < 0 ? Words::literal(number) : Lines::name(variable); }
    Written held(const std::string& expression) const
    {
        return {*lines, lines->add(Words::number, expression, {variable})};
    }
    template <typename Other>
    Written<Other> as() const
    {
        return {*lines, lines->add(Other::number, "(" + std::string(Other::type) + ")" + text(), {variable})};
    }
    static Lines& lines_of(Written a, Written b) { return a.lines ? *a.lines : *b.lines; }
    static Written made(Written a, const char* op, Written b)
    {
        Lines& to = lines_of(a, b);
        return {to, to.add(Words::number, a.text() + op + b.text(), {a.variable, b.variable})};
    }
    static WrittenTruth compared(Written a, const char* op, Written b)
    {
        Lines& to = lines_of(a, b);
        return {&to, to.add(Words::truth, a.text() + op + b.text(), {a.variable, b.variable})};
    }
};

} // namespace haptel::emit
