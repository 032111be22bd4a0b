// The compile figures as they are shown.
#pragma once

#include "bench/compile_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

// Each texture in this process and in fresh ones, which run this command.
std::vector<bench::CompileRow> compile_rows(bool quick);
// Of the texts in these files. `error`: why there are none.
std::vector<bench::CompileRow> edit_rows(const std::vector<std::string>& paths, bool quick, std::string& error);
std::string to_table(const std::vector<bench::CompileRow>& rows);
std::string growth_line(const std::vector<bench::CompileRow>& rows); // of compile_rows()
std::string to_csv(const std::vector<bench::CompileRow>& rows);      // a time that could not be had: an empty cell
Json to_json(const bench::CompileRow& row);

} // namespace haptel::tools
