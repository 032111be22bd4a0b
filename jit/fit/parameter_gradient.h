// The heights of a texture at many points, and how fast each moves with the texture's parameters: exact, by the same
// differentiation and the same code as a gradient in space.
#pragma once

#include "jit/texture/texture.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptel::jit {

// Points as the arrays that a batch entry takes: of all inputs, for one texture or another.
class PointArrays {
public:
    explicit PointArrays(std::span<const haptel_point> points);
    const haptel_points& arrays() const { return pointers; }
    std::size_t size() const { return count; }

private:
    std::size_t count;
    std::vector<std::vector<double>> inputs; // in the order of haptel_point
    haptel_points pointers{};
};

class ParameterGradient {
public:
    // The texture of this name, of a program with batches; `parameters` are real ones, by their index.
    ParameterGradient(std::shared_ptr<const CompiledProgram> program, std::string_view texture,
                      std::vector<uint32_t> parameters);
    // Why there is none; empty: there is one.
    const std::string& error() const { return failure; }

    const haptel_texture& texture() const { return *described; }
    const std::vector<uint32_t>& parameters() const { return by; }

    // One height per point, as the texture's own code has it. `block` is one of the texture's. A height that is not
    // finite is 0, as ever.
    void heights(const PointArrays& points, const void* block, std::span<double> heights_m) const;
    // Beside them dh/dparameter: a row per point, a column per parameter, column by column.
    void gradient(const PointArrays& points, const void* block, std::span<double> heights_m,
                  std::span<double> by_parameters) const;

private:
    std::shared_ptr<const CompiledProgram> program;
    const haptel_texture* described = nullptr;
    std::vector<uint32_t> by;
    std::shared_ptr<const Code> code;
    std::vector<haptel_batch_entry*> entries; // of three parameters each
    std::string failure;
};

} // namespace haptel::jit
