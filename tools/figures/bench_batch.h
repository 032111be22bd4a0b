// The batch figures: the textures that paths name, and how their rows are shown.
#pragma once

#include "bench/batch_bench.h"
#include "tools/arguments/texture_argument.h"
#include "tools/output/json.h"

namespace haptel::tools {

struct BatchTextures {
    std::vector<bench::BatchTexture> textures;
    std::string error; // what did not compile or fit, as text to show; empty: all did
};
BatchTextures batch_textures(const std::vector<std::string>& paths, const ParameterTexts& parameters, double box_m,
                             jit::Precision precision);

std::string to_table(const std::vector<bench::BatchRow>& rows);
std::string to_csv(const std::vector<bench::BatchRow>& rows, const std::string& precision);
Json to_json(const bench::BatchRow& row, const std::string& precision);
Json to_json(const bench::BatchSummary& summary);

} // namespace haptel::tools
