#include "tools/figures/bench_batch.h"

#include "tools/arguments/texture_files.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace haptel::tools {

BatchTextures batch_textures(const std::vector<std::string>& paths, const ParameterTexts& parameters, double box_m,
                             jit::Precision precision)
{
    BatchTextures found;
    TextureRequest request = request_in_cube(box_m);
    jit::TextureOptions options;
    options.entries = jit::Entries::both_and_batches;
    options.effort = jit::Effort::full;
    options.precision = precision;
    for (const TextureTarget& target : texture_targets(paths)) {
        options.only_texture = target.texture;
        const jit::CompiledTextures compiled = jit::compile_texture_file(target.file, options);
        if (!compiled.program) {
            found.error += compiled.rendered();
            continue;
        }
        for (const haptel_texture& texture : compiled.program->textures()) {
            if (!texture.height_batch || !texture.height_gradient_batch) continue;
            request.parameters = values_for(compiled.program->source_of(texture), parameters);
            const TextureResult bound = jit::make_binding(compiled.program, texture.name, request, jit::For::figures);
            if (bound.binding)
                found.textures.push_back({std::filesystem::path(target.file).filename().string() + ":" + texture.name,
                                          compiled.program, *bound.binding});
            else
                found.error += bound.diagnostics;
        }
    }
    return found;
}

std::string to_table(const std::vector<bench::BatchRow>& rows)
{
    std::string text = fmt::format("{:<40} {:>7} {:>9} {:>9} {:>9} {:>9} {:>7} {:>9}\n", "texture", "threads", "h ns",
                                   "p99", "h+g ns", "p99", "h+g / h", "x faster");
    double first_ns = 0; // of the texture's first row
    for (size_t i = 0; i < rows.size(); ++i) {
        const bench::BatchRow& row = rows[i];
        const bool is_first = i == 0 || rows[i - 1].texture != row.texture;
        if (is_first) first_ns = row.with_gradient_ns.median;
        text += fmt::format("{:<40} {:>7} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>7.2f} {:>9}\n",
                            is_first ? row.texture : "", row.threads, row.height_only_ns.median, row.height_only_ns.p99,
                            row.with_gradient_ns.median, row.with_gradient_ns.p99, row.gradient_over_height(),
                            is_first ? "" : fmt::format("{:.2f}", first_ns / row.with_gradient_ns.median));
    }
    for (const bench::BatchSummary& all : bench::summary(rows))
        text += fmt::format("geometric mean over the textures, {} thread{}: h+g / h {:.2f}, {:.2f} times as fast\n",
                            all.threads, all.threads == 1 ? "" : "s", all.gradient_over_height, all.over_one_thread);
    return text + "h: height alone; h+g: height with gradient; ns per point\n";
}

std::string to_csv(const std::vector<bench::BatchRow>& rows, const std::string& precision)
{
    std::string text = "texture,precision,lanes,threads,ns_per_point,ns_per_point_p99,"
                       "height_only_ns_per_point,height_only_ns_per_point_p99,gradient_over_height\n";
    for (const bench::BatchRow& row : rows)
        text += fmt::format("{},{},{},{},{},{},{},{},{}\n", row.texture, precision, row.lanes, row.threads,
                            row.with_gradient_ns.median, row.with_gradient_ns.p99, row.height_only_ns.median,
                            row.height_only_ns.p99, row.gradient_over_height());
    return text;
}

Json to_json(const bench::BatchRow& row, const std::string& precision)
{
    return {{"texture", row.texture},
            {"precision", precision},
            {"lanes", row.lanes},
            {"threads", row.threads},
            {"ns_per_point", row.with_gradient_ns.median},
            {"ns_per_point_p99", row.with_gradient_ns.p99},
            {"height_only_ns_per_point", row.height_only_ns.median},
            {"height_only_ns_per_point_p99", row.height_only_ns.p99},
            {"gradient_over_height", row.gradient_over_height()}};
}

Json to_json(const bench::BatchSummary& summary)
{
    return {{"threads", summary.threads},
            {"gradient_over_height", summary.gradient_over_height},
            {"over_one_thread", summary.over_one_thread}};
}

} // namespace haptel::tools
