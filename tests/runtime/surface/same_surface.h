// Whether two surfaces are the same to the last bit, field by field.
#pragma once

#include "runtime/surface/box_tree.h"
#include "runtime/surface/surface.h"

#include <cstring>
#include <string>
#include <vector>

namespace haptel::test {

template <class Value>
bool same_bits(const Value& a, const Value& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0; // of what has no padding
}

// The first field that differs; empty: none does.
inline std::string first_difference(const runtime::Surface& a, const runtime::Surface& b)
{
    const auto differ = [](const auto& of_a, const auto& of_b, const auto& same) {
        if (of_a.size() != of_b.size()) return true;
        for (size_t i = 0; i < of_a.size(); ++i)
            if (!same(of_a[i], of_b[i])) return true;
        return false;
    };
    const auto bits = [](const auto& x, const auto& y) { return same_bits(x, y); };
    if (differ(a.vertices, b.vertices, bits)) return "vertices";
    if (differ(a.faces, b.faces, [](const runtime::Face& x, const runtime::Face& y) {
            return x.vertex == y.vertex && x.link == y.link && x.fan_or_part == y.fan_or_part &&
                   same_bits(x.normal, y.normal);
        }))
        return "faces";
    if (differ(a.fans, b.fans, [](const runtime::Fan& x, const runtime::Fan& y) {
            return same_bits(x.normal, y.normal) && x.start == y.start && x.next == y.next;
        }))
        return "fans";
    if (differ(a.fan_parts, b.fan_parts, [](const runtime::FanPart& x, const runtime::FanPart& y) {
            return same_bits(x.normal, y.normal) && x.fan == y.fan;
        }))
        return "fan parts";
    if (differ(a.roundness, b.roundness, bits)) return "roundness";
    if (differ(a.uv, b.uv, bits) || differ(a.uv_of, b.uv_of, bits)) return "uv";
    for (const runtime::Surface* one : {&a, &b})
        if (!one->corner_uv.empty() || !one->smoothing_groups.empty()) return "what is for building alone";
    if (differ(a.origins, b.origins, bits)) return "origins";
    if (differ(a.tree->nodes(), b.tree->nodes(), bits)) return "tree";
    if (a.cuts_itself != b.cuts_itself) return "cuts itself";
    if (!same_bits(a.normal_turn_max_per_m, b.normal_turn_max_per_m)) return "turn of normals";
    if (!same_bits(a.lattice, b.lattice)) return "lattice";
    if (!same_bits(a.box_minimum_m, b.box_minimum_m) || !same_bits(a.box_maximum_m, b.box_maximum_m)) return "box_m";
    return {};
}

} // namespace haptel::test
