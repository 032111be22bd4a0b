// Every overload of every built-in, by a loop over the table: its gradient against difference quotients of its own
// height at 113 bits, and at the edges (signed zeros, ties, subnormal numbers) against the oracle's gradient.
#include "lang/compile.h"
#include "lang/ir/run/interpret.h"
#include "lang/math/quad.h"
#include "lang/program/builtins.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace haptel;
using namespace haptel::lang;

namespace {

using Point = std::array<double, 3>;

// Texture whose height is a weighted sum of what the overload returns. Numbers are counted through its arguments: the
// first three are the coordinates of the point, the others smooth functions of them.
std::string source_of(const BuiltinOverload& overload)
{
    int count = 0;
    const auto component = [&](bool of_matrix) {
        const int which = count++;
        if (which < 3) return std::string("q.") + "xyz"[which];
        const std::string n = std::to_string(which);
        if (!of_matrix) // in the same domain as the coordinate
            return "(0.9 * q." + std::string(1, "xyz"[which % 3]) + " + 0.01 * sin(q.y * " + n + ".0))";
        return "(0.5 * sin(q.x * 0.1" + n + " + " + n + ".0) + 0.25 * cos(q.y - 0.3 * q.z * " + n + ".0))";
    };
    std::string arguments;
    for (const ParameterInfo& parameter : overload.parameters) {
        std::string one = to_string(parameter.type) + "(";
        for (uint32_t i = 0; i < parameter.type.components(); ++i)
            one += (i ? ", " : "") + component(parameter.type.is_matrix());
        arguments += (arguments.empty() ? "" : ", ") + one + ")";
    }
    std::string sum;
    const Type result = overload.result;
    for (uint32_t i = 0; i < result.components(); ++i) {
        const std::string weight = std::to_string(i % 2 ? -0.375 - i : 1.0 + i);
        std::string picked = "r";
        if (result.is_matrix())
            picked += "[" + std::to_string(i / result.size) + "][" + std::to_string(i % result.size) + "]";
        else if (result.is_vector())
            picked += "[" + std::to_string(i) + "]";
        sum += (i ? " + " : "") + weight + " * " + picked;
    }
    return "texture t()\n{\n    vec3 q = p / 1m;\n    " + to_string(result) +
           " r = " + std::string(overload.builtin->name) + "(" + arguments + ");\n    return 1m * (" + sum + ");\n}\n";
}

template <typename T>
class Engine {
public:
    explicit Engine(const ir::Module& whole) : texture(whole.textures.back()), interpreter(whole)
    {
        interpreter.watch_decisions(true);
    }
    std::array<T, 4> run(const std::array<T, 3>& p)
    {
        ir::EntryInputs<T> inputs;
        for (size_t i = 0; i < 3; ++i) inputs.input[i] = p[i];
        const auto results = interpreter.run(texture.height_gradient, {}, &inputs);
        faults = results[4].bits;
        decisions = interpreter.decisions();
        return {results[0].real, results[1].real, results[2].real, results[3].real};
    }
    uint32_t faults = 0;
    uint64_t decisions = 0;

private:
    const ir::Texture& texture;
    ir::Interpreter<T> interpreter;
};

std::array<ir::Quad, 3> exact(const Point& p)
{
    return {ir::Quad(p[0]), ir::Quad(p[1]), ir::Quad(p[2])};
}

// Along one axis, by two central differences and a Richardson step; nothing where a piece ends between.
std::optional<double> difference(Engine<ir::Quad>& oracle, const Point& p, size_t axis)
{
    oracle.run(exact(p));
    const uint64_t decisions = oracle.decisions;
    bool is_smooth = oracle.faults == 0;
    const ir::Quad step = 0x1p-28;
    const auto height = [&](const ir::Quad& offset) {
        auto moved = exact(p);
        moved[axis] += offset;
        const ir::Quad result = oracle.run(moved)[0];
        is_smooth = is_smooth && oracle.faults == 0 && oracle.decisions == decisions;
        return result;
    };
    const ir::Quad coarse = (height(step) - height(-step)) / (2 * step);
    const ir::Quad fine = (height(step / 2) - height(-step / 2)) / step;
    if (!is_smooth) return std::nullopt;
    return static_cast<double>((4 * fine - coarse) / 3);
}

struct Compiled {
    std::shared_ptr<const Program> program;
    std::string source;
};

// Of every overload that takes reals and returns some.
std::vector<Compiled> all_overloads()
{
    std::vector<Compiled> all;
    for (const auto& [name, overloads] : builtin_overloads())
        for (const BuiltinOverload& overload : overloads) {
            if (overload.result.scalar != Scalar::float_) continue;
            const auto is_image = [](const ParameterInfo& parameter) { return parameter.type == image_type; };
            if (std::ranges::any_of(overload.parameters, is_image)) continue; // spline_test.cpp, image_test.cpp
            const std::string source = source_of(overload);
            INFO(source);
            CompileResult result = compile({"builtin", source}, {});
            INFO(render(result.diagnostics.all(), result.sources));
            REQUIRE(result.program);
            all.push_back({result.program, source});
        }
    return all;
}

} // namespace

