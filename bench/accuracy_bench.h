// Error against time, for every way to get a height and a gradient: ours and plain C++.
#pragma once

#include "bench/timing.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

// Of one way, at coordinates within so many wavelengths of the origin, against the 113-bit oracle; shares of the
// largest height and of the largest gradient there.
struct Accuracy {
    double wavelengths = 0;
    double height_max = 0, height_rms = 0, gradient_max = 0, gradient_rms = 0;
};

struct AccuracyRow {
    std::string texture;
    bool is_batch = false; // many points, time per point; else one after the other, each waiting for the last
    std::string method;    // haptel, haptel_difference, cpp_analytic, cpp_dual, cpp_difference_2 | 4 | 6, cpp_sine_N
    std::string precision; // f64, mixed, f32
    std::string level;     // of the instruction set it was compiled for: x86-64, x86-64-v3 ...; ours: HAPTEL_ISA
    std::string flags;     // of plain C++
    std::string lane_form; // what lanes hold: one (nothing), iterations (of a loop for one point), points
    uint32_t lanes = 1;    // of points
    double step = 0;       // of differences, in wavelengths
    bool is_best_step = false;
    double median_ns = 0, p99_ns = 0;
    double height_only_ns = 0;    // ours: the entry without the gradient; 0: not measured
    std::vector<Accuracy> errors; // near, then farther
    bool is_on_frontier = false;  // no other way of this texture and mode is both faster and closer (near)

    bool is_ours() const { return method == "haptel"; }
    bool is_plain() const { return method.starts_with("cpp_"); }
    bool is_difference() const { return method.find("difference") != std::string::npos; }
};

// `progress` is called now and then with what has been done of the whole, 0 .. 1.
std::vector<AccuracyRow> bench_accuracy(bool quick, const std::function<void(double)>& progress);

} // namespace haptel::bench
