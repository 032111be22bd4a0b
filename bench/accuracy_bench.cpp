#include "bench/accuracy_bench.h"

#include "bench/accuracy_points.h"
#include "bench/accuracy_verdict.h"
#include "bench/plain_entries.h"
#include "jit/engine/engine.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

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
                          {"fbm1", "fbm(p / 1m, 1)", Field::fbm1},
                          {"fbm2", "fbm(p / 1m, 2)", Field::fbm2},
                          {"fbm4", "fbm(p / 1m, 4)", Field::fbm4},
                          {"fbm8", "fbm(p / 1m, 8)", Field::fbm8},
                          {"gardner7", "fourier(p.xy / 1m, 7)", Field::gardner7}};

// Our precisions and lane forms of one point; a batch comes with each of the first three.
struct Variant {
    jit::Precision precision;
    const char* name;
    bool iterations_in_lanes;
};
constexpr Variant variants[] = {{jit::Precision::f64, "f64", false},    {jit::Precision::mixed, "mixed", false},
                                {jit::Precision::f32, "f32", false},    {jit::Precision::f64, "f64", true},
                                {jit::Precision::mixed, "mixed", true}, {jit::Precision::f32, "f32", true}};

jit::CompiledTextures compiled(const Case& one, const Variant& variant)
{
    jit::TextureOptions options;
    options.entries = variant.iterations_in_lanes ? jit::Entries::both : jit::Entries::both_and_batches;
    options.effort = jit::Effort::full;
    options.precision = variant.precision;
    options.iterations_in_lanes = variant.iterations_in_lanes;
    return jit::compile_texture("texture t() { return 1m * " + std::string(one.call) + "; }", options);
}

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
    size_t slice = 0; // of the points, timed in one round
    std::vector<double> times_ns, height_times_ns;
};

// Each point waits for the sample before it, as in a servo.
void one_by_one(haptel_entry* entry, const void* block, const Points& points, size_t first, size_t count)
{
    double carried = 0;
    haptel_sample sample{};
    for (size_t i = first; i < first + count; ++i) {
        haptel_point point = points.at(i);
        point.p[0] += carried;
        entry(&point, block, &sample);
        carried = sample.height_m * 1e-300 + sample.gradient[0] * 1e-300;
    }
}