TEST_CASE("built-ins: the gradient of every overload agrees with differences at 113 bits")
{
    const double swept[] = {-7.3, -2.6, -1.37, -0.93, -0.51, -0.26, -0.012, 0.013,
                            0.31, 0.77, 0.96,  1.2,   1.41,  2.9,   4.7,    8.1};
    constexpr size_t count = std::size(swept);
    size_t overloads = 0;
    for (const Compiled& one : all_overloads()) {
        ++overloads;
        if (one.source.find("detach(") != std::string::npos) continue; // differs on purpose
        INFO(one.source);
        Engine<double> machine(one.program->module);
        Engine<ir::Quad> oracle(one.program->module);
        int compared = 0;
        for (size_t i = 0; i < count * count; i += 3) {
            const Point p = {swept[i % count], swept[i / count], swept[(3 * i + 5 * (i / count) + 1) % count]};
            const std::array<double, 4> found = machine.run(p);
            for (size_t axis = 0; axis < 3; ++axis) {
                const std::optional<double> truth = difference(oracle, p, axis);
                if (!truth || !(std::fabs(*truth) < 1e6)) continue;
                CAPTURE(p, axis, *truth, found[1 + axis]);
                CHECK(std::fabs(found[1 + axis] - *truth) <= 2e-12 * (1 + std::fabs(*truth)));
                ++compared;
            }
        }
        CHECK(compared >= 6);
    }
    CHECK(overloads >= 150);
}

TEST_CASE("built-ins: at the edges every overload gives the oracle's gradient, and none gives a fault of its own")
{
    const double edges[] = {0.0, -0.0, 5e-324, -1e-310, 1.0, -1.0, 2.0, 0.5, -40.0};
    constexpr size_t count = std::size(edges);
    size_t compared = 0;
    for (const Compiled& one : all_overloads()) {
        INFO(one.source);
        Engine<double> machine(one.program->module);
        Engine<ir::Quad> oracle(one.program->module);
        for (size_t i = 0; i < count * count; ++i) {
            const Point p = {edges[i % count], edges[i / count], edges[(i + i / count) % count]};
            const std::array<double, 4> found = machine.run(p);
            const std::array<ir::Quad, 4> truth = oracle.run(exact(p));
            for (double number : found) CHECK(std::isfinite(number));
            // Rounding may decide otherwise, and f64 ends sooner.
            if (oracle.faults != 0 || oracle.decisions != machine.decisions) continue;
            bool is_moderate = true, is_normal = true;
            for (const ir::Quad& number : truth) is_moderate = is_moderate && abs(number) < 1e100;
            for (double number : p) is_normal = is_normal && (number == 0 || std::isnormal(number));
            if (!is_moderate) continue;
            CAPTURE(p, found);
            CHECK(machine.faults == 0);
            for (size_t j = 0; j < 4 && is_normal; ++j) {
                const auto should = static_cast<double>(truth[j]);
                CAPTURE(j, should);
                CHECK(std::fabs(found[j] - should) <= 1e-9 * std::fabs(should) + 1e-9);
                ++compared;
            }
        }
    }
    CHECK(compared >= 20'000);
}

TEST_CASE("built-ins: at huge coordinates every overload gives numbers, or shows a fault and gives 0")
{
    const double edges[] = {1e9, -1e9, 1e300, -1e300, 0.0, -0.0, 5e-324, 0.75};
    constexpr size_t count = std::size(edges);
    size_t faults = 0;
    for (const Compiled& one : all_overloads()) {
        INFO(one.source);
        Engine<double> machine(one.program->module);
        for (size_t i = 0; i < count * count; ++i) {
            const Point p = {edges[i % count], edges[i / count], edges[(i + i / count) % count]};
            const std::array<double, 4> found = machine.run(p);
            CAPTURE(p, found, machine.faults);
            for (double number : found) CHECK(std::isfinite(number));
            if (machine.faults & HAPTEL_FAULT_HEIGHT_NOT_FINITE) CHECK(found[0] == 0);
            if (machine.faults) CHECK((found[1] == 0 && found[2] == 0 && found[3] == 0));
            faults += machine.faults != 0;
        }
    }
    CHECK(faults >= 100); // 1e300 squared, for one
}
