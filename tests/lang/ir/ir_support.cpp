#include "tests/lang/ir/ir_support.h"

namespace ir_test {

std::optional<std::vector<Quad>> difference(Interpreter<Quad>& oracle, uint32_t function,
                                            std::vector<Slot<Quad>> arguments, size_t which)
{
    oracle.watch_decisions(true);
    const Quad at = arguments[which].real;
    std::optional<uint64_t> decisions;
    bool is_smooth = true;
    auto values = [&](const Quad& offset) {
        arguments[which].real = at + offset;
        std::vector<Quad> reals;
        for (const Slot<Quad>& slot : oracle.run(function, arguments, nullptr)) {
            reals.push_back(slot.real);
            is_smooth &= semantics::is_finite(slot.real);
        }
        is_smooth &= decisions.value_or(oracle.decisions()) == oracle.decisions();
        decisions = oracle.decisions();
        return reals;
    };
    const Quad h = 0x1p-28;
    auto up = values(h), down = values(-h), half_up = values(h / 2), half_down = values(-h / 2);
    values(0);
    if (!is_smooth) return std::nullopt;
    std::vector<Quad> slopes;
    for (size_t i = 0; i < up.size(); ++i) {
        Quad coarse = (up[i] - down[i]) / (2 * h), fine = (half_up[i] - half_down[i]) / h;
        slopes.push_back((4 * fine - coarse) / 3);
    }
    return slopes;
}

} // namespace ir_test
