#include "bench/compile_bench.h"

#include "bench/generated_texture.h"
#include "jit/texture.h"
#include "lang/compile.h"
#include "stdlib/stdlib.h"

#include <algorithm>

namespace haptel::bench {
namespace {

struct Measured {
    CompileRow row;
    std::string text;
    std::vector<double> front_end_ms, warm_ms;
};

void compile_front_end(const std::string& text)
{
    lang::CompileOptions options;
    for (const stdlib::LibraryFile& file : stdlib::library())
        options.library.push_back({std::string(file.name), std::string(file.text)});
    lang::compile({"field.haptel", text}, options);
}

} // namespace

std::vector<CompileRow> bench_compile(bool quick)
{
    std::vector<Measured> all;
    const auto add = [&](std::string name, std::string text) {
        const auto lines = static_cast<uint32_t>(std::count(text.begin(), text.end(), '\n'));
        all.push_back({{std::move(name), lines, {}, 0, {}}, std::move(text), {}, {}});
    };
    add("one line", "texture waves() { return 50um * sinturn(p.x / 2mm); }\n");
    for (uint32_t lines : {100, 200, 400, 800, 1600}) add("field", generated_texture(lines));

    const uint32_t longest_to_code = quick ? 100 : 400; // machine code of the longer ones takes seconds
    for (Measured& one : all)
        if (one.row.lines <= longest_to_code) one.row.first_ms = milliseconds([&] { jit::compile_texture(one.text); });
    const int rounds = quick ? 11 : 101;
    for (int round = 0; round < rounds; ++round)
        for (Measured& one : all) {
            one.front_end_ms.push_back(milliseconds([&] { compile_front_end(one.text); }));
            if (one.row.lines <= longest_to_code && round < (quick ? 2 : 9))
                one.warm_ms.push_back(milliseconds([&] { jit::compile_texture(one.text); }));
        }
    std::vector<CompileRow> rows;
    for (Measured& one : all) {
        one.row.front_end = summary(std::move(one.front_end_ms));
        one.row.warm = summary(std::move(one.warm_ms));
        rows.push_back(one.row);
    }
    return rows;
}

double growth(const std::vector<CompileRow>& rows)
{
    const auto per_line = [&](const CompileRow& row) {
        return (row.front_end.median - rows[0].front_end.median) / (row.lines - rows[0].lines);
    };
    return per_line(rows.back()) / per_line(rows[1]);
}

} // namespace haptel::bench
