// One module on every engine: interpreter, code of every effort, batches of all.
#pragma once

#include "jit/engine/engine.h"
#include "lang/ir/run/interpret.h"
#include "tests/support/catch.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace haptel::test {

// Equal bits; any NaN equals any other.
inline bool same(double a, double b)
{
    return (std::isnan(a) && std::isnan(b)) || std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
}

// A point and a block whose doubles are counted as ir::Input counts them. `parameters` follow the head as f64.
struct Arguments {
    haptel_point point{};
    std::vector<double> block = std::vector<double>(sizeof(haptel_block_head) / sizeof(double));

    void set(ir::Input input, double value)
    {
        constexpr size_t of_point = sizeof(haptel_point) / sizeof(double);
        const auto index = static_cast<size_t>(input);
        if (index < of_point)
            std::memcpy(reinterpret_cast<char*>(&point) + index * sizeof(double), &value, sizeof value);
        else
            block[index - of_point] = value;
    }
};

class Engines {
public:
    explicit Engines(const ir::Module& whole) : module(whole), interpreter(whole)
    {
        std::vector<jit::EntryPoint> entries;
        for (const ir::Texture& texture : module.textures) {
            entries.push_back({texture.name, &texture, jit::EntryPoint::Kind::height});
            if (texture.height_gradient != UINT32_MAX)
                entries.push_back({texture.name + "'", &texture, jit::EntryPoint::Kind::height_gradient});
            entries.push_back({texture.name + "*", &texture, jit::EntryPoint::Kind::height, jit::LaneForm::points});
        }
        for (jit::Effort effort : {jit::Effort::draft, jit::Effort::quick, jit::Effort::full}) {
            jit::CodeResult result = jit::compile_code(module, entries, {effort});
            INFO(result.error);
            REQUIRE(result.code);
            code.push_back(std::move(result.code));
        }
    }

    // Height by the interpreter, which takes the reals p_x, p_y, p_z, n_x; `agree` tells whether all code gives it too.
    double height(const ir::Texture& texture, const double (&input)[4], bool& agree)
    {
        Arguments arguments;
        ir::EntryInputs<double> inputs;
        for (size_t i = 0; i < 4; ++i) {
            arguments.set(static_cast<ir::Input>(i), input[i]);
            inputs.input[i] = input[i];
        }
        const double expected = interpreter.run(texture.height, {}, &inputs)[0].real;
        agree = true;
        for (const auto& one : code) {
            haptel_sample sample{};
            one->entry(texture.name)(&arguments.point, arguments.block.data(), &sample);
            agree = agree && same(sample.height_m, expected);
        }
        for (size_t i = 0; i < 4; ++i) asked[i].push_back(input[i]);
        answers.push_back(expected);
        return expected;
    }

    // Whether batches of all sizes over the points asked for since the last call give the same heights.
    bool batches_agree(const ir::Texture& texture)
    {
        bool agree = true;
        const Arguments arguments;
        for (const auto& one : code) {
            size_t size = 1;
            for (size_t first = 0; first < answers.size(); first += size, size = size % 19 + 1) {
                size = std::min(size, answers.size() - first);
                std::vector<double> heights(size + 1, 123.0); // the last is not the batch's to write
                haptel_points points{};
                for (size_t i = 0; i < 3; ++i) points.p[i] = asked[i].data() + first;
                points.n[0] = asked[3].data() + first;
                haptel_samples samples{};
                samples.height_m = heights.data();
                one->batch_entry(texture.name + "*")(&points, size, arguments.block.data(), &samples);
                for (size_t i = 0; i < size; ++i) agree = agree && same(heights[i], answers[first + i]);
                agree = agree && heights[size] == 123.0;
            }
        }
        for (auto& coordinate : asked) coordinate.clear();
        answers.clear();
        return agree;
    }

    std::vector<std::shared_ptr<const jit::Code>> code; // draft, quick, full

private:
    const ir::Module& module;
    ir::Interpreter<double> interpreter;
    std::vector<double> asked[4], answers; // since batches_agree
};

} // namespace haptel::test
