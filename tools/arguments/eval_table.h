// Points from a CSV file: the columns x, y and z, lengths ("1mm", or a bare number of metres), wherever they stand;
// what else a row holds is kept as text.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <fstream>
#include <string>
#include <vector>

namespace haptel::tools {

// A regular file of any size: what is not asked for is not read. Without a header the first three columns count. Empty
// lines are left out; line ends of either kind.
class PointTable {
public:
    struct Row {
        std::string text; // the whole row as written
        glm::dvec3 p_m{0};
    };

    explicit PointTable(std::string file);
    std::vector<Row> next(size_t count);                // at most so many; none: the end, or an error
    const std::string& header() const { return head_; } // behind the first rows; "x,y,z" where the file has none
    const std::string& error() const { return error_; } // "points.csv:3: expected ..., found ..."; empty: none

private:
    bool read_line(Row& row); // false: an empty line, a header or an error
    void report_end();

    std::string file_, head_, error_;
    std::ifstream in_;
    std::vector<char> buffer_;
    size_t number_ = 0; // of the line
    size_t width_ = 0;  // cells of the first line, and of every other
    std::array<size_t, 3> columns_ = {0, 1, 2};
};

} // namespace haptel::tools
