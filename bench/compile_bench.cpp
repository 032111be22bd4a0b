#include "bench/compile_bench.h"

#include "bench/example_textures.h"
#include "bench/generated_texture.h"
#include "jit/texture/texture.h"
#include "lang/compile.h"
#include "stdlib/stdlib.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>

namespace haptel::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* field = "field"; // the generated texts' name

std::vector<Text> all_texts()
{
    std::vector<Text> all{{"one line", "texture waves() { return 50um * sinturn(p.x / 2mm); }\n"}};
    for (const stdlib::LibraryFile& file : stdlib::example_textures())
        all.push_back({fs::path(file.name).stem().string(), std::string(file.text)});
    for (uint32_t lines : {100, 200, 400, 800, 1600})
        all.push_back({field + (" " + std::to_string(lines)), generated_texture(lines)});
    return all;
}

// Another constant factor for every edit, in what the last texture returns.
std::string edited(std::string text, uint32_t edit)
{
    const std::string before = "return ";
    const size_t last = text.rfind(before);
    if (last == std::string::npos) throw std::runtime_error("a text that is measured returns nothing to edit");
    const size_t begin = last + before.size();
    char factor[32];
    std::snprintf(factor, sizeof factor, "1.%07u * (", edit);
    text.insert(text.find(';', begin), ")");
    return text.insert(begin, factor);
}

std::shared_ptr<const jit::CompiledProgram> compiled(const std::string& text)
{
    jit::CompiledTextures made = jit::compile_texture(text, jit::servo_options()); // as a scene does
    if (!made.program || made.program->textures().empty())
        throw std::runtime_error("a text that is measured has no texture that compiles: " + made.rendered());
    return made.program;
}

void bind_to_object(const std::shared_ptr<const jit::CompiledProgram>& program)
{
    TextureRequest request;
    for (size_t i = 0; i < 3; ++i) request.box_minimum_m[i] = -0.1, request.box_maximum_m[i] = 0.1;
    request.servo_period_s = 1e-3;
    const TextureResult bound = jit::make_binding(program, program->textures().back().name, request); // for a hand
    if (!bound.binding) throw std::runtime_error("a text that is measured cannot be bound: " + bound.diagnostics);
}

struct Measured {
    CompileRow row;
    std::string text;
    std::vector<double> front_end_ms = {}, warm_ms = {}, binding_ms = {}, felt_ms = {}, first_ms = {}, primed_ms = {},
                        cached_ms = {};
};

std::vector<Measured> to_measure(const std::vector<Text>& texts)
{
    std::vector<Measured> all;
    for (const Text& text : texts) {
        const auto lines = static_cast<uint32_t>(std::count(text.text.begin(), text.text.end(), '\n'));
        all.push_back({{text.name, lines, {}, {}, {}, {}, 0, 0, 0}, text.text});
    }
    return all;
}

void measure_warm(Measured& one, uint32_t edit)
{
    const std::string text = edited(one.text, edit);
    one.front_end_ms.push_back(milliseconds([&] { jit::check_texture(text); }));
    std::shared_ptr<const jit::CompiledProgram> program;
    one.warm_ms.push_back(milliseconds([&] { program = compiled(text); }));
    one.binding_ms.push_back(milliseconds([&] { bind_to_object(program); }));
    one.felt_ms.push_back(one.warm_ms.back() + one.binding_ms.back());
}

// Processes with a folder of code on disk that is empty at first.
void measure_fresh(Measured& one, uint32_t round, const FreshProcess& fresh_process)
{
    const fs::path folder =
        fs::temp_directory_path() / ("haptel-bench-" + std::to_string(getpid()) + "-" + std::to_string(round));
    std::error_code ignored;
    const auto add = [&](std::vector<double>& times, uint32_t edit) {
        if (const auto time = fresh_process(one.row.texture, edit, folder.string())) times.push_back(*time);
    };
    add(one.first_ms, 0);
    add(one.primed_ms, 1);
    add(one.cached_ms, 1);
    fs::remove_all(folder, ignored);
}

// What is only done once per process is not warm.
void warm_up(std::vector<Measured>& all)
{
    for (Measured& one : all) measure_warm(one, 0);
    for (Measured& one : all)
        one.front_end_ms.clear(), one.warm_ms.clear(), one.binding_ms.clear(), one.felt_ms.clear();
}

std::vector<CompileRow> rows_of(std::vector<Measured>& all)
{
    std::vector<CompileRow> rows;
    for (Measured& one : all) {
        one.row.front_end = summary(std::move(one.front_end_ms));
        one.row.warm = summary(std::move(one.warm_ms));
        one.row.binding = summary(std::move(one.binding_ms));
        one.row.felt = summary(std::move(one.felt_ms));
        one.row.first_ms = summary(std::move(one.first_ms)).median;
        one.row.primed_ms = summary(std::move(one.primed_ms)).median;
        one.row.cached_ms = summary(std::move(one.cached_ms)).median;
        rows.push_back(one.row);
    }
    return rows;
}

} // namespace

std::vector<CompileRow> bench_compile(bool quick, const FreshProcess& fresh_process)
{
    std::vector<Measured> all = to_measure(all_texts());
    const uint32_t rounds = quick ? 5 : 101, fresh_rounds = quick ? 1 : 5;
    const uint32_t rounds_of_long = quick ? 2 : 11; // a second each
    warm_up(all);
    for (uint32_t round = 1; round <= rounds; ++round)
        for (Measured& one : all) {
            if (one.row.lines <= 100 || round <= rounds_of_long) measure_warm(one, round);
            if (round <= fresh_rounds) measure_fresh(one, round, fresh_process);
        }
    return rows_of(all);
}

std::vector<CompileRow> bench_edits(const std::vector<Text>& texts, bool quick)
{
    std::vector<Measured> all = to_measure(texts);
    warm_up(all);
    const uint32_t rounds = quick ? 5 : 51;
    for (uint32_t round = 1; round <= rounds; ++round)
        for (Measured& one : all) measure_warm(one, round);
    return rows_of(all);
}

std::optional<double> first_compile(const std::string& texture, uint32_t edit)
{
    for (const Text& one : all_texts()) {
        if (one.name != texture) continue;
        const std::string text = edited(one.text, edit);
        std::shared_ptr<const jit::CompiledProgram> program;
        const double time = milliseconds([&] { program = compiled(text); });
        program->optimise();
        return time;
    }
    return std::nullopt;
}

double growth(const std::vector<CompileRow>& rows, Times CompileRow::* times)
{
    std::vector<const CompileRow*> by_length{&rows[0]};
    for (const CompileRow& row : rows)
        if (row.texture.starts_with(field)) by_length.push_back(&row);
    const auto per_line = [&](const CompileRow& row) {
        return ((row.*times).median - (rows[0].*times).median) / (row.lines - rows[0].lines);
    };
    return per_line(*by_length.back()) / per_line(*by_length[1]);
}

} // namespace haptel::bench
