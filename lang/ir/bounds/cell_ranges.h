// The values of a table between two of its cells, as one interval, without a look at each.
#pragma once

#include "lang/ir/bounds/interval.h"
#include "lang/ir/ir.h"

#include <vector>

namespace haptel::ir {

class CellRanges {
public:
    explicit CellRanges(const Table& table) : tree(2 * size_t{table.size()}, no_value)
    {
        const size_t cells = table.size();
        for (size_t i = 0; i < cells; ++i)
            tree[cells + i] =
                table.element == Type::real ? exactly(table.reals[i]) : exactly(table.element, table.words[i]);
        for (size_t node = cells; node-- > 1;) tree[node] = join(tree[2 * node], tree[2 * node + 1]);
    }
    // Both inclusive, and in the table.
    Interval over(size_t first_cell, size_t last_cell) const
    {
        Interval all = no_value;
        size_t from = tree.size() / 2 + first_cell, to = tree.size() / 2 + last_cell + 1;
        for (; from < to; from /= 2, to /= 2) {
            if (from % 2 == 1) all = join(all, tree[from++]);
            if (to % 2 == 1) all = join(all, tree[--to]);
        }
        return all;
    }

private:
    std::vector<Interval> tree; // node i joins 2 i and 2 i + 1; the cells are the upper half
};

} // namespace haptel::ir
