// What tests of text made from the IR compare it with: textures from text, and what the interpreter says of them.
#pragma once

#include "lang/abi/outputs.h"
#include "lang/compile.h"
#include "lang/emit_c/library.h"
#include "lang/ir/run/interpret.h"
#include "stdlib/stdlib.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace haptel::test {

inline std::string text_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::shared_ptr<const lang::Program> program_of(const std::string& name, const std::string& text)
{
    lang::CompileOptions options;
    for (const stdlib::LibraryFile& file : stdlib::library())
        options.library.push_back({std::string(file.name), std::string(file.text)});
    options.load_import = [](std::string_view path, std::string_view importer) {
        const auto file = std::filesystem::path(importer).parent_path() / path;
        return lang::Imported(lang::SourceFile{file.string(), text_of(file)});
    };
    const lang::CompileResult result = lang::compile({name, text}, options);
    INFO(lang::render(result.diagnostics.all(), result.sources));
    REQUIRE(result.program);
    return result.program;
}

inline std::vector<emit_c::LibraryTexture> textures_of(const lang::Program& program)
{
    std::vector<emit_c::LibraryTexture> textures;
    for (const ir::Texture& texture : program.module.textures)
        textures.push_back({&program.module, &texture, {-HUGE_VAL, HUGE_VAL, 1.5, HUGE_VAL, 1, 42}, "file.haptel"});
    return textures;
}

// Of a block, whose head is what the entry reads behind the point.
template <typename T>
ir::EntryInputs<T> inputs_of(const ir::Texture& texture, const haptel_point& point, const std::vector<double>& block)
{
    ir::EntryInputs<T> inputs;
    constexpr size_t of_point = sizeof point / sizeof(double);
    double numbers[of_point];
    std::memcpy(numbers, &point, sizeof point);
    std::copy_n(numbers, of_point, inputs.input);
    std::copy_n(block.data(), sizeof(haptel_block_head) / sizeof(double), inputs.input + of_point);
    for (const ir::Parameter& parameter : texture.parameters) {
        const char* const place = reinterpret_cast<const char*>(block.data()) + parameter.offset;
        ir::Slot<T>& slot = inputs.parameters.emplace_back();
        double real = 0;
        if (parameter.type == ir::Type::real)
            std::memcpy(&real, place, sizeof real);
        else if (parameter.type == ir::Type::image)
            std::memcpy(&slot.image, place, sizeof slot.image);
        else
            std::memcpy(&slot.bits, place, sizeof slot.bits);
        if (parameter.type == ir::Type::real) slot.real = real;
    }
    return inputs;
}

// Of the interpreter over double.
inline haptel_sample interpreted(ir::Interpreter<double>& interpreter, const ir::Texture& texture,
                                 const haptel_point& point, const std::vector<double>& block, bool with_gradient)
{
    const ir::EntryInputs<double> inputs = inputs_of<double>(texture, point, block);
    haptel_sample sample = blank_sample;
    const auto results = interpreter.run(with_gradient ? texture.height_gradient : texture.height, {}, &inputs);
    sample.height_m = results[0].real;
    sample.faults = results[with_gradient ? 4 : 1].bits;
    if (!with_gradient) return sample;
    for (size_t i = 0; i < 3; ++i) sample.gradient[i] = results[1 + i].real;
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        for (size_t i = 0; i < output.components; ++i) components_of(sample, output)[i] = results[5 + first + i].real;
    });
    return sample;
}

} // namespace haptel::test
