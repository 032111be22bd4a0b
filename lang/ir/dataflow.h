// What follows from what in a function, found by walking it until nothing is new: forwards from what values are made
// of, or backwards from what they are used for.
//
// The walk knows the structure: the two arms of an `if` flow together in its results, a loop hands what it carries to
// its next iteration, again and again. What is known of a value, and what an instruction without blocks does to it, is
// the analysis's. Knowledge must only grow, so that every walk ends; what a function that is called does is told by its
// own walk, which comes first, as callees stand before their callers.
#pragma once

#include "lang/ir/ir.h"

#include <ranges>

namespace haptel::ir {

// An analysis is a class with
//   bool flow(from, to)      what is known of the one holds for the other too; whether that is new there
//   void visit(instruction)  of an instruction without blocks
//   void steer(condition, result)  of an `if` or, by its trip count, of a loop
//   void assume(carried)     called of every value that a loop carries once `rounds_max` rounds were not enough: the
//                            most that could be known, so that long chains of such values cost no quadratic time
//   rounds_max               UINT32_MAX: as many as it takes
template <typename Analysis>
class Dataflow {
public:
    explicit Dataflow(Analysis& what) : analysis(what) {}

    void forwards(const Block& block) const
    {
        for (const Instruction& made : block.instructions) {
            if (const auto* choice = std::get_if<If>(&made.kind)) {
                for (const Block& arm : choice->arms) {
                    forwards(arm);
                    for (size_t i = 0; i < made.results.size(); ++i) analysis.flow(arm.yields[i], made.results[i]);
                }
                for (Value result : made.results) analysis.steer(made.operands[0], result);
            } else if (const auto* loop = std::get_if<For>(&made.kind)) {
                forwards(made, loop->body[0]);
            } else {
                analysis.visit(made);
            }
        }
    }

    // From the last instruction: a block's uses are all seen before their makers.
    void backwards(const Block& block) const
    {
        for (const Instruction& made : block.instructions | std::views::reverse) {
            if (const auto* choice = std::get_if<If>(&made.kind)) {
                for (Value result : made.results) analysis.steer(made.operands[0], result);
                for (const Block& arm : choice->arms) {
                    for (size_t i = 0; i < made.results.size(); ++i) analysis.flow(made.results[i], arm.yields[i]);
                    backwards(arm);
                }
            } else if (const auto* loop = std::get_if<For>(&made.kind)) {
                backwards(made, loop->body[0]);
            } else {
                analysis.visit(made);
            }
        }
    }

private:
    Analysis& analysis;

    void forwards(const Instruction& made, const Block& body) const
    {
        for (size_t i = 0; i < made.results.size(); ++i) {
            analysis.flow(made.operands[i + 1], body.parameters[i + 1]);
            analysis.steer(made.operands[0], body.parameters[i + 1]);
        }
        bool is_new = true;
        for (uint32_t round = 0; is_new; ++round) {
            if (round == Analysis::rounds_max) assume_all(body);
            forwards(body);
            is_new = false;
            for (size_t i = 0; i < made.results.size(); ++i)
                is_new |= analysis.flow(body.yields[i], body.parameters[i + 1]);
        }
        for (size_t i = 0; i < made.results.size(); ++i) analysis.flow(body.parameters[i + 1], made.results[i]);
    }

    void backwards(const Instruction& made, const Block& body) const
    {
        for (uint32_t round = 0;; ++round) {
            if (round == Analysis::rounds_max) assume_all(body);
            bool is_new = round == 0;
            for (size_t i = 0; i < made.results.size(); ++i) {
                is_new |= analysis.flow(made.results[i], body.parameters[i + 1]);
                is_new |= analysis.flow(body.parameters[i + 1], body.yields[i]);
                analysis.flow(body.parameters[i + 1], made.results[i]); // so that the two are always known alike
            }
            if (!is_new) break;
            backwards(body);
        }
        for (size_t i = 0; i < made.results.size(); ++i) {
            analysis.flow(body.parameters[i + 1], made.operands[i + 1]);
            analysis.steer(made.operands[0], made.results[i]);
        }
    }

    void assume_all(const Block& body) const
    {
        for (size_t i = 1; i < body.parameters.size(); ++i) analysis.assume(body.parameters[i]);
    }
};

} // namespace haptel::ir
