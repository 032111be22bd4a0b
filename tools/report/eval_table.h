// Points from a CSV file: the columns x, y and z, metres, wherever they stand; what else a row holds is kept as text.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace haptel::tools {

struct PointTable {
    struct Row {
        std::string text; // the whole row as written
        glm::dvec3 p_m{0};
    };
    std::string header; // "x,y,z" where the file has none
    std::vector<Row> rows;
    std::string error; // "points.csv:3: expected ..., found ..."; empty: none
};

// Without a header the first three columns count. Empty lines are left out; line ends of either kind.
PointTable read_points(const std::string& file);

} // namespace haptel::tools
