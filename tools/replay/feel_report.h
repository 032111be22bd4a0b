// What `haptel test` found out about each feel recording.
#pragma once

#include "tools/output/json.h"
#include "tools/replay/felt_difference.h"

#include <string>
#include <vector>

namespace haptel::tools {

struct TestedFeel {
    std::string file;
    FeltDifference difference = {};
    std::vector<std::string> objects = {};
    std::vector<ChangedFile> changed = {};
    std::string fault = {}; // why it could not be compared; empty: it was
    double seconds = 0;

    bool passed() const { return fault.empty() && difference.is_equal(); }
    std::vector<std::string> reasons() const; // what is wrong, a line each
};

Json to_json(const TestedFeel& feel);

// Empty where there is none.
std::string table_of(const std::vector<TestedFeel>& feels);

} // namespace haptel::tools