// Everything that competes in one texture.
class CaseBench {
public:
    CaseBench(const Case& of, bool is_quick) : which(of), quick(is_quick)
    {
        for (const Variant& variant : variants) programs.push_back(compiled(which, variant));
        binding = *jit::make_binding(programs[0].program, "t", {}, jit::For::figures).binding;
        for (double distance : distances) {
            near_and_far.emplace_back(quick ? 100 : 1000, distance, 7);
            truth.emplace_back(programs[0], binding, near_and_far.back());
        }
        for (int exponent = 2; exponent <= 26; exponent += 2) steps.push_back(std::ldexp(1, -exponent));
        plain = std::make_unique<PlainMethods>(which.field, programs[0].program->module(), steps);
    }
    std::vector<AccuracyRow> rows(const std::function<void(double)>& progress)
    {
        add_ours();
        add_plain();
        add_own_differences();
        measure(progress);
        std::vector<AccuracyRow> result;
        for (Contender& contender : contenders) result.push_back(std::move(contender.row));
        mark_frontier(result);
        return result;
    }

private:
    const Case& which;
    const bool quick;
    std::vector<jit::CompiledTextures> programs; // by `variants`
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
        made.row.level = jit::engine_info().isa;
        made.row.lane_form = "one";
        made.point = point;
        made.block = block;
        for (size_t i = 0; i < truth.size(); ++i) {
            std::vector<haptel_sample> found(near_and_far[i].size());
            for (size_t k = 0; k < found.size(); ++k) {
                const haptel_point at = near_and_far[i].at(k);
                point(&at, block, &found[k]);
            }
            made.row.errors.push_back(truth[i].of(found, distances[i]));
        }
        return made;
    }
    // The same for many points; its errors are its own.
    Contender as_batch(Contender made, haptel_batch_entry* batch)
    {
        made.row.is_batch = true;
        made.batch = batch;
        for (size_t i = 0; i < truth.size(); ++i) {
            Points& points = near_and_far[i];
            points.evaluate(batch, made.block, 0, points.size());
            std::vector<haptel_sample> found;
            for (size_t k = 0; k < points.size(); ++k) found.push_back(points.sample(k));
            made.row.errors[i] = truth[i].of(found, distances[i]);
        }
        return made;
    }
    void add_ours()
    {
        for (size_t i = 0; i < programs.size(); ++i) {
            const haptel_texture& texture = programs[i].program->textures()[0];
            Contender made = contender("haptel", variants[i].name, texture.height_gradient, binding.block);
            made.height = texture.height;
            if (variants[i].iterations_in_lanes) made.row.lane_form = "iterations";
            contenders.push_back(made);
            if (!texture.height_gradient_batch) continue;
            made = as_batch(std::move(made), texture.height_gradient_batch);
            made.row.lane_form = "points";
            made.row.lanes = jit::engine_info().batch_lanes;
            made.height_batch = texture.height_batch;
            contenders.push_back(std::move(made));
        }
    }
    // Of each kind of differences, the default step and the best.
    void add_plain()
    {
        std::vector<Contender> kept;
        std::map<std::string, size_t> best;
        for (const PlainMethod& method : plain->methods) {
            const PlainEntry& entry = *method.entry;
            Contender made = contender(entry.name, entry.is_f32 ? "f32" : "f64", entry.point, method.block);
            made.batch = entry.batch;
            made.row.level = method.level;
            made.row.flags = method.flags;
            made.row.step = method.step;
            made.row.is_best_step = method.step != 0 && method.step != default_step;
            const auto [place, is_new] = best.try_emplace(made.row.method + made.row.precision + made.row.level +
                                                              (made.row.is_best_step ? "" : "d"),
                                                          kept.size());
            if (is_new)
                kept.push_back(std::move(made));
            else if (made.row.errors[0].gradient_max < kept[place->second].row.errors[0].gradient_max)
                kept[place->second] = std::move(made);
        }
        for (Contender& made : kept) {
            contenders.push_back(made);
            contenders.push_back(as_batch(made, made.batch));
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
    // Nanoseconds per point of that part of the points, with the gradient or without.
    static double time_of(const Contender& one, Points& points, bool with_gradient, size_t first, size_t count)
    {
        const double whole_ms = processor_milliseconds([&] {
            if (one.row.is_batch)
                points.evaluate(with_gradient ? one.batch : one.height_batch, one.block, first, count);
            else
                one_by_one(with_gradient ? one.point : one.height, one.block, points, first, count);
        });
        return whole_ms * 1e6 / static_cast<double>(count);
    }
    // In rounds, so that whatever the machine does besides meets all alike. A batch is of a million points; of those a
    // slow way gets a part in each round, the next one in the next, so that a round ends in time.
    void measure(const std::function<void(double)>& progress)
    {
        Points points(quick ? 1 << 17 : 1'000'000, distances[0], 8);
        const double budget_ns = quick ? 1e6 : 10e6;
        for (Contender& one : contenders) {
            const size_t some = one.row.is_batch ? 4096 : 512;
            time_of(one, points, true, 0, some); // pages and caches
            const double wanted = budget_ns / time_of(one, points, true, 0, some);
            one.slice = std::clamp(static_cast<size_t>(one.row.is_batch ? wanted : wanted / 5), some, points.size());
        }
        const size_t rounds = quick ? 5 : 21;
        for (size_t round = 0; round < rounds; ++round) {
            progress(static_cast<double>(round) / static_cast<double>(rounds));
            for (Contender& one : contenders) {
                const size_t slices = points.size() / one.slice, first = round % slices * one.slice;
                one.times_ns.push_back(time_of(one, points, true, first, one.slice));
                if (one.row.is_batch ? one.height_batch != nullptr : one.height != nullptr)
                    one.height_times_ns.push_back(time_of(one, points, false, first, one.slice));
            }
        }
        for (Contender& one : contenders) {
            const Times times = summary(one.times_ns);
            one.row.median_ns = times.median;
            one.row.p99_ns = times.p99;
            one.row.height_only_ns = summary(one.height_times_ns).median;
        }
    }
};

} // namespace

std::vector<AccuracyRow> bench_accuracy(bool quick, const std::function<void(double)>& progress)
{
    std::vector<AccuracyRow> rows;
    for (size_t i = 0; i < std::size(cases); ++i) {
        std::vector<AccuracyRow> of_case = CaseBench(cases[i], quick).rows([&](double share) {
            progress((static_cast<double>(i) + share) / std::size(cases));
        });
        std::move(of_case.begin(), of_case.end(), std::back_inserter(rows));
    }
    progress(1);
    return rows;
}

} // namespace haptel::bench
