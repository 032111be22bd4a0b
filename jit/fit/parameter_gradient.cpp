#include "jit/fit/parameter_gradient.h"

#include "lang/ir/derive/differentiate.h"
#include "lang/ir/verify.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace haptel::jit {

namespace {

constexpr std::size_t point_reals = sizeof(haptel_point) / sizeof(double);

std::string name_of_group(std::size_t first)
{
    return "parameters " + std::to_string(first);
}

} // namespace

PointArrays::PointArrays(std::span<const haptel_point> points)
    : count(points.size()), inputs(point_reals, std::vector<double>(points.size()))
{
    const double* arrays[point_reals];
    static_assert(sizeof arrays == sizeof pointers);
    for (std::size_t real = 0; real < point_reals; ++real) {
        const char* place = reinterpret_cast<const char*>(points.data()) + real * sizeof(double);
        for (std::size_t i = 0; i < count; ++i, place += sizeof(haptel_point))
            std::memcpy(&inputs[real][i], place, sizeof(double));
        arrays[real] = inputs[real].data();
    }
    std::memcpy(&pointers, arrays, sizeof pointers);
}

ParameterGradient::ParameterGradient(std::shared_ptr<const CompiledProgram> of, std::string_view texture,
                                     std::vector<uint32_t> parameters)
    : program(std::move(of)), described(program->find(texture)), by(std::move(parameters))
{
    if (!described || !described->height_batch) {
        failure = "the texture has no code for many points";
        return;
    }
    ir::Module module = program->module();
    const ir::Texture source = program->source_of(*described);
    ir::Differentiator differentiator(module);
    const std::size_t known = module.textures.size();
    for (std::size_t first = 0; first < by.size(); first += ir::axes) {
        ir::Texture group = source;
        group.name = name_of_group(first);
        group.writes = 0;
        group.body = group.height = UINT32_MAX;
        group.height_gradient = differentiator.parameter_gradient(
            source, std::span(by).subspan(first, std::min(ir::axes, by.size() - first)));
        module.textures.push_back(std::move(group));
    }
    if (failure = ir::verify(module); !failure.empty()) return;
    std::vector<EntryPoint> wanted;
    for (const ir::Texture& group : std::span(module.textures).subspan(known))
        wanted.push_back({group.name, &group, EntryPoint::Kind::height_gradient, LaneForm::points, Precision::f64});
    CodeResult made = compile_code(module, wanted);
    code = std::move(made.code);
    failure = std::move(made.error);
    for (const EntryPoint& entry : wanted)
        if (code) entries.push_back(code->batch_entry(entry.name));
}

void ParameterGradient::heights(const PointArrays& points, const void* block, std::span<double> heights_m) const
{
    std::vector<uint32_t> faults(points.size());
    haptel_samples samples{};
    samples.height_m = heights_m.data();
    samples.faults = faults.data();
    described->height_batch(&points.arrays(), points.size(), block, &samples);
}

void ParameterGradient::gradient(const PointArrays& points, const void* block, std::span<double> heights_m,
                                 std::span<double> by_parameters) const
{
    const std::size_t rows = points.size();
    std::vector<uint32_t> faults(rows);
    std::vector<double> unused(rows * 2), stiffness(rows), friction(rows);
    if (entries.empty()) return heights(points, block, heights_m);
    for (std::size_t group = 0; group < entries.size(); ++group) {
        haptel_samples samples{};
        samples.height_m = heights_m.data();
        samples.faults = faults.data();
        samples.stiffness_scale = stiffness.data();
        samples.friction_scale = friction.data();
        for (std::size_t i = 0; i < ir::axes; ++i) {
            const std::size_t column = group * ir::axes + i;
            samples.gradient[i] =
                column < by.size() ? by_parameters.data() + column * rows : unused.data() + (i - 1) * rows;
        }
        entries[group](&points.arrays(), rows, block, &samples);
    }
}

} // namespace haptel::jit
