#include "lang/ir/bounds/spline_image.h"

#include "lang/math/spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace haptel::ir {
namespace {

// Many lines of numbers side by side, solved together: number i of line k is at first[i * step + k].
struct Lines {
    double* first;
    size_t count, step, lines;

    double* at(size_t i) const { return first + i * step; }
};

// Solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = f[i] in place for `first` <= i < `end`, where the factor is `at_ends` in
// place of 4 in the first and in the last equation, and numbers before and after these are known.
void solve(const Lines& all, size_t first, size_t end, double at_ends)
{
    std::vector<double> pivots(all.count, 1.0);
    for (size_t i = first; i < end; ++i) {
        pivots[i] = i == first || i + 1 == end ? at_ends : 4.0;
        if (i > first) pivots[i] -= 1 / pivots[i - 1];
        double* line = all.at(i);
        const double* last = i > 0 ? all.at(i - 1) : nullptr;
        for (size_t k = 0; k < all.lines; ++k) line[k] = 6 * line[k] - (last ? last[k] / pivots[i - 1] : 0);
    }
    for (size_t i = end; i-- > first;) {
        double* line = all.at(i);
        const double* next = i + 1 < all.count ? all.at(i + 1) : nullptr;
        for (size_t k = 0; k < all.lines; ++k) line[k] = (line[k] - (next ? next[k] : 0)) / pivots[i];
    }
}

// All of them, where c[-1] = c[0] and c[n] = c[n-1].
void solve_mirrored(const Lines& all)
{
    if (all.count > 1) solve(all, 0, all.count, 5);
}

// The first and the last number of each line stay as they are, and are what the line is made of outside.
void solve_clamped(const Lines& all)
{
    solve(all, 1, all.count - 1, 4);
}

// The same where c[-1] = c[n-1] and c[n] = c[0]: that of the mirrored line, and a correction that makes up for the
// corners (Sherman and Morrison).
void solve_tiled(const Lines& all)
{
    const size_t n = all.count;
    if (n == 1) return;
    // M = mirrored + u v^T, u = (1, 0 ... 0, -1), v = (-1, 0 ... 0, 1): the corners, and 4 instead of 5 on the diagonal
    std::vector<double> corner(n, 0.0), share(all.lines);
    corner[0] = 1;
    corner[n - 1] = -1;
    for (double& c : corner) c /= 6;
    solve_mirrored({corner.data(), n, 1, 1});
    solve_mirrored(all);
    for (size_t k = 0; k < all.lines; ++k)
        share[k] = (all.at(n - 1)[k] - all.first[k]) / (1 + corner[n - 1] - corner[0]);
    for (size_t i = 0; i < n; ++i)
        for (size_t k = 0; k < all.lines; ++k) all.at(i)[k] -= share[k] * corner[i];
}

// Along the rows, then along the columns.
template <typename Solve>
void solve_both(std::vector<double>& all, size_t columns, size_t rows, const Solve& solve)
{
    for (size_t row = 0; row < rows; ++row) solve(Lines{all.data() + row * columns, columns, 1, 1});
    solve(Lines{all.data(), rows, columns, columns});
}

// With the texels at the edges once more around them.
std::vector<double> framed(std::span<const double> texels, size_t columns, size_t rows)
{
    std::vector<double> all;
    all.reserve((columns + 2) * (rows + 2));
    for (size_t j = 0; j < rows + 2; ++j) {
        const auto row = texels.subspan(std::clamp<size_t>(j, 1, rows) * columns - columns, columns);
        all.push_back(row.front());
        all.insert(all.end(), row.begin(), row.end());
        all.push_back(row.back());
    }
    return all;
}

int64_t halved(int64_t count)
{
    return (count + 1) / 2;
}

// Half as many numbers a row, turned: columns become rows. Each new one is the mean of what lies under it, so that the
// mean of all stays.
std::vector<double> halved(const std::vector<double>& all, int64_t rows, int64_t columns)
{
    const int64_t left = halved(columns);
    const double width = static_cast<double>(columns) / static_cast<double>(left); // of a new one in old ones
    std::vector<double> result(static_cast<size_t>(left * rows));
    for (int64_t i = 0; i < left; ++i) {
        const double from = static_cast<double>(i) * width, to = static_cast<double>(i + 1) * width;
        for (int64_t k = static_cast<int64_t>(from); k < columns && static_cast<double>(k) < to; ++k) {
            const double share =
                (std::min(to, static_cast<double>(k + 1)) - std::max(from, static_cast<double>(k))) / width;
            for (int64_t row = 0; row < rows; ++row)
                result[static_cast<size_t>(i * rows + row)] += share * all[static_cast<size_t>(row * columns + k)];
        }
    }
    return result;
}

} // namespace

ImageParts parts_read(const Module& module)
{
    constexpr uint8_t every = 15;
    ImageParts parts;
    for (const Function& function : module.functions) {
        std::unordered_map<uint32_t, uint32_t> constants; // by Value::index
        for_each_instruction(function.body, [&](const Instruction& made) {
            if (const auto* constant = std::get_if<WordConstant>(&made.kind))
                constants[made.results[0].index] = constant->bits;
            const auto* operation = std::get_if<Operation>(&made.kind);
            if (!operation) return;
            parts.levels |= operation->op == Op::image_coarser;
            if (operation->op != Op::image_channel) return;
            const auto colour = constants.find(made.operands[1].index);
            parts.channels |= colour != constants.end() && colour->second < 4 ? uint8_t(1u << colour->second) : every;
        });
    }
    return parts;
}

