#include "runtime/surface/build/build_work.h"

#include <algorithm>

namespace haptel::runtime {

void BuildWork::look_up() noexcept
{
    constexpr std::size_t looks_between = 1 << 16; // about a millisecond
    next_look_up_ = std::min(looks_ + looks_between, looks_max_);
    if (loading_ && loading_->tell && std::this_thread::get_id() == loads_) loading_->tell(to_find_);
    if (loading_ && loading_->stopped()) stopped_ = true;
    if (stopped_ || looks_ >= looks_max_) over_ = true;
}

std::string BuildWork::error() const
{
    if (!over_) return {};
    if (stopped_) return std::string(loading_was_stopped);
    return "too much of it lies in one place: to find " + std::string(to_find_) + " takes more than " +
           std::to_string(looks_max_ / 1'000'000) +
           " million steps. Take out parts that lie on or through each other, and vertices that thousands of "
           "triangles share";
}

} // namespace haptel::runtime
