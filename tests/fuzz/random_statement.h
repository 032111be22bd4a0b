// Statements of random_source.h: of any kind, as lines of the text.
#pragma once

#include "tests/fuzz/random_expression.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haptel::fuzz {

class StatementWriter : public ExpressionWriter {
public:
    StatementWriter(uint64_t seed, bool odd) : ExpressionWriter(seed), is_odd(odd) {}

protected:
    std::string text;
    int indent = 0;
    bool in_texture = false;
    Kind result = Kind::real;
    std::vector<std::string> few; // whole numbers between -1 and 5 for certain

    void line(const std::string& code) { text += std::string(static_cast<size_t>(indent) * 4, ' ') + code + "\n"; }
    std::string returned(int depth) { return in_texture ? "1m * (" + real(depth) + ")" : of(result, depth); }

    void statements(int how_many, int depth);
    void list(const std::string& name);

private:
    const bool is_odd;
    int loops = 0;

    void body(int depth);
    void statement(int depth);
    void declaration();
    void late();
    void block(int depth);
    void assignment();
    void branch(int depth);
    void choose(int depth);
    void record();
    std::string small();
    std::string end_of_loop();
    void loop(int depth);
    void turns(int depth);
    void call();
    void several();
    void rows();
    void array();
};

} // namespace haptel::fuzz
