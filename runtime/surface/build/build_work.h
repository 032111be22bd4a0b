// What building a surface may cost. Most steps take a time that grows with the triangles; some look at what lies near
// each other, and of a mesh whose parts all lie in one place that is everything with everything. Such steps count what
// they look at, and end when it is too much: a mesh that would load for hours is refused in seconds.
//
// It is also where building looks up: tells what it does, and sees whether it is to stop. Internal to the runtime.
#pragma once

#include "runtime/surface/loading.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace haptel::runtime {

class BuildWork {
public:
    // A look takes about twenty nanoseconds. Scanned and modelled meshes take twenty to forty for each triangle. The
    // fans that close a cylinder of 8000 sides take 130 million, as each of their edges comes near all of them.
    static constexpr std::size_t looks_min = 150'000'000, looks_per_triangle = 120;

    // A look of joining holds an edge against a triangle, some 140 nanoseconds: that is two seconds.
    static constexpr std::size_t looks_of_joining = 14'000'000;

    // `loading` may be null, else it is to outlive this.
    explicit BuildWork(std::size_t triangles, const Loading* loading = nullptr)
        : looks_max_(std::max(looks_min, looks_per_triangle * triangles)), loading_(loading)
    {
    }
    static constexpr struct OfJoining {
    } of_joining{};
    BuildWork(OfJoining, const Loading* loading) : looks_max_(looks_of_joining), loading_(loading) {}

    // What follows, in words that complete "to find ...". False: it is over.
    bool begin(std::string_view to_find)
    {
        if (over_) return false; // the step that it ended in is told
        to_find_ = to_find;
        look_up();
        return !over_;
    }
    // So many things were looked at. False: it is over. Any thread may ask.
    bool spend(std::size_t looks = 1) noexcept
    {
        if (looks_.fetch_add(looks, std::memory_order_relaxed) + looks >= next_look_up_) look_up();
        return !over_;
    }
    // The looks of one of several threads, told in lots, as they would wait for each other.
    class Share {
    public:
        explicit Share(BuildWork& work) : work_(work) {}
        ~Share() { work_.spend(looks_); }
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;
        bool spend(std::size_t looks = 1) noexcept
        {
            constexpr std::size_t lot = 1 << 10;
            looks_ += looks;
            return looks_ < lot ? !work_.over() : work_.spend(std::exchange(looks_, 0));
        }

    private:
        BuildWork& work_;
        std::size_t looks_ = 0;
    };
    bool over() const { return over_; }
    unsigned threads() const { return loading_ ? loading_->threads : 0; }
    std::size_t looks() const { return looks_; }

    std::string error() const; // why it is over; empty: it is not

private:
    void look_up() noexcept;

    std::atomic<std::size_t> looks_ = 0, next_look_up_ = 0;
    std::size_t looks_max_;
    const Loading* loading_;
    std::thread::id loads_ = std::this_thread::get_id();
    std::string_view to_find_;
    std::atomic<bool> over_ = false, stopped_ = false;
};

} // namespace haptel::runtime
