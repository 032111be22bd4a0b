#include "bench/batch_bench.h"

#include "jit/check/check_points.h"
#include "lang/abi/abi.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <thread>

namespace haptel::bench {
namespace {

constexpr size_t reals = sizeof(haptel_point) / sizeof(double);
constexpr size_t chunk = 4096; // points that a thread takes at once: some 20 us; their samples stay near the processor

// What a thread writes: the samples of a chunk, over and over, as who draws or sums them does. A million samples
// written to memory would measure the memory.
struct Samples {
    double numbers[4][chunk];
    uint32_t faults[chunk];
};

// Points as arrays of which a part can be taken.
class Points {
public:
    Points(size_t count, const jit::CheckBox& box) : inputs(reals, std::vector<double>(count))
    {
        const jit::CheckPoints places(box, 1);
        for (size_t i = 0; i < count; ++i) {
            const haptel_point point = places.random(i);
            for (size_t real = 0; real < reals; ++real)
                std::memcpy(&inputs[real][i], reinterpret_cast<const char*>(&point) + real * sizeof(double),
                            sizeof(double));
        }
    }
    size_t size() const { return inputs[0].size(); }
    void evaluate(haptel_batch_entry* entry, const void* block, bool with_gradient, size_t first, Samples& made) const
    {
        const double* arrays[reals];
        for (size_t real = 0; real < reals; ++real) arrays[real] = inputs[real].data() + first;
        haptel_points points;
        static_assert(sizeof points == sizeof arrays);
        std::memcpy(&points, arrays, sizeof points);
        haptel_samples samples{};
        samples.height_m = made.numbers[0];
        samples.faults = made.faults;
        for (size_t axis = 0; with_gradient && axis < 3; ++axis) samples.gradient[axis] = made.numbers[1 + axis];
        entry(&points, std::min(chunk, size() - first), block, &samples);
    }

private:
    std::vector<std::vector<double>> inputs;
};

double nanoseconds_per_point(const BatchTexture& texture, bool with_gradient, unsigned threads, const Points& points)
{
    const haptel_texture& code = *texture.binding.texture;
    haptel_batch_entry* const entry = with_gradient ? code.height_gradient_batch : code.height_batch;
    std::atomic<size_t> next{0};
    const auto work = [&] {
        const auto samples = std::make_unique<Samples>();
        for (size_t first = next.fetch_add(chunk); first < points.size(); first = next.fetch_add(chunk))
            points.evaluate(entry, texture.binding.block, with_gradient, first, *samples);
    };
    const double whole_ms = milliseconds([&] {
        std::vector<std::jthread> others;
        for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
        work();
    });
    return whole_ms * 1e6 / static_cast<double>(points.size());
}

struct Measured {
    std::vector<double> with_gradient_ns, height_only_ns;
};

} // namespace

std::vector<BatchRow> bench_batch(const std::vector<BatchTexture>& textures, const BatchOptions& options,
                                  const std::function<void(double)>& progress)
{
    jit::CheckBox box;
    std::fill(box.minimum_m, box.minimum_m + 3, -options.box_m / 2);
    std::fill(box.maximum_m, box.maximum_m + 3, options.box_m / 2);
    const Points points(options.points, box);
    std::vector<Measured> measured(textures.size() * options.threads.size());
    for (unsigned round = 0; round < options.rounds; ++round) {
        size_t next = 0;
        for (const BatchTexture& texture : textures) {
            progress((round + static_cast<double>(next) / static_cast<double>(measured.size())) / options.rounds);
            for (const unsigned threads : options.threads) {
                Measured& times = measured[next++];
                times.height_only_ns.push_back(nanoseconds_per_point(texture, false, threads, points));
                times.with_gradient_ns.push_back(nanoseconds_per_point(texture, true, threads, points));
            }
        }
    }
    progress(1);
    std::vector<BatchRow> rows;
    for (const BatchTexture& texture : textures)
        for (const unsigned threads : options.threads) {
            const Measured& times = measured[rows.size()];
            rows.push_back({texture.name, jit::engine_info().batch_lanes, threads, summary(times.with_gradient_ns),
                            summary(times.height_only_ns)});
        }
    return rows;
}

std::vector<BatchSummary> summary(const std::vector<BatchRow>& rows)
{
    std::map<std::string, double> first_ns; // by texture
    std::map<unsigned, std::pair<BatchSummary, double>> sums;
    for (const BatchRow& row : rows) {
        const double first = first_ns.emplace(row.texture, row.with_gradient_ns.median).first->second;
        auto& [sum, count] = sums[row.threads];
        sum.gradient_over_height += std::log(row.gradient_over_height());
        sum.over_one_thread += std::log(first / row.with_gradient_ns.median);
        ++count;
    }
    std::vector<BatchSummary> summaries;
    for (const auto& [threads, sum] : sums)
        summaries.push_back({threads, std::exp(sum.first.gradient_over_height / sum.second),
                             std::exp(sum.first.over_one_thread / sum.second)});
    return summaries;
}

} // namespace haptel::bench
