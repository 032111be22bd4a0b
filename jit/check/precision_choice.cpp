#include "jit/check/precision_choice.h"

#include "jit/check/check_code.h"
#include "jit/check/oracle.h"
#include "jit/texture/texture.h"
#include "lang/abi/evaluate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace haptel::jit {

namespace {

constexpr size_t rounds = 25, points_timed = 2048;

double size_of(const double (&vector)[3])
{
    return std::hypot(vector[0], vector[1], vector[2]);
}

// Raises the errors to those of samples at the points where these are true.
void raise_errors(PrecisionFigures& figures, const std::vector<haptel_sample>& found,
                  const std::vector<OracleSample>& truth)
{
    double height = 0, gradient = 0, height_error = 0, gradient_error = 0;
    for (size_t i = 0; i < truth.size(); ++i) {
        double off[3];
        for (size_t axis = 0; axis < 3; ++axis) off[axis] = found[i].gradient[axis] - truth[i].gradient[axis];
        height_error = greater(height_error, std::fabs(found[i].height_m - truth[i].height_m));
        gradient_error = greater(gradient_error, size_of(off));
        height = std::max(height, std::fabs(truth[i].height_m));
        gradient = std::max(gradient, size_of(truth[i].gradient));
    }
    figures.height_error = std::max(figures.height_error, relative(height_error, height));
    figures.gradient_error = std::max(figures.gradient_error, relative(gradient_error, gradient));
}

template <typename Work>
double nanoseconds_per_point(size_t points, const Work& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    return taken.count() / static_cast<double>(points);
}

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

// In turns, so that what the machine does besides meets all alike.
void set_times(std::vector<PrecisionFigures>& figures, const std::vector<TextureBinding>& bindings,
               const CheckPoints& points)
{
    std::vector<haptel_point> some;
    for (uint64_t i = 0; i < points_timed; ++i) some.push_back(points.random(i));
    // Filled beforehand, so that what is timed is the code and not the sorting.
    const auto arrays = std::make_unique<SampleArrays<points_timed>>();
    arrays->set(some, UINT32_MAX);
    std::vector<std::vector<double>> one(figures.size()), many(figures.size());
    for (size_t round = 0; round < rounds; ++round)
        for (size_t i = 0; i < figures.size(); ++i) {
            const haptel_texture& texture = *bindings[i].texture;
            haptel_sample sample = blank_sample;
            one[i].push_back(nanoseconds_per_point(points_timed / 8, [&] {
                for (size_t k = 0; k < points_timed / 8; ++k) {
                    haptel_point point = some[k];
                    point.p[0] += sample.height_m * 1e-300; // waits for the sample before it, as in a servo
                    texture.height_gradient(&point, bindings[i].block, &sample);
                }
            }));
            many[i].push_back(nanoseconds_per_point(points_timed, [&] {
                arrays->run(texture.height_gradient_batch, points_timed, bindings[i].block, texture.writes);
            }));
        }
    for (size_t i = 0; i < figures.size(); ++i) {
        figures[i].one_point_ns = median(one[i]);
        figures[i].many_points_ns = median(many[i]);
    }
}

} // namespace

PrecisionChoice measure_precisions(const std::string& file, const std::string& texture, const TextureRequest& request,
                                   uint32_t count)
{
    const CheckPoints points(box_of(request), 1);
    std::vector<haptel_point> asked;
    for (uint64_t i = 0; i < count; ++i) asked.push_back(points.random(i));

    PrecisionChoice choice;
    std::vector<TextureBinding> bindings;
    std::vector<OracleSample> truth;
    for (const Precision precision : {Precision::f64, Precision::mixed, Precision::f32}) {
        const CompiledTextures made = compile_texture_file(file, {.entries = Entries::both_and_batches,
                                                                  .only_texture = texture,
                                                                  .effort = Effort::full,
                                                                  .precision = precision});
        if (!made.program) return {{}, made.rendered()};
        TextureResult bound = make_binding(made.program, texture, request, For::figures);
        if (!bound.binding) return {{}, bound.diagnostics};
        const TextureBinding& binding = bindings.emplace_back(*std::move(bound.binding));
        if (truth.empty()) {
            Oracle oracle(made.program, binding);
            for (const haptel_point& point : asked) truth.push_back(oracle.sample(point));
        }
        PrecisionFigures& figures = choice.figures.emplace_back();
        figures.precision = precision;
        // One point and many may sum in another order: the worse of the two counts.
        std::vector<haptel_sample> found(asked.size());
        evaluate(binding, asked, found);
        raise_errors(figures, found, truth);
        for (size_t k = 0; k < asked.size(); ++k) binding.texture->height_gradient(&asked[k], binding.block, &found[k]);
        raise_errors(figures, found, truth);
    }
    set_times(choice.figures, bindings, points);
    return choice;
}

const PrecisionFigures* fastest(const PrecisionChoice& choice, double PrecisionFigures::* time,
                                double gradient_error_max)
{
    const PrecisionFigures* best = nullptr;
    for (const PrecisionFigures& figures : choice.figures)
        if (figures.gradient_error <= gradient_error_max && (!best || figures.*time < best->*time)) best = &figures;
    return best;
}

} // namespace haptel::jit
