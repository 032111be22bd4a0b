#include "lang/ir/extent.h"

namespace haptel::ir {
namespace {

// Adds the block's calls to `reached`, and tells its instructions.
size_t count(const Block& block, std::vector<bool>& reached)
{
    size_t sum = 0;
    for_each_instruction(block, [&](const Instruction& made) {
        ++sum;
        if (auto* call = std::get_if<Call>(&made.kind)) reached[call->function] = true;
    });
    return sum;
}

size_t walk(const Module& module, std::vector<bool>& reached)
{
    size_t sum = 0;
    for (size_t i = reached.size(); i-- > 0;) // callees stand before their callers
        if (reached[i]) sum += count(module.functions[i].body, reached);
    return sum;
}

std::vector<bool> only(uint32_t function)
{
    std::vector<bool> reached(size_t{function} + 1, false);
    reached.back() = true;
    return reached;
}

} // namespace

std::vector<bool> reached_from(const Module& module, uint32_t function)
{
    std::vector<bool> reached = only(function);
    walk(module, reached);
    return reached;
}

size_t instructions_reached(const Module& module, uint32_t function)
{
    std::vector<bool> reached = only(function);
    return walk(module, reached);
}

} // namespace haptel::ir
