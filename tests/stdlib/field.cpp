#include "tests/stdlib/field.h"

#include "stdlib/stdlib.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <random>

namespace haptel::test {

Field::Field(const std::string& expression, const std::string& declarations, double footprint)
{
    const std::string source =
        declarations + "\ntexture field() { vec3 q = p / 1m; return 1m * (" + expression + "); }\n";
    jit::CompiledTextures compiled = jit::compile_texture(source);
    INFO(compiled.rendered());
    REQUIRE(compiled.program);
    program = compiled.program;
    block.assign(program->textures()[0].block_size / sizeof(double) + 1, 0.0);
    block[offsetof(haptel_block_head, footprint_m) / sizeof(double)] = footprint;
}

FieldSample Field::operator()(const Vec3& q) const
{
    haptel_point point{};
    haptel_sample sample{};
    std::copy(q.begin(), q.end(), point.p);
    program->textures()[0].height_gradient(&point, block.data(), &sample);
    CHECK(sample.faults == 0);
    return {sample.height_m, {sample.gradient[0], sample.gradient[1], sample.gradient[2]}};
}

uint32_t Field::faults(const Vec3& q) const
{
    haptel_point point{};
    haptel_sample sample{};
    std::copy(q.begin(), q.end(), point.p);
    program->textures()[0].height_gradient(&point, block.data(), &sample);
    return sample.faults;
}

std::vector<double> library_table(const std::string& name)
{
    std::vector<double> cells;
    for (const stdlib::LibraryFile& file : stdlib::library()) {
        const std::string text(file.text);
        const size_t start = text.find(" " + name + "[");
        if (start == std::string::npos) continue;
        const size_t open = text.find('{', start), close = text.find('}', open);
        const std::string body = text.substr(open + 1, close - open - 1);
        const char* at = body.c_str();
        for (char* end = nullptr;; at = end + 1) {
            const double cell = std::strtod(at, &end);
            if (end == at) break;
            cells.push_back(cell);
            while (*end == ' ' || *end == '\n') ++end;
            if (*end != ',') break;
        }
    }
    REQUIRE_FALSE(cells.empty());
    return cells;
}

int shuffled(int i)
{
    static const std::vector<double> table = library_table("perlin_m");
    return static_cast<int>(table[static_cast<size_t>(i & 255)]);
}

double octave_left(double detail)
{
    const double t = std::clamp((detail - 0.5) / 0.5, 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

std::vector<Vec3> points_within(double size, int count, uint32_t seed)
{
    std::mt19937_64 random(seed);
    const auto coordinate = [&] { return (static_cast<double>(random() >> 11) * 0x1p-52 - 1) * size; };
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double x = coordinate(), y = coordinate(), z = coordinate();
        points.push_back({x, y, z});
    }
    return points;
}

} // namespace haptel::test
