#include "jit/check/check_gradient.h"

#include "jit/check/all_points.h"
#include "jit/check/amplified_rounding.h"
#include "jit/check/check_code.h"
#include "jit/check/check_points.h"
#include "jit/check/entry_inputs.h"
#include "lang/math/quad.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptel::jit {

namespace {

using ir::Quad;

constexpr double tolerance = 1e-12, conditioning_factor = 8; // of the errors against the oracle
constexpr double step_of_box = 0x1p-40;

using Vector = std::array<Quad, 3>;

double distance(const Vector& a, const Vector& b)
{
    const Vector off = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return std::hypot(static_cast<double>(off[0]), static_cast<double>(off[1]), static_cast<double>(off[2]));
}

// Of one point; absolute, in metres or metres per metre.
struct PointFigures {
    bool at_kink = false;
    double height = 0, gradient = 0; // sizes of the true ones
    double height_error = 0, gradient_error = 0, conditioning = 0, difference_error = 0;
    haptel_sample found{}; // what was compared with what
    double true_height_m = 0, true_gradient[3] = {}, by_difference[3] = {};
};

void copy(const Vector& from, double (&to)[3])
{
    for (size_t i = 0; i < 3; ++i) to[i] = static_cast<double>(from[i]);
}

// One thread's oracle.
class PointCheck {
public:
    PointCheck(const CompiledProgram& program, const TextureBinding& checked, const CheckPoints& from)
        : binding(checked), points(from), truth(program, checked), plain(program, checked)
    {
        truth.interpreter.watch_decisions(true);
        plain.interpreter.watch_decisions(true);
    }

    PointFigures figures(uint64_t index)
    {
        const haptel_point point = points.random(index);
        haptel_sample sample{};
        binding.texture->height_gradient(&point, binding.block, &sample);

        set_point(truth.inputs, point);
        const Quad true_height = height();
        const uint64_t piece = truth.interpreter.decisions();
        const Vector true_gradient = gradient();
        move_by_half_ulp(point);
        height();
        bool same_piece = truth.interpreter.decisions() == piece;
        const Vector near_gradient = gradient();
        set_point(plain.inputs, point);
        plain.run(plain.texture.body);
        same_piece = same_piece && plain.interpreter.decisions() == piece;
        const Vector by_difference = gradient_by_difference(point, piece, same_piece);

        PointFigures figures;
        figures.at_kink = !same_piece;
        if (figures.at_kink) return figures;
        const Vector found = {Quad(sample.gradient[0]), Quad(sample.gradient[1]), Quad(sample.gradient[2])};
        figures.height = std::fabs(static_cast<double>(true_height));
        figures.gradient = distance(true_gradient, {});
        figures.height_error = std::fabs(static_cast<double>(Quad(sample.height_m) - true_height));
        figures.gradient_error = distance(found, true_gradient);
        figures.conditioning = distance(near_gradient, true_gradient);
        figures.difference_error = distance(found, by_difference);
        figures.found = sample;
        figures.true_height_m = static_cast<double>(true_height);
        copy(true_gradient, figures.true_gradient);
        copy(by_difference, figures.by_difference);
        return figures;
    }

private:
    Quad height() { return truth.run(truth.texture.body)[0].real; }
    Vector gradient()
    {
        const auto results = truth.run(truth.texture.height_gradient);
        return {results[1].real, results[2].real, results[3].real};
    }
    // p, and n and uv with it.
    void move(const haptel_point& point, size_t axis, const Quad& step)
    {
        const auto add = [&](ir::Input first, size_t i, const Quad& change) {
            truth.inputs.input[static_cast<size_t>(first) + i] += change;
        };
        add(ir::Input::p_x, axis, step);
        for (size_t i = 0; i < 3; ++i) add(ir::Input::n_x, i, Quad(point.n_dp[i][axis]) * step);
        for (size_t i = 0; i < 2; ++i) add(ir::Input::uv_x, i, Quad(point.uv_dp[i][axis]) * step);
    }

    void move_by_half_ulp(const haptel_point& point)
    {
        set_point(truth.inputs, point);
        for (size_t i = 0; i <= static_cast<size_t>(ir::Input::uv_y); ++i) {
            const double value = static_cast<double>(truth.inputs.input[i]);
            const double ulp = std::nextafter(std::fabs(value), HUGE_VAL) - std::fabs(value);
            truth.inputs.input[i] += Quad(std::copysign(ulp, value)) / 2;
        }
    }

    Vector gradient_by_difference(const haptel_point& point, uint64_t piece, bool& same_piece)
    {
        Vector result;
        for (size_t axis = 0; axis < 3; ++axis) {
            Quad central[2];
            for (int halved = 0; halved < 2; ++halved) {
                const Quad step = Quad(points.side_m()) * (halved ? step_of_box / 2 : step_of_box);
                Quad ends[2];
                for (int end = 0; end < 2; ++end) {
                    set_point(truth.inputs, point);
                    move(point, axis, end ? step : Quad(-step));
                    ends[end] = height();
                    same_piece = same_piece && truth.interpreter.decisions() == piece;
                }
                central[halved] = (ends[1] - ends[0]) / (2 * step);
            }
            result[axis] = (4 * central[1] - central[0]) / 3;
        }
        return result;
    }

