// The accuracy figures as they are shown: table, JSON, CSV, picture.
#pragma once

#include "bench/accuracy_bench.h"
#include "tools/output/json.h"
#include "tools/plot/plot_picture.h"

namespace haptel::tools {

std::string to_table(const std::vector<bench::AccuracyRow>& rows);
std::string to_csv(const std::vector<bench::AccuracyRow>& rows);
Json to_json(const bench::AccuracyRow& row);
// Errors near the origin over time, largest and rms, a panel for each texture, one point and many.
enum class Shown : uint8_t { height, gradient };
plot::Picture draw_accuracy(const std::vector<bench::AccuracyRow>& rows, Shown shown, const std::string& subtitle);

} // namespace haptel::tools
