#include "bench/accuracy_bench.h"

#include "bench/plain_entries.h"
#include "jit/oracle.h"
#include "jit/texture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <random>

namespace haptel::bench {
namespace {

constexpr double distances[] = {10, 1e3, 1e6}; // wavelengths
constexpr double default_step = 1e-3;          // of a wavelength: what people write down

struct Case {
    const char* name;
    const char* call; // of the library; p in metres, the wavelength 1 m
    Field field;
};
constexpr Case cases[] = {{"noise", "noise(p / 1m)", Field::noise},
                          {"perlin", "perlin(p / 1m)", Field::perlin},
                          {"fbm8", "fbm(p / 1m, 8)", Field::fbm8},
                          {"gardner7", "fourier(p.xy / 1m, 7)", Field::gardner7}};

jit::CompiledTextures compiled(const Case& one, jit::Precision precision)
{
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    options.effort = jit::Effort::full;
    options.precision = precision;
    return jit::compile_texture("texture t() { return 1m * " + std::string(one.call) + "; }", options);
}

// Points as arrays, and room for their samples.
struct Points {
    Points(size_t count, double wavelengths, uint32_t seed)
        : coordinates(3, std::vector<double>(count)), numbers(6, std::vector<double>(count)), faults(count)
    {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> place(-wavelengths, wavelengths);
        for (auto& axis : coordinates)
            for (double& coordinate : axis) coordinate = place(random);
        for (size_t axis = 0; axis < 3; ++axis) in.p[axis] = coordinates[axis].data();
        out = {numbers[0].data(),
               {numbers[1].data(), numbers[2].data(), numbers[3].data()},
               numbers[4].data(),
               numbers[5].data(),
               faults.data()};
    }
    size_t size() const { return faults.size(); }
    haptel_point at(size_t i) const
    {
        haptel_point point{};
        for (size_t axis = 0; axis < 3; ++axis) point.p[axis] = coordinates[axis][i];
        return point;
    }
    std::vector<std::vector<double>> coordinates, numbers;
    std::vector<uint32_t> faults;
    haptel_points in{};
    haptel_samples out{};
};

// The truth at points, and how large it gets.
struct Truth {
    Truth(const jit::CompiledTextures& exact, const TextureBinding& binding, const Points& points)
    {
        jit::Oracle oracle(exact.program, binding);
        for (size_t i = 0; i < points.size(); ++i) {
            samples.push_back(oracle.sample(points.at(i)));
            const jit::OracleSample& sample = samples.back();
            height = std::max(height, std::fabs(sample.height_m));
            gradient = std::max(gradient, std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]));
        }
    }
    Accuracy of(const Points& points, haptel_entry* entry, const void* block, double wavelengths) const
    {
        Accuracy result{wavelengths, 0, 0, 0};
        for (size_t i = 0; i < samples.size(); ++i) {
            const haptel_point point = points.at(i);
            haptel_sample found{};
            entry(&point, block, &found);
            double off[3];
            for (size_t axis = 0; axis < 3; ++axis) off[axis] = found.gradient[axis] - samples[i].gradient[axis];
            const double error = std::hypot(off[0], off[1], off[2]) / gradient;
            result.height_max = std::max(result.height_max, std::fabs(found.height_m - samples[i].height_m) / height);
            result.gradient_max = std::max(result.gradient_max, error);
            result.gradient_rms += error * error / static_cast<double>(samples.size());
        }
        result.gradient_rms = std::sqrt(result.gradient_rms);
        return result;
    }
    std::vector<jit::OracleSample> samples;
    double height = 0, gradient = 0;
};

