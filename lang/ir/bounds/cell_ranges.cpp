#include "lang/ir/bounds/cell_ranges.h"

#include "lang/ir/int_range.h"

#include <cmath>

namespace haptel::ir {
namespace {

constexpr size_t block_size = 16; // cells of a leaf: the tree is an eighth of the table, and a look takes some 50 steps

Interval cell(const Table& table, size_t index)
{
    if (table.element == Type::real)
        return std::isnan(table.reals[index]) ? Interval{infinity, -infinity, true}
                                              : Interval{table.reals[index], table.reals[index]};
    const IntRange range = constant_range(table.element, table.words[index]);
    return {static_cast<double>(range.minimum), static_cast<double>(range.maximum)};
}

} // namespace

CellRanges::CellRanges(const Table& whole) : table(whole)
{
    const size_t blocks = (table.size() + block_size - 1) / block_size;
    tree.assign(2 * blocks, no_value);
    for (size_t i = 0; i < table.size(); ++i) {
        Interval& block = tree[blocks + i / block_size];
        block = join(block, cell(table, i));
    }
    for (size_t node = blocks; node-- > 1;) tree[node] = join(tree[2 * node], tree[2 * node + 1]);
}

Interval CellRanges::over(size_t first, size_t last) const
{
    Interval all = no_value;
    for (; first <= last && first % block_size != 0; ++first) all = join(all, cell(table, first));
    for (; first <= last && (last + 1) % block_size != 0; --last) all = join(all, cell(table, last));
    if (first > last) return all;
    const size_t blocks = tree.size() / 2;
    size_t from = blocks + first / block_size, to = blocks + (last + 1) / block_size;
    for (; from < to; from /= 2, to /= 2) {
        if (from % 2 == 1) all = join(all, tree[from++]);
        if (to % 2 == 1) all = join(all, tree[--to]);
    }
    return all;
}

} // namespace haptel::ir
