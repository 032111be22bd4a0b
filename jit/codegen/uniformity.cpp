#include "jit/codegen/uniformity.h"

#include <algorithm>

namespace haptel::jit {

namespace {

class Analysis {
public:
    // `loops` null: between points.
    Analysis(const ir::Function& function, const std::vector<bool>& parameters, const LaneLoops* loops)
        : varies(function.value_types.size()), lane_loops(loops)
    {
        for (size_t i = 0; i < parameters.size(); ++i) varies[function.parameters[i].index] = parameters[i];
        block(function.body);
    }
    std::vector<bool> varies;

private:
    const LaneLoops* const lane_loops;
    const std::vector<bool>* waits = nullptr; // of the lane loop that is looked at, if it is split

    bool is_varying(ir::Value value) const { return varies[value.index]; }
    bool is_any_varying(const std::vector<ir::Value>& values) const
    {
        return std::any_of(values.begin(), values.end(), [&](ir::Value value) { return is_varying(value); });
    }
    void set(ir::Value value, bool varying) { varies[value.index] = varying && !(waits && (*waits)[value.index]); }

    void block(const ir::Block& from)
    {
        for (const ir::Instruction& made : from.instructions)
            std::visit([&](const auto& kind) { visit(made, kind); }, made.kind);
    }
    template <typename Kind>
    void visit(const ir::Instruction& made, const Kind&)
    {
        const bool varying = is_any_varying(made.operands);
        for (ir::Value result : made.results) set(result, varying);
    }
    void visit(const ir::Instruction& made, const ir::ReadInput& read)
    {
        set(made.results[0], !lane_loops && read.input < ir::Input::center_x);
    }
    void visit(const ir::Instruction& made, const ir::If& choice)
    {
        for (const ir::Block& arm : choice.arms) block(arm);
        for (size_t i = 0; i < made.results.size(); ++i)
            set(made.results[i], is_varying(made.operands[0]) || is_varying(choice.arms[0].yields[i]) ||
                                     is_varying(choice.arms[1].yields[i]));
    }
    // What one iteration makes vary varies in the next, until nothing changes. Nothing that varies is ever taken back,
    // so that loops in loops need few passes.
    void visit(const ir::Instruction& made, const ir::For& loop)
    {
        const ir::Block& body = loop.body[0];
        if (lane_loops && lane_loops->contains(&loop)) return side_by_side(body, lane_loops->at(&loop));
        for (size_t i = 1; i < body.parameters.size(); ++i)
            if (is_varying(made.operands[0]) || is_varying(made.operands[i])) set(body.parameters[i], true);
        for (bool changed = true; changed;) {
            block(body);
            changed = false;
            for (size_t i = 1; i < body.parameters.size(); ++i) {
                if (is_varying(body.parameters[i]) || !is_varying(body.yields[i - 1])) continue;
                set(body.parameters[i], true);
                changed = true;
            }
        }
        for (size_t i = 0; i < made.results.size(); ++i) set(made.results[i], is_varying(body.parameters[i + 1]));
    }
    // Its results are one for all iterations.
    void side_by_side(const ir::Block& body, const LaneLoop& loop)
    {
        waits = loop.waits.empty() ? nullptr : &loop.waits;
        set(body.parameters[0], true);
        for (size_t i = 0; i < loop.carried.size(); ++i)
            set(body.parameters[i + 1], loop.carried[i].kind != Carried::Kind::kept);
        block(body);
        waits = nullptr;
    }
};

} // namespace

std::vector<bool> varying_values(const ir::Function& function, const std::vector<bool>& parameters)
{
    return Analysis(function, parameters, nullptr).varies;
}

std::vector<bool> varying_iterations(const ir::Function& function, const std::vector<bool>& parameters,
                                     const LaneLoops& loops)
{
    return Analysis(function, parameters, &loops).varies;
}

} // namespace haptel::jit
