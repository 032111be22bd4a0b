// Who belongs together, directly or by others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace haptel::runtime {

class Groups {
public:
    explicit Groups(std::size_t count) : first_(count) { std::iota(first_.begin(), first_.end(), 0u); }

    void unite(uint32_t one, uint32_t other)
    {
        const auto [low, high] = std::minmax({first(one), first(other)});
        first_[high] = low;
    }
    // Those of more than one, in rising order.
    std::vector<std::vector<uint32_t>> groups()
    {
        std::vector<std::vector<uint32_t>> all(first_.size());
        for (uint32_t i = 0; i < first_.size(); ++i) all[first(i)].push_back(i);
        std::erase_if(all, [](const auto& group) { return group.size() < 2; });
        return all;
    }

    bool are_together(uint32_t one, uint32_t other) { return first(one) == first(other); }
    uint32_t first(uint32_t i)
    {
        while (first_[i] != i) i = first_[i] = first_[first_[i]];
        return i;
    }

private:
    std::vector<uint32_t> first_;
};

} // namespace haptel::runtime
