// haptel eval: height and gradient of a texture at points, by any engine.
#include "jit/check/oracle.h"
#include "lang/abi/contact_limits.h"
#include "lang/abi/evaluate.h"
#include "lang/abi/outputs.h"
#include "tools/arguments/eval_table.h"
#include "tools/arguments/precisions.h"
#include "tools/arguments/texture_argument.h"
#include "tools/commands/command.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace haptel::tools {

namespace {

struct EvalOptions {
    TextureArgument texture;
    ParameterTexts parameters;
    std::optional<glm::dvec3> at_m;
    std::string points;
    glm::dvec3 normal{0, 0, 1};
    glm::dvec2 uv{0};
    glm::dvec3 velocity_m_per_s{0};
    double time_s = 0, normal_force_n = 0, tool_radius_m = 0, footprint_m = 0, box_m = 0.2;
    std::string engine = "jit", precision = "f64";
    bool json = false;
};

// What one engine says of one point: numbers as they are to be printed.
struct Evaluated {
    std::string height_m, gradient[3];
    std::vector<std::string> outputs; // that the texture writes, component by component
    uint32_t faults = 0;
};

using Evaluate = std::function<std::vector<Evaluated>(std::span<const haptel_point>)>;

struct Engine {
    Evaluate evaluate;   // empty: what is wrong has been said
    uint32_t writes = 0; // HAPTEL_WRITES_* of the texture
};

constexpr std::size_t rows_at_once = 4096;

std::string shortest(double value)
{
    return fmt::format("{}", value);
}

Evaluated shown(const haptel_sample& sample, uint32_t writes)
{
    Evaluated point{shortest(sample.height_m),
                    {shortest(sample.gradient[0]), shortest(sample.gradient[1]), shortest(sample.gradient[2])},
                    {},
                    sample.faults};
    for_each_output(writes, [&](const OutputInfo& output, size_t) {
        for (size_t i = 0; i < output.components; ++i)
            point.outputs.push_back(shortest(components_of(sample, output)[i]));
    });
    return point;
}

Evaluated shown(const jit::OracleSample& sample, uint32_t)
{
    const auto& g = sample.gradient_digits;
    return {sample.height_digits, {g[0], g[1], g[2]}, sample.output_digits, sample.faults};
}

Evaluate make_engine(const std::string& name, const std::shared_ptr<const jit::CompiledProgram>& program,
                     const TextureBinding& binding)
{
    const uint32_t writes = binding.texture->writes;
    const auto one_by_one = [writes](auto sample) {
        return [sample, writes](std::span<const haptel_point> points) {
            std::vector<Evaluated> found;
            for (const haptel_point& point : points) found.push_back(shown(sample(point), writes));
            return found;
        };
    };
    if (name == "interpreter")
        return one_by_one([=](const haptel_point& point) { return jit::interpret_sample(*program, binding, point); });
    if (name == "oracle")
        return one_by_one([oracle = std::make_shared<jit::Oracle>(program, binding)](const haptel_point& point) {
            return oracle->sample(point);
        });
    return [=](std::span<const haptel_point> points) {
        std::vector<haptel_sample> samples(points.size());
        evaluate(binding, points, samples);
        std::vector<Evaluated> found;
        for (const haptel_sample& sample : samples) found.push_back(shown(sample, writes));
        return found;
    };
}

haptel_point point_at(const EvalOptions& options, const glm::dvec3& p_m)
{
    haptel_point point{};
    for (int axis = 0; axis < 3; ++axis) {
        point.p[axis] = p_m[axis];
        point.n[axis] = options.normal[axis];
    }
    for (int axis = 0; axis < 3; ++axis) point.velocity[axis] = options.velocity_m_per_s[axis];
    for (int axis = 0; axis < 2; ++axis) point.uv[axis] = options.uv[axis];
    point.time_s = options.time_s;
    point.normal_force_n = options.normal_force_n;
    point.tool_radius_m = options.tool_radius_m;
    return point;
}

// The texture, compiled and bound to a cube round the origin. Says what is wrong.
Engine open_engine(const EvalOptions& options)
{
    jit::TextureOptions compile;
    compile.entries = options.points.empty() ? jit::Entries::height_gradient : jit::Entries::both_and_batches;
    compile.precision = precision_of(options.precision); // reading and writing text takes longer than f64
    compile.iterations_in_lanes = false;                 // a point's numbers are the same alone and among others
    const jit::CompiledTextures compiled = jit::compile_texture_file(options.texture.file, compile);
    fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
    if (!compiled.program) return {};
    TextureRequest request = request_in_cube(options.box_m, options.footprint_m);
    request.parameters = options.parameters;
    TextureResult bound = jit::make_binding(compiled.program, options.texture.name, request, jit::For::figures);
    fmt::print(stderr, "{}", bound.diagnostics);
    if (!bound.binding) return {};
    return {make_engine(options.engine, compiled.program, *bound.binding), bound.binding->texture->writes};
}

struct Written {
    const OutputInfo* info;
    size_t first; // of its components, in Evaluated::outputs
};

// Only what the texture writes.
std::vector<Written> written_by(uint32_t writes)
{
    std::vector<Written> outputs;
    for_each_output(writes, [&](const OutputInfo& output, size_t first) { outputs.push_back({&output, first}); });
    return outputs;
}

std::string joined(const Evaluated& point, const Written& output, const char* between)
{
    const std::span<const std::string> values(&point.outputs[output.first], output.info->components);
    return fmt::format("{}", fmt::join(values, between));
}

void print_lines(uint32_t writes, const Evaluated& point)
{
    fmt::print("height_m {}\ngradient {} {} {}\n", point.height_m, point.gradient[0], point.gradient[1],
               point.gradient[2]);
    for (const Written& output : written_by(writes))
        fmt::print("{} {}\n", output.info->name, joined(point, output, " "));
    fmt::print("faults {}\n", point.faults);
}

// Written by hand because the oracle's numbers have more digits than a JSON library's. `indent` stands before each line
// but the first; `p_m` says which of many points it is.
void print_point(const EvalOptions& options, uint32_t writes, const Evaluated& point, const char* indent,
                 const std::string& p_m)
{
    const auto line = [&](const std::string& text) { fmt::print("{}  {},\n", indent, text); };
    fmt::print("{{\n");
    line(fmt::format("\"file\": {}", to_text(options.texture.file)));
    line(fmt::format("\"name\": {}", to_text(options.texture.name)));
    line(fmt::format("\"engine\": \"{}\"", options.engine));
    if (!p_m.empty()) line(fmt::format("\"p_m\": [{}]", p_m));
    line(fmt::format("\"height_m\": {}", point.height_m));
    line(fmt::format("\"gradient\": [{}, {}, {}]", point.gradient[0], point.gradient[1], point.gradient[2]));
    for (const Written& output : written_by(writes)) {
        const std::string values = joined(point, output, ", ");
        line(fmt::format("\"{}\": {}", output.info->name, output.info->components > 1 ? "[" + values + "]" : values));
    }
    fmt::print("{0}  \"faults\": {1}\n{0}}}", indent, point.faults);
}

// A table of points with their values, as a table or as an array; goes on from the first rows.
void print_table(const EvalOptions& options, const Engine& engine, PointTable& table, std::vector<PointTable::Row> rows)
{
    const std::vector<Written> outputs = written_by(engine.writes);
    if (!options.json) {
        fmt::print("{},height_m,gx,gy,gz", table.header());
        for (const Written& output : outputs)
            for (size_t i = 0; i < output.info->components; ++i) fmt::print(",{}", component_name(*output.info, i));
        fmt::print(",faults\n");
    }
    const char* between = "[\n  ";
    for (; !rows.empty(); rows = table.next(rows_at_once)) {
        std::vector<haptel_point> points;
        for (const PointTable::Row& row : rows) points.push_back(point_at(options, row.p_m));
        const std::vector<Evaluated> found = engine.evaluate(points);
        for (size_t i = 0; i < found.size(); ++i) {
            const auto& [height_m, gradient, written, faults] = found[i];
            if (options.json) {
                fmt::print("{}", std::exchange(between, ",\n  "));
                print_point(options, engine.writes, found[i], "  ",
                            fmt::format("{}, {}, {}", rows[i].p_m.x, rows[i].p_m.y, rows[i].p_m.z));
                continue;
            }
            fmt::print("{},{},{},{},{}", rows[i].text, height_m, gradient[0], gradient[1], gradient[2]);
            for (const std::string& value : written) fmt::print(",{}", value);
            fmt::print(",{}\n", faults);
        }
    }
    if (options.json) fmt::print("\n]\n");
}

ExitCode run(const EvalOptions& options)
{
    if (options.precision != "f64" && options.engine != "jit") {
        say_error(fmt::format("precision {} is of machine code: the {} has its own (leave out --engine or --precision)",
                              options.precision, options.engine));
        return ExitCode::misuse;
    }
    std::optional<PointTable> table;
    std::vector<PointTable::Row> rows;
    const auto is_sound = [&] {
        if (table && !table->error().empty()) say_error(table->error());
        return !table || table->error().empty();
    };
    if (!options.points.empty()) rows = table.emplace(options.points).next(rows_at_once);
    if (!is_sound()) return ExitCode::findings;
    const Engine engine = open_engine(options);
    if (!engine.evaluate) return ExitCode::findings;
    if (options.at_m) {
        const haptel_point point = point_at(options, *options.at_m);
        const Evaluated found = engine.evaluate({&point, 1})[0];
        if (options.json) {
            print_point(options, engine.writes, found, "", {});
            fmt::print("\n");
        } else {
            print_lines(engine.writes, found);
        }
        return ExitCode::fine;
    }
    print_table(options, engine, *table, std::move(rows));
    return is_sound() ? ExitCode::fine : ExitCode::findings;
}

} // namespace

