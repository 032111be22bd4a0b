// Many points: how long a sample takes in a batch, with and without the gradient, on one thread and on more.
#pragma once

#include "bench/timing.h"
#include "jit/texture/texture.h"

#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

// What is measured: a texture bound to its parameters, compiled with batches, and how it is called in the table.
struct BatchTexture {
    std::string name;
    std::shared_ptr<const jit::CompiledProgram> program;
    TextureBinding binding;
};

struct BatchOptions {
    size_t points = 1'000'000;
    unsigned rounds = 9;
    std::vector<unsigned> threads{1}; // each of these numbers is measured
    double box_m = 0.05;              // side of the cube of points round the origin
};

struct BatchRow {
    std::string texture;
    uint32_t lanes = 1;
    unsigned threads = 1;
    Times with_gradient_ns, height_only_ns; // per point

    double gradient_over_height() const { return with_gradient_ns.median / height_only_ns.median; }
};

// Interleaved: each round takes every texture with every number of threads once. `progress` is called now and then with
// what has been done of the whole, 0 .. 1.
std::vector<BatchRow> bench_batch(const std::vector<BatchTexture>& textures, const BatchOptions& options,
                                  const std::function<void(double)>& progress);

struct BatchSummary {
    unsigned threads = 1;
    double gradient_over_height = 0; // geometric mean over the textures
    double over_one_thread = 0;      // how many times as fast as the first number of threads, likewise
};
// One for each number of threads.
std::vector<BatchSummary> summary(const std::vector<BatchRow>& rows);

} // namespace haptel::bench
