#include "jit/check/precision_choice.h"

#include "jit/check/check_points.h"
#include "jit/check/oracle.h"
#include "jit/texture/texture.h"
#include "lang/abi/evaluate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

namespace haptel::jit {

namespace {

constexpr Precision all_precisions[] = {Precision::f64, Precision::mixed, Precision::f32};
constexpr size_t rounds = 25, points_timed = 2048;

struct Compiled {
    std::shared_ptr<const CompiledProgram> program;
    TextureBinding binding;
};

double size_of(const double (&vector)[3])
{
    return std::hypot(vector[0], vector[1], vector[2]);
}

// Errors of samples at the points where these are true. What is not a number counts as infinitely far off.
void set_errors(PrecisionFigures& figures, const std::vector<haptel_sample>& found,
                const std::vector<OracleSample>& truth)
{
    double height = 0, gradient = 0, height_error = 0, gradient_error = 0;
    const auto raise = [](double& so_far, double error) {
        if (!(error <= so_far)) so_far = std::isnan(error) ? HUGE_VAL : error;
    };
    for (size_t i = 0; i < truth.size(); ++i) {
        double off[3];
        for (size_t axis = 0; axis < 3; ++axis) off[axis] = found[i].gradient[axis] - truth[i].gradient[axis];
        raise(height_error, std::fabs(found[i].height_m - truth[i].height_m));
        raise(gradient_error, size_of(off));
        height = std::max(height, std::fabs(truth[i].height_m));
        gradient = std::max(gradient, size_of(truth[i].gradient));
    }
    figures.height_error = height > 0 ? height_error / height : height_error;
    figures.gradient_error = gradient > 0 ? gradient_error / gradient : gradient_error;
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

// Coordinates in arrays, so that what is timed is the code and not the sorting.
class Batch {
public:
    explicit Batch(const std::vector<haptel_point>& points)
        : inputs(reals, std::vector<double>(points.size()))
        , outputs(6, std::vector<double>(points.size()))
        , faults(points.size())
    {
        const double* arrays[reals];
        for (size_t real = 0; real < reals; ++real) {
            for (size_t i = 0; i < points.size(); ++i)
                std::memcpy(&inputs[real][i], reinterpret_cast<const char*>(&points[i]) + real * sizeof(double),
                            sizeof(double));
            arrays[real] = inputs[real].data();
        }
        static_assert(sizeof from == sizeof arrays);
        std::memcpy(&from, arrays, sizeof from);
        to = {outputs[0].data(),
              {outputs[1].data(), outputs[2].data(), outputs[3].data()},
              outputs[4].data(),
              outputs[5].data(),
              faults.data()};
    }
    void evaluate(const TextureBinding& binding)
    {
        binding.texture->height_gradient_batch(&from, faults.size(), binding.block, &to);
    }

private:
    static constexpr size_t reals = sizeof(haptel_point) / sizeof(double);
    std::vector<std::vector<double>> inputs, outputs;
    std::vector<uint32_t> faults;
    haptel_points from{};
    haptel_samples to{};
};

// In turns, so that what the machine does besides meets all alike.
void set_times(std::vector<PrecisionFigures>& figures, const std::vector<Compiled>& compiled, const CheckPoints& points)
{
    std::vector<haptel_point> some;
    for (uint64_t i = 0; i < points_timed; ++i) some.push_back(points.random(i));
    Batch batch(some);
    std::vector<std::vector<double>> one(figures.size()), many(figures.size());
    for (size_t round = 0; round < rounds; ++round)
        for (size_t i = 0; i < figures.size(); ++i) {
            const TextureBinding& binding = compiled[i].binding;
            haptel_sample sample{};
            one[i].push_back(nanoseconds_per_point(points_timed / 8, [&] {
                for (size_t k = 0; k < points_timed / 8; ++k) {
                    haptel_point point = some[k];
                    point.p[0] += sample.height_m * 1e-300; // waits for the sample before it, as in a servo
                    binding.texture->height_gradient(&point, binding.block, &sample);
                }
            }));
            many[i].push_back(nanoseconds_per_point(points_timed, [&] { batch.evaluate(binding); }));
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
    std::vector<Compiled> compiled;
    for (const Precision precision : all_precisions) {
        TextureOptions options;
        options.entries = Entries::both_and_batches;
        options.only_texture = texture;
        options.effort = Effort::full;
        options.precision = precision;
        const CompiledTextures made = compile_texture_file(file, options);
        if (!made.program) return {{}, made.rendered()};
        TextureResult bound = make_binding(made.program, texture, request, Unbounded::allowed);
        if (!bound.binding) return {{}, bound.diagnostics};
        compiled.push_back({made.program, *std::move(bound.binding)});
    }
    CheckBox box;
    std::copy(request.box_minimum_m, request.box_minimum_m + 3, box.minimum_m);
    std::copy(request.box_maximum_m, request.box_maximum_m + 3, box.maximum_m);
    const CheckPoints points(box, 1);
    Oracle oracle(compiled[0].program, compiled[0].binding);
    std::vector<OracleSample> truth;
    for (uint64_t i = 0; i < count; ++i) truth.push_back(oracle.sample(points.random(i)));

    PrecisionChoice choice;
    for (size_t i = 0; i < compiled.size(); ++i) {
        PrecisionFigures& figures = choice.figures.emplace_back();
        figures.precision = all_precisions[i];
        std::vector<haptel_point> asked;
        for (uint64_t k = 0; k < count; ++k) asked.push_back(points.random(k));
        std::vector<haptel_sample> found(asked.size());
        evaluate(compiled[i].binding, asked, found);
        set_errors(figures, found, truth);
        // One point and many may sum in another order: the worse of the two counts.
        const PrecisionFigures of_many = figures;
        for (size_t k = 0; k < asked.size(); ++k)
            compiled[i].binding.texture->height_gradient(&asked[k], compiled[i].binding.block, &found[k]);
        set_errors(figures, found, truth);
        figures.height_error = std::max(figures.height_error, of_many.height_error);
        figures.gradient_error = std::max(figures.gradient_error, of_many.gradient_error);
    }
    set_times(choice.figures, compiled, points);
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