    const TextureBinding& binding;
    const CheckPoints& points;
    InterpretedTexture<Quad> truth;
    InterpretedTexture<double> plain;
};

std::vector<PointFigures> all_figures(const CompiledProgram& program, const TextureBinding& binding,
                                      const CheckPoints& points, uint32_t count)
{
    std::vector<PointFigures> figures(count);
    for_all_points(count, [&] {
        return [&, check = std::make_shared<PointCheck>(program, binding, points)](uint32_t index) {
            figures[index] = check->figures(index);
        };
    });
    return figures;
}

// The largest of a figure, and the point where that is.
struct Largest {
    double size = 0;
    uint32_t index = 0;
    void meet(double other, uint32_t at)
    {
        const double larger = greater(size, other);
        if (larger > size) size = larger, index = at;
    }
};

} // namespace

CheckBox box_of(const TextureRequest& request)
{
    CheckBox box;
    std::ranges::copy(request.box_minimum_m, box.minimum_m);
    std::ranges::copy(request.box_maximum_m, box.maximum_m);
    return box;
}

GradientCheck check_gradient(const std::shared_ptr<const CompiledProgram>& program, const TextureBinding& binding,
                             const CheckBox& box, uint32_t count, uint64_t seed)
{
    const CheckPoints points(box, seed);
    const std::vector<PointFigures> figures = all_figures(*program, binding, points, count);
    const auto largest = [&](double PointFigures::* figure) {
        Largest found;
        for (uint32_t i = 0; i < count; ++i) found.meet(figures[i].*figure, i);
        return found;
    };
    const double height = largest(&PointFigures::height).size, gradient = largest(&PointFigures::gradient).size;
    const Largest height_error = largest(&PointFigures::height_error);
    const Largest gradient_error = largest(&PointFigures::gradient_error);
    const Largest difference_error = largest(&PointFigures::difference_error);

    GradientCheck check;
    check.points = count;
    check.points_at_kinks = static_cast<uint32_t>(
        std::count_if(figures.begin(), figures.end(), [](const PointFigures& point) { return point.at_kink; }));
    check.height_error_oracle = relative(height_error.size, height);
    check.gradient_error_oracle = relative(gradient_error.size, gradient);
    check.conditioning = relative(largest(&PointFigures::conditioning).size, gradient);
    check.gradient_error_difference = relative(difference_error.size, gradient);

    const double allowed = tolerance + conditioning_factor * *check.conditioning;
    const auto all_within = [&](double of_height, double of_gradient) {
        return *check.height_error_oracle <= of_height && *check.gradient_error_oracle <= of_gradient &&
               *check.gradient_error_difference <= of_gradient;
    };
    if (!all_within(allowed, allowed)) {
        const auto rounding = amplified_rounding(*program, binding, points, count, height, gradient);
        if (rounding && all_within(allowed + conditioning_factor * rounding->height,
                                   allowed + conditioning_factor * rounding->gradient))
            check.amplified = rounding;
    }
    if (!check.amplified) {
        const auto at = [&](const Largest& error, const std::string& found, const std::string& expected) {
            return "worst at --at " + listed(points.random(error.index).p) + ": found " + found + ", expected " +
                   expected;
        };
        const auto gradient_at = [&](const Largest& error, double(PointFigures::* expected)[3]) {
            return at(error, listed(figures[error.index].found.gradient), listed(figures[error.index].*expected));
        };
        expect_at_most(check, "height differs from the 113-bit oracle", *check.height_error_oracle, allowed, [&] {
            const PointFigures& point = figures[height_error.index];
            return at(height_error, shortest(point.found.height_m), shortest(point.true_height_m));
        });
        expect_at_most(check, "gradient differs from the 113-bit oracle", *check.gradient_error_oracle, allowed,
                       [&] { return gradient_at(gradient_error, &PointFigures::true_gradient); });
        expect_at_most(check, "gradient differs from central differences of the 113-bit height",
                       *check.gradient_error_difference, allowed,
                       [&] { return gradient_at(difference_error, &PointFigures::by_difference); });
    }
    expect_at_most(check, "points lie at kinks and cannot be checked",
                   count ? check.points_at_kinks / static_cast<double>(count) : 0, kinks_share_max, [&] {
                       const auto kink = std::find_if(figures.begin(), figures.end(),
                                                      [](const PointFigures& point) { return point.at_kink; });
                       return "one at --at " + listed(points.random(static_cast<uint64_t>(kink - figures.begin())).p);
                   });
    check_code(check, binding, points);
    return check;
}

} // namespace haptel::jit
