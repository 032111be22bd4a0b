// Things sorted by a number that each has, such as the corners of faces by their vertex, in a time that grows with
// them: what a comparing sort of millions takes most of its time for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptel::runtime {

class ByNumber {
public:
    static constexpr uint32_t none = ~0u;

    // Of the things 0 .. things - 1; number_of(thing) is below `numbers`, or `none` of those left out.
    template <class NumberOf>
    ByNumber(std::size_t numbers, std::size_t things, NumberOf&& number_of) : begin_(numbers + 1)
    {
        for (uint32_t thing = 0; thing < things; ++thing)
            if (const uint32_t number = number_of(thing); number != none) ++begin_[number];
        uint32_t sum = 0;
        for (uint32_t& begin : begin_) begin = sum += begin; // the end, from which each thing steps back
        things_.resize(sum);
        for (auto thing = static_cast<uint32_t>(things); thing-- > 0;)
            if (const uint32_t number = number_of(thing); number != none) things_[--begin_[number]] = thing;
    }

    std::size_t numbers() const { return begin_.size() - 1; }
    // Those of one number, in rising order.
    std::span<uint32_t> of(std::size_t number)
    {
        return {things_.data() + begin_[number], things_.data() + begin_[number + 1]};
    }
    std::span<const uint32_t> of(std::size_t number) const { return const_cast<ByNumber*>(this)->of(number); }

private:
    std::vector<uint32_t> begin_, things_;
};

} // namespace haptel::runtime
