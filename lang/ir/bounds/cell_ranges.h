// The values of a table between two of its cells, as one interval, without a look at each.
#pragma once

#include "lang/ir/bounds/interval.h"
#include "lang/ir/ir.h"

#include <vector>

namespace haptel::ir {

class CellRanges {
public:
    explicit CellRanges(const Table& table);
    Interval over(size_t first_cell, size_t last_cell) const; // both inclusive, and in the table

private:
    const Table& table;
    std::vector<Interval> tree; // of blocks of cells: node i joins 2 i and 2 i + 1, the leaves are in the upper half
};

} // namespace haptel::ir
