// Operations of images over intervals: an image is the index of a texture parameter, and the box knows the image.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/math/spline.h"

namespace haptel::ir {
namespace {

const SplineImage* known_image(const BoundsBox* box, const Interval& image)
{
    if (!box || !image.is_point() || image.minimum < 0) return nullptr;
    const auto index = static_cast<size_t>(image.minimum);
    return index < box->images.size() ? box->images[index] : nullptr;
}

} // namespace

Interval IntervalEvaluator::of_image(Op op, std::span<const Interval> operands) const
{
    const SplineImage* image = known_image(box, operands[0]);
    if (!image || (op == Op::spline && !operands[3].is_point())) return evaluate(op, operands);
    const haptel_image& view = image->view();
    if (op == Op::image_width) return {double(view.width), double(view.width)};
    if (op == Op::image_height) return {double(view.height), double(view.height)};
    return image->bounds(operands[1], operands[2], static_cast<uint32_t>(operands[3].minimum));
}

Partials IntervalEvaluator::spline_partials(std::span<const Interval> operands) const
{
    const auto derivative = [&](uint32_t by_x, uint32_t by_y) {
        const double step = spline_order(by_x, by_y), order = operands[3].minimum + step;
        const Interval deeper[] = {operands[0], operands[1], operands[2], {order, operands[3].maximum + step}};
        const Interval found = of_image(Op::spline, deeper);
        return found.is_empty() ? Interval{0, 0} : Interval{found.minimum, found.maximum};
    };
    Partials partials{};
    partials.first[1] = derivative(1, 0);
    partials.first[2] = derivative(0, 1);
    partials.second[1][1] = derivative(2, 0);
    partials.second[1][2] = partials.second[2][1] = derivative(1, 1);
    partials.second[2][2] = derivative(0, 2);
    const bool are_finite = operands[1].is_finite() && operands[2].is_finite();
    for (size_t i : {1, 2}) partials.may_fault[i] = !are_finite || std::isinf(partials.first[i].maximum);
    return partials;
}

} // namespace haptel::ir
