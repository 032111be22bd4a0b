// Which values can have a tangent, found from structure alone before any code is made: loops and the two arms of an
// `if` must agree on what they yield.
#pragma once

#include "lang/ir/ir.h"

#include <span>
#include <vector>

namespace haptel::ir {

// One bit per value of a function and direction.
class Activity {
public:
    Activity(size_t values, size_t directions) : width(directions), bits(values * directions, false) {}
    size_t directions() const { return width; }
    bool operator()(Value value, size_t direction) const { return bits[value.index * width + direction]; }
    bool any(Value value) const;
    bool set(Value value, size_t direction); // true if that is new
    void clear(Value value);

private:
    size_t width;
    std::vector<bool> bits;
};

// dependence[result][parameter]: may the derivative of the result with respect to the parameter differ from zero?
using Dependence = std::vector<std::vector<bool>>;

// What becomes of derivatives with respect to the point: they stay, and have derivatives of their own; or they become
// the values they stand for, and count as constants.
enum class PointDerivatives : uint8_t { vary, resolved };

// The dependences of all functions of a module, worked out as they are asked for.
class Dependences {
public:
    explicit Dependences(const Module& whole, PointDerivatives what = PointDerivatives::vary)
        : point_derivatives(what), module(whole)
    {
    }
    const Dependence& of(uint32_t function);

    const PointDerivatives point_derivatives;

private:
    const Module& module;
    std::vector<Dependence> known; // by function
};

// Spreads what is set (parameters) to all values; inputs of the point are active where `input_is_active` says so, and
// parameters of the texture, by their index, in a direction each.
using InputActivity = bool (*)(Input input, size_t direction);
void propagate(const Function& function, Dependences& callees, InputActivity input_is_active, Activity& activity,
               std::span<const uint32_t> of_texture = {});

} // namespace haptel::ir
