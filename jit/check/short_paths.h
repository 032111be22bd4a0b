// How heights and gradients change along short paths: class, slope and curvature as measured, and jumps with their
// place.
//
// A path is halved into the half with the greater change, again and again: at a jump or kink the change stays, else it
// is halved as well.
#pragma once

#include "jit/check/check_points.h"
#include "lang/abi/texture_binding.h"

#include <cstdint>
#include <optional>

namespace haptel::jit {

struct Jump {
    double height_m; // > 0: from one side to the other
    double p_m[3];   // where, to 2^-26 of the path
    double time_s;   // when
};

class ShortPaths {
public:
    ShortPaths(const TextureBinding& texture, const CheckPoints& where) : binding(texture), points(where) {}

    struct Worst {
        double size = 0, p_m[3] = {};
        void meet(double other, const double (&at_m)[3]);
    };
    uint64_t too_steep = 0, too_curved = 0; // places beyond the binding's facts
    Worst steepest, most_curved;            // of them; per metre the latter
    uint32_t roughest = HAPTEL_CONTINUITY_C1;
    double roughest_p_m[3] = {};
    std::optional<Jump> highest_jump;

    // The path of that number, so long as this share of the way between two random places; and whether by heights
    // alone.
    void follow(uint64_t index, double share, bool by_height_alone = false);

private:
    struct Touch {
        haptel_point point;
        haptel_sample sample;
    };
    const TextureBinding& binding;
    const CheckPoints& points;
    double largest_height = 0, largest_gradient = 0;

    Touch touch(const double (&p_m)[3]);
    void halve(Touch a, Touch b, bool by_height);
};

// The highest jump that many paths of several lengths meet; nothing where none does, which proves nothing.
std::optional<Jump> find_jump(const TextureBinding& binding, const CheckBox& box);

} // namespace haptel::jit