std::shared_ptr<const SplineImage> SplineImage::make(const ImageTexels& texels, ImageParts wanted, std::string& error)
{
    const auto [width, height] = std::pair(texels.width, texels.height);
    const auto fail = [&](std::string reason) {
        error = std::move(reason);
        return nullptr;
    };
    if (width < 1 || height < 1) return fail("it has no texels");
    if (width > side_max || height > side_max || width * height > texels_max)
        return fail("it is too large: expected at most " + std::to_string(side_max) + " texels a side and " +
                    std::to_string(texels_max) + " in all, found " + std::to_string(width) + " x " +
                    std::to_string(height));
    std::vector<std::span<const double>> all = {texels.brightness};
    for (const std::span<const double> colour : texels.colours)
        if (!colour.empty()) all.push_back(colour);
    for (const std::span<const double> numbers : all) {
        if (numbers.size() != static_cast<size_t>(width * height)) return fail("its rows are not whole");
        for (size_t i = 0; i < numbers.size(); ++i)
            if (!(std::fabs(numbers[i]) < 1e100)) // so that no sum of texels overflows
                return fail("texel (" + std::to_string(i % static_cast<size_t>(width)) + ", " +
                            std::to_string(i / static_cast<size_t>(width)) + ") is not a number of reasonable size");
    }
    std::shared_ptr<SplineImage> made = make_one(texels.brightness, width, height);
    if (wanted.channels || wanted.levels) made->add_parts(texels, wanted);
    return made;
}

std::shared_ptr<SplineImage> SplineImage::make_one(std::span<const double> texels, int64_t width, int64_t height)
{
    std::shared_ptr<SplineImage> made(new SplineImage);
    const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
    auto& [clamped, tiled, mirrored] = made->coefficients;
    clamped = framed(texels, columns, rows);
    solve_both(clamped, columns + 2, rows + 2, solve_clamped);
    tiled = mirrored = {texels.begin(), texels.end()};
    solve_both(tiled, columns, rows, solve_tiled);
    solve_both(mirrored, columns, rows, solve_mirrored);
    haptel_image view{};
    for (size_t edge = 0; edge < std::size(view.coefficients); ++edge)
        view.coefficients[edge] = made->coefficients[edge].data();
    view.width = static_cast<int32_t>(width);
    view.height = static_cast<int32_t>(height);
    made->views = {view};
    return made;
}

void SplineImage::add_parts(const ImageTexels& texels, ImageParts wanted)
{
    using Levels = std::vector<const SplineImage*>;
    const auto levels_of = [&](std::span<const double> finest, const SplineImage* first) {
        Levels levels;
        std::vector<double> numbers{finest.begin(), finest.end()};
        for (int64_t width = texels.width, height = texels.height;;) {
            if (!first || !levels.empty()) made.push_back(make_one(numbers, width, height));
            levels.push_back(first && levels.empty() ? first : made.back().get());
            if (!wanted.levels || (width == 1 && height == 1)) return levels;
            numbers = halved(halved(numbers, height, width), halved(width), height);
            width = halved(width);
            height = halved(height);
        }
    };
    const Levels brightness = levels_of(texels.brightness, this);
    std::vector<Levels> channels = {brightness};
    for (size_t i = 0; wanted.channels && i < std::size(texels.colours); ++i) {
        if (!(wanted.channels >> i & 1))
            channels.push_back(brightness); // nobody reads it
        else if (!texels.colours[i].empty())
            channels.push_back(levels_of(texels.colours[i], nullptr));
        else if (i < 3)
            channels.push_back(brightness);
        else
            channels.push_back(Levels(brightness.size(), made.emplace_back(make_one(std::array{1.0}, 1, 1)).get()));
    }
    const auto count = [](const auto& all) { return static_cast<int32_t>(all.size()); };
    for (int32_t channel = 0; channel < count(channels); ++channel)
        for (int32_t level = 0; level < count(brightness); ++level)
            parts.push_back(channels[static_cast<size_t>(channel)][static_cast<size_t>(level)]);
    std::vector<haptel_image> linked;
    for (const SplineImage* part : parts) linked.push_back(part->views[0]);
    for (size_t i = 0; i < linked.size(); ++i) {
        haptel_image& view = linked[i];
        view.parts = linked.data();
        view.channels = count(channels);
        view.levels = count(brightness);
        view.channel = static_cast<int32_t>(i) / view.levels;
        view.level = static_cast<int32_t>(i) % view.levels;
    }
    views = std::move(linked);
}

const SplineImage& SplineImage::part(int32_t channel, int32_t level) const
{
    const haptel_image& image = view();
    if (!image.parts) return *this;
    return *parts[static_cast<size_t>(image_part(&image, channel, level) - image.parts)];
}

} // namespace haptel::ir
