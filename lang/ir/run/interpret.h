// The slow, plain evaluator: the oracle that every other engine is compared with.
//
// Over double it gives the same bits as f64 code (elementary functions too, see elementary_number.h); over Quad it
// is the truth to about 34 digits, with branches and cells decided at that precision. It walks the blocks as they are:
// what `verify` says of their depth bounds its recursion.
#pragma once

#include "lang/ir/ir.h"
#include "lang/ir/semantics.h"

#include <span>
#include <unordered_set>
#include <vector>

namespace haptel::ir {

// What an entry reads. Real numbers of one evaluation: T is double or Quad (quad.h).
template <typename T>
struct EntryInputs {
    T input[input_count] = {};
    std::vector<Slot<T>> parameters; // by index in Texture::parameters
};

// Of one module, which must be verified and must not change meanwhile; prepared once, so that no evaluation allocates.
// For one thread.
template <typename T>
class Interpreter {
public:
    explicit Interpreter(const Module& module);

    // `inputs` may be null for functions that are not entries. The results stay valid until the next run.
    std::span<const Slot<T>> run(uint32_t function, std::span<const Slot<T>> arguments, const EntryInputs<T>* inputs);

    // Digest of every discrete choice of the last run: comparisons, cells, sides of abs, min and max. Two points of one
    // smooth piece of a texture have equal digests. Recorded only after watch_decisions(true).
    void watch_decisions(bool on) { watching = on; }
    uint64_t decisions() const { return digest; }

    // Of these operations operands and result are rounded to f64, as code rounds them, while all others keep the digits
    // of T. Null: of none. They must outlive the runs.
    using Operations = std::unordered_set<const Instruction*>;
    void round_to_f64(const Operations* operations) { rounded = operations; }

private:
    struct Frame;

    const Module& module;
    std::vector<size_t> depths; // by function: slots of its frame and of the deepest chain of calls below it
    std::vector<Slot<T>> slots, results;
    const EntryInputs<T>* entry_inputs = nullptr;
    const Operations* rounded = nullptr;
    bool watching = false;
    uint64_t digest = 0;
};

} // namespace haptel::ir