// Differences of our own height, of order 2.
struct OwnDifferences {
    haptel_entry* height;
    const void* block;
    double step;
    static void entry(const haptel_point* point, const void* own, haptel_sample* sample)
    {
        const auto& held = *static_cast<const OwnDifferences*>(own);
        held.height(point, held.block, sample);
        for (size_t axis = 0; axis < 3; ++axis) {
            haptel_sample ends[2];
            for (int side = 0; side < 2; ++side) {
                haptel_point moved = *point;
                moved.p[axis] += side ? held.step : -held.step;
                held.height(&moved, held.block, &ends[side]);
            }
            sample->gradient[axis] = (ends[1].height_m - ends[0].height_m) / (2 * held.step);
        }
    }
};

// One row in the making.
struct Contender {
    AccuracyRow row;
    haptel_entry* point = nullptr;
    haptel_batch_entry* batch = nullptr; // instead of `point` where the row is a batch
    haptel_entry* height = nullptr;      // the same without the gradient
    haptel_batch_entry* height_batch = nullptr;
    const void* block = nullptr;
    std::vector<double> times_ns, height_times_ns;
};

double nanoseconds_per_point(size_t count, const std::function<void()>& work)
{
    return milliseconds(work) * 1e6 / static_cast<double>(count);
}

// Each point waits for the sample before it, as in a servo.
void one_by_one(haptel_entry* entry, const void* block, const Points& points)
{
    double carried = 0;
    haptel_sample sample{};
    for (size_t i = 0; i < points.size(); ++i) {
        haptel_point point = points.at(i);
        point.p[0] += carried;
        entry(&point, block, &sample);
        carried = sample.height_m * 1e-300 + sample.gradient[0] * 1e-300;
    }
}

void run(Contender& one, Points& points)
{
    if (one.row.is_batch) {
        const auto time = [&](haptel_batch_entry* entry) {
            return nanoseconds_per_point(points.size(),
                                         [&] { entry(&points.in, points.size(), one.block, &points.out); });
        };
        one.times_ns.push_back(time(one.batch));
        if (one.height_batch) one.height_times_ns.push_back(time(one.height_batch));
        return;
    }
    const auto time = [&](haptel_entry* entry) {
        return nanoseconds_per_point(points.size(), [&] { one_by_one(entry, one.block, points); });
    };
    one.times_ns.push_back(time(one.point));
    if (one.height) one.height_times_ns.push_back(time(one.height));
}

void mark_frontier(std::vector<AccuracyRow>& rows)
{
    for (AccuracyRow& row : rows)
        row.is_on_frontier = std::none_of(rows.begin(), rows.end(), [&](const AccuracyRow& other) {
            const double error = row.errors[0].gradient_max, others = other.errors[0].gradient_max;
            return other.is_batch == row.is_batch && other.median_ns <= row.median_ns && others <= error &&
                   (other.median_ns < row.median_ns || others < error);
        });
}

// Everything that competes in one texture.
class CaseBench {
public:
    CaseBench(const Case& of, bool is_quick) : which(of), quick(is_quick)
    {
        for (const auto& [precision, name] : precisions) programs.push_back(compiled(which, precision));
        binding = *jit::make_binding(programs[0].program, "t", {}, jit::Unbounded::allowed).binding;
        for (double distance : distances) {
            near_and_far.emplace_back(quick ? 100 : 1000, distance, 7);
            truth.emplace_back(programs[0], binding, near_and_far.back());
        }
        plain = std::make_unique<PlainMethods>(which.field, programs[0].program->module());
        for (int exponent = 2; exponent <= 26; exponent += 2) steps.push_back(std::ldexp(1, -exponent));
    }
    std::vector<AccuracyRow> rows()
    {
        add_ours();
        add_plain();
        add_own_differences();
        measure();
        std::vector<AccuracyRow> result;
        for (Contender& contender : contenders) result.push_back(std::move(contender.row));
        mark_frontier(result);
        return result;
    }

private:
    static constexpr std::pair<jit::Precision, const char*> precisions[] = {
        {jit::Precision::f64, "f64"}, {jit::Precision::mixed, "mixed"}, {jit::Precision::f32, "f32"}};

