// A fan and the parts that creases leave of it, from one of its corners.
#pragma once

#include "runtime/surface/corner.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptel::runtime {

// Of some vertices. Numbers are indices here, with Surface::is_part of parts.
struct SomeFans {
    std::vector<Fan> fans;
    std::vector<FanPart> parts;

    uint32_t fan_of(uint32_t number) const
    {
        return number & Surface::is_part ? parts[number & ~Surface::is_part].fan : number;
    }
};

class FanMaker {
public:
    FanMaker(Surface& surface, double crease_deg, SomeFans& to);

    // Of all faces that are linked with the corner; each is told its number.
    void make(const Sector& start);

private:
    void walk(const Sector& start);
    bool is_crease(const Sector& a, const Sector& b) const;
    void tell(std::size_t begin, std::size_t end, uint32_t number);
    glm::dvec3 mean(std::size_t begin, std::size_t end) const;

    Surface& surface_;
    double crease_rad_, crease_cosine_;
    SomeFans& to_;
    std::vector<Sector> sectors_; // in the order in which they lie around the vertex
    bool closed_ = false;
};

} // namespace haptel::runtime