Command eval_command(CLI::App& app)
{
    const auto options = std::make_shared<EvalOptions>();
    CLI::App* command = app.add_subcommand("eval", "Height and gradient of a texture at one point or many");
    add_texture(*command, options->texture);
    auto* where = command->add_option_group("Points");
    add_parsed(*where, "--at", "X,Y,Z", options->at_m, parse_point, "One point");
    where
        ->add_option(
            "--points", options->points,
            "CSV with the columns x,y,z: lengths, such as 1mm; bare numbers are metres. The table with further columns "
            "goes to standard output")
        ->type_name("FILE.csv");
    where->require_option(1);
    add_parameters(*command, options->parameters);
    add_parsed(*command, "--normal", "X,Y,Z", options->normal, parse_vector, "The input n [0,0,1]");
    add_parsed(*command, "--uv", "U,V", options->uv, parse_vector2, "The input uv [0,0]");
    add_parsed(*command, "--velocity", "X,Y,Z", options->velocity_m_per_s, parse_vector,
               "The input velocity, m/s [0,0,0]");
    command->add_option("--time", options->time_s, "The input time, seconds [0]")->type_name("S");
    command->add_option("--normal-force", options->normal_force_n, "The input normal_force, newtons [0]")
        ->type_name("N")
        ->check(CLI::Range(0.0, normal_force_max_n));
    add_length(*command, "--tool-radius", options->tool_radius_m, "The input tool_radius [0]",
               NumberRange::not_negative);
    add_length(*command, "--footprint", options->footprint_m, "Smallest wavelength worth rendering [0]",
               NumberRange::not_negative);
    add_length(*command, "--box", options->box_m, "Side of the cube that center and extent describe [0.2m]");
    command
        ->add_option("--engine", options->engine,
                     "jit: machine code; interpreter: the same bits, slowly; oracle: 113 bits, 36 digits")
        ->check(CLI::IsMember({"jit", "interpreter", "oracle"}))
        ->capture_default_str();
    command
        ->add_option(
            "--precision", options->precision,
            "Precision of the code: f64; mixed: f64 where the place within a cell depends on it, else f32; f32")
        ->check(CLI::IsMember({"f64", "mixed", "f32"}))
        ->capture_default_str();
    command->add_flag("--json", options->json, "One JSON object on standard output; with --points an array of them");
    set_examples(*command, "  haptel eval rock.haptel:rock --at 1mm,2mm,0\n"
                           "  haptel eval rock.haptel:rock --at 0,0,0 --set octaves=3 --engine oracle --json\n"
                           "  haptel eval rock.haptel:rock --points scan.csv > scan_with_heights.csv");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