    const Case& which;
    const bool quick;
    std::vector<jit::CompiledTextures> programs; // by `precisions`
    TextureBinding binding;
    std::vector<Points> near_and_far; // by `distances`
    std::vector<Truth> truth;
    std::unique_ptr<PlainMethods> plain;
    std::vector<double> steps{default_step};
    OwnDifferences own{};
    std::vector<Contender> contenders;

    Contender contender(const std::string& method, const std::string& precision, haptel_entry* point,
                        const void* block) const
    {
        Contender made;
        made.row.texture = which.name;
        made.row.method = method;
        made.row.precision = precision;
        made.point = point;
        made.block = block;
        for (size_t i = 0; i < truth.size(); ++i)
            made.row.errors.push_back(truth[i].of(near_and_far[i], point, block, distances[i]));
        return made;
    }
    void add_ours()
    {
        for (size_t i = 0; i < programs.size(); ++i) {
            const haptel_texture& texture = programs[i].program->textures()[0];
            Contender made = contender("haptel", precisions[i].second, texture.height_gradient, binding.block);
            made.height = texture.height;
            contenders.push_back(made);
            made.row.is_batch = true;
            made.row.lanes = jit::batch_lanes();
            made.batch = texture.height_gradient_batch;
            made.height_batch = texture.height_batch;
            contenders.push_back(std::move(made));
        }
    }
    // Of each kind of differences, the default step and the best.
    void add_plain()
    {
        std::vector<Contender> kept;
        std::map<std::string, size_t> best;
        for (const PlainMethod& method : plain->add_differences(steps)) {
            Contender made = contender(method.name, method.precision, method.point, method.block);
            made.batch = method.batch;
            made.row.step = method.step;
            made.row.is_best_step = method.step != 0 && method.step != default_step;
            const auto [place, is_new] =
                best.try_emplace(method.name + method.precision + (made.row.is_best_step ? "" : "d"), kept.size());
            if (is_new)
                kept.push_back(std::move(made));
            else if (made.row.errors[0].gradient_max < kept[place->second].row.errors[0].gradient_max)
                kept[place->second] = std::move(made);
        }
        for (Contender& made : kept) {
            contenders.push_back(made);
            made.row.is_batch = true;
            contenders.push_back(std::move(made));
        }
    }
    void add_own_differences()
    {
        Contender best;
        for (double step : steps) {
            OwnDifferences tried{programs[0].program->textures()[0].height, binding.block, step};
            Contender made = contender("haptel_difference", "f64", OwnDifferences::entry, &tried);
            if (best.point && made.row.errors[0].gradient_max >= best.row.errors[0].gradient_max) continue;
            best = std::move(made);
            best.row.step = step;
            own = tried;
        }
        best.row.is_best_step = true;
        best.block = &own;
        contenders.push_back(std::move(best));
    }
    // In rounds, so that whatever the machine does besides meets all alike.
    void measure()
    {
        Points single(quick ? 256 : 2048, distances[0], 8), many(quick ? 1 << 14 : 1 << 17, distances[0], 9);
        for (int round = 0; round < (quick ? 5 : 9); ++round)
            for (Contender& contender : contenders) run(contender, contender.row.is_batch ? many : single);
        for (Contender& contender : contenders) {
            const Times times = summary(contender.times_ns);
            contender.row.median_ns = times.median;
            contender.row.p99_ns = times.p99;
            contender.row.height_only_ns = summary(contender.height_times_ns).median;
        }
    }
};

} // namespace

std::vector<AccuracyRow> bench_accuracy(bool quick, const std::function<void(double)>& progress)
{
    std::vector<AccuracyRow> rows;
    for (size_t i = 0; i < std::size(cases); ++i) {
        progress(static_cast<double>(i) / std::size(cases));
        std::vector<AccuracyRow> of_case = CaseBench(cases[i], quick).rows();
        std::move(of_case.begin(), of_case.end(), std::back_inserter(rows));
    }
    progress(1);
    return rows;
}

} // namespace haptel::bench
