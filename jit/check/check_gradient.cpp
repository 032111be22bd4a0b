#include "jit/check/check_gradient.h"

#include "jit/check/check_code.h"
#include "jit/check/check_points.h"
#include "jit/check/entry_inputs.h"
#include "lang/math/quad.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace haptel::jit {

namespace {

using ir::Quad;

constexpr double tolerance = 1e-12, conditioning_factor = 8; // of the errors against the oracle
constexpr double step_of_box = 0x1p-40;

template <typename T>
struct Vector {
    T x[3] = {};
};

double length(const Vector<Quad>& a)
{
    return std::hypot(static_cast<double>(a.x[0]), static_cast<double>(a.x[1]), static_cast<double>(a.x[2]));
}

Vector<Quad> difference(const Vector<Quad>& a, const Vector<Quad>& b)
{
    return {{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}

// Of one point; absolute, in metres or metres per metre.
struct PointFigures {
    bool at_kink = false;
    double height = 0, gradient = 0; // sizes of the true ones
    double height_error = 0, gradient_error = 0, conditioning = 0, difference_error = 0;
};

// One thread's oracle.
class PointCheck {
public:
    PointCheck(const CompiledProgram& whole, const TextureBinding& checked, const CheckPoints& from)
        : binding(checked)
        , texture(whole.source_of(*whole.find(checked.texture->name)))
        , points(from)
        , truth(whole.module())
        , plain(whole.module())
    {
        set_block(inputs, texture, binding.block);
        set_block(plain_inputs, texture, binding.block);
        truth.watch_decisions(true);
        plain.watch_decisions(true);
    }

    PointFigures figures(uint64_t index);

private:
    const TextureBinding& binding;
    const ir::Texture& texture;
    const CheckPoints& points;
    ir::Interpreter<Quad> truth;
    ir::Interpreter<double> plain;
    ir::EntryInputs<Quad> inputs;
    ir::EntryInputs<double> plain_inputs;

    Quad height() { return truth.run(texture.body, {}, &inputs)[0].real; }
    Vector<Quad> gradient()
    {
        const auto results = truth.run(texture.height_gradient, {}, &inputs);
        return {{results[1].real, results[2].real, results[3].real}};
    }
    void move(const haptel_point& point, size_t axis, const Quad& step);
    void move_by_half_ulp(const haptel_point& point);
    Vector<Quad> gradient_by_difference(const haptel_point& point, uint64_t piece, bool& same_piece);
};

// p, and n and uv with it.
void PointCheck::move(const haptel_point& point, size_t axis, const Quad& step)
{
    const auto add = [&](ir::Input input, const Quad& change) { inputs.input[static_cast<size_t>(input)] += change; };
    const auto after = [](ir::Input first, size_t i) { return static_cast<ir::Input>(static_cast<size_t>(first) + i); };
    add(after(ir::Input::p_x, axis), step);
    for (size_t i = 0; i < 3; ++i) add(after(ir::Input::n_x, i), Quad(point.n_dp[i][axis]) * step);
    for (size_t i = 0; i < 2; ++i) add(after(ir::Input::uv_x, i), Quad(point.uv_dp[i][axis]) * step);
}

void PointCheck::move_by_half_ulp(const haptel_point& point)
{
    set_point(inputs, point);
    for (size_t i = 0; i <= static_cast<size_t>(ir::Input::uv_y); ++i) {
        const double value = static_cast<double>(inputs.input[i]);
        const double ulp = std::nextafter(std::fabs(value), HUGE_VAL) - std::fabs(value);
        inputs.input[i] += Quad(std::copysign(ulp, value)) / 2;
    }
}

Vector<Quad> PointCheck::gradient_by_difference(const haptel_point& point, uint64_t piece, bool& same_piece)
{
    Vector<Quad> result;
    for (size_t axis = 0; axis < 3; ++axis) {
        Quad central[2];
        for (int halved = 0; halved < 2; ++halved) {
            const Quad step = Quad(points.side_m()) * (halved ? step_of_box / 2 : step_of_box);
            Quad ends[2];
            for (int end = 0; end < 2; ++end) {
                set_point(inputs, point);
                move(point, axis, end ? step : Quad(-step));
                ends[end] = height();
                same_piece = same_piece && truth.decisions() == piece;
            }
            central[halved] = (ends[1] - ends[0]) / (2 * step);
        }
        result.x[axis] = (4 * central[1] - central[0]) / 3;
    }
    return result;
}

PointFigures PointCheck::figures(uint64_t index)
{
    const haptel_point point = points.random(index);
    haptel_sample sample{};
    binding.texture->height_gradient(&point, binding.block, &sample);

    set_point(inputs, point);
    const Quad true_height = height();
    const uint64_t piece = truth.decisions();
    const Vector<Quad> true_gradient = gradient();
    move_by_half_ulp(point);
    height();
    bool same_piece = truth.decisions() == piece;
    const Vector<Quad> near_gradient = gradient();
    set_point(plain_inputs, point);
    plain.run(texture.body, {}, &plain_inputs);
    same_piece = same_piece && plain.decisions() == piece;
    const Vector<Quad> by_difference = gradient_by_difference(point, piece, same_piece);

    PointFigures figures;
    figures.at_kink = !same_piece;
    if (figures.at_kink) return figures;
    const Vector<Quad> found = {{Quad(sample.gradient[0]), Quad(sample.gradient[1]), Quad(sample.gradient[2])}};
    figures.height = std::fabs(static_cast<double>(true_height));
    figures.gradient = length(true_gradient);
    figures.height_error = std::fabs(static_cast<double>(Quad(sample.height_m) - true_height));
    figures.gradient_error = length(difference(found, true_gradient));
    figures.conditioning = length(difference(near_gradient, true_gradient));
    figures.difference_error = length(difference(found, by_difference));
    return figures;
}

std::vector<PointFigures> all_figures(const CompiledProgram& program, const TextureBinding& binding,
                                      const CheckPoints& points, uint32_t count)
{
    std::vector<PointFigures> figures(count);
    std::atomic<uint32_t> next{0};
    const auto work = [&] {
        PointCheck check(program, binding, points);
        for (uint32_t i = next++; i < count; i = next++) figures[i] = check.figures(i);
    };
    std::vector<std::thread> threads;
    const uint32_t wanted = std::min({std::thread::hardware_concurrency(), 16u, count / 16});
    for (uint32_t i = 1; i < wanted; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    return figures;
}

// Relative to the largest true value; where all are 0, as it is.
double relative(double error, double largest)
{
    return largest > 0 ? error / largest : error;
}

} // namespace

GradientCheck check_gradient(const std::shared_ptr<const CompiledProgram>& program, const TextureBinding& binding,
                             const CheckBox& box, uint32_t count, uint64_t seed)
{
    const CheckPoints points(box, seed);
    GradientCheck check;
    check.points = count;
    PointFigures largest;
    uint32_t worst = 0, index = 0;
    for (const PointFigures& point : all_figures(*program, binding, points, count)) {
        check.points_at_kinks += point.at_kink;
        // A figure that is not a number counts as the largest there is.
        const auto raise = [](double& so_far, double value) {
            if (!(value <= so_far)) so_far = std::isnan(value) ? HUGE_VAL : value;
        };
        if (!(std::max(point.gradient_error, point.difference_error) <=
              std::max(largest.gradient_error, largest.difference_error)))
            worst = index;
        raise(largest.height, point.height);
        raise(largest.gradient, point.gradient);
        raise(largest.height_error, point.height_error);
        raise(largest.gradient_error, point.gradient_error);
        raise(largest.conditioning, point.conditioning);
        raise(largest.difference_error, point.difference_error);
        ++index;
    }
    const haptel_point worst_point = points.random(worst);
    std::copy(worst_point.p, worst_point.p + 3, check.worst_point_m);
    check.height_error_oracle = relative(largest.height_error, largest.height);
    check.gradient_error_oracle = relative(largest.gradient_error, largest.gradient);
    check.conditioning = relative(largest.conditioning, largest.gradient);
    check.gradient_error_difference = relative(largest.difference_error, largest.gradient);
    const double allowed = tolerance + conditioning_factor * *check.conditioning;
    expect_at_most(check, "height differs from the 113-bit oracle", *check.height_error_oracle, allowed);
    expect_at_most(check, "gradient differs from the 113-bit oracle", *check.gradient_error_oracle, allowed);
    expect_at_most(check, "gradient differs from central differences of the 113-bit height",
                   *check.gradient_error_difference, allowed);
    expect_at_most(check, "points lie at kinks and cannot be checked",
                   count ? check.points_at_kinks / static_cast<double>(count) : 0, kinks_share_max);
    check_code(check, binding, points);
    return check;
}

} // namespace haptel::jit
