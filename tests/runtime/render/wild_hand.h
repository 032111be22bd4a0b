// A hand that behaves as badly as it can: jumps, strolls, poses exactly on vertices, edges and faces, to and fro
// through them, exactly along edges and axes.
#pragma once

#include "runtime/surface/surface.h"

#include <cmath>
#include <random>

namespace haptel::test {

class WildHand {
public:
    WildHand(const runtime::Surface& surface, uint64_t seed)
        : surface_(surface)
        , random_(seed)
        , centre_(surface.lattice.centre_m)
        , size_(0.5 * glm::length(surface.box_maximum_m - surface.box_minimum_m))
        , hand_(outside())
    {
    }

    glm::dvec3 outside() const { return centre_ + glm::dvec3(3, 0.1, 0.2) * size_; }
    void restart() { hand_ = outside(), left_ = 0; }
    double size() const { return size_; }

    glm::dvec3 next()
    {
        if (left_-- <= 0) {
            habit_ = int(random_() % 9);
            left_ = int(20 + random_() % 200);
            face_ = any_face();
            corner_ = uint32_t(random_() % 3);
            place_ = uniform();
            pace_ = (uniform() - 0.5) * std::pow(10, -4 * uniform());
        }
        const glm::dvec3 a = surface_.vertex_m(face_, corner_), b = surface_.vertex_m(face_, (corner_ + 1) % 3),
                         c = surface_.vertex_m(face_, (corner_ + 2) % 3);
        switch (habit_) {
        case 0: // jumps
            hand_ = centre_ + 3.0 * size_ * (glm::dvec3(uniform(), uniform(), uniform()) - 0.5);
            break;
        case 1: // strolls
            hand_ += 0.01 * size_ * normal();
            break;
        case 2: // exactly on vertices
            hand_ = any_vertex();
            break;
        case 3: { // exactly on edges
            const uint32_t face = any_face();
            hand_ = 0.5 * (surface_.vertex_m(face, 0) + surface_.vertex_m(face, 1));
            break;
        }
        case 4: { // exactly on faces
            const uint32_t face = any_face();
            hand_ = (surface_.vertex_m(face, 0) + surface_.vertex_m(face, 1) + surface_.vertex_m(face, 2)) / 3.0;
            break;
        }
        case 5: { // to and fro through a vertex, an edge's middle, a centroid
            const double which = uniform();
            const glm::dvec3 aim = which < 0.5 ? a : which < 0.75 ? 0.5 * (a + b) : (a + b + c) / 3.0;
            hand_ = aim + (left_ % 2 ? 0.05 : -0.05) * size_ * surface_.facet_normal(face_);
            if (uniform() < 0.1) face_ = any_face();
            break;
        }
        case 6: // exactly along an edge
            place_ += pace_;
            if (place_ < 0 || place_ > 1) pace_ = -pace_, place_ = glm::clamp(place_, 0.0, 1.0);
            hand_ = a + place_ * (b - a);
            break;
        case 7: { // along an axis, level with vertices
            const int axis = int(random_() % 3);
            hand_[axis] = any_vertex()[axis];
            break;
        }
        default: // drifts in
            hand_ = centre_ + 0.97 * (hand_ - centre_) + 0.002 * size_ * normal();
            if (glm::length(hand_ - centre_) < 0.05 * size_) hand_ = centre_ + 1.5 * size_ * glm::normalize(normal());
            break;
        }
        if (glm::length(hand_ - centre_) > 3 * size_) hand_ = centre_ + 2.0 * size_ * glm::normalize(hand_ - centre_);
        return hand_;
    }

private:
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    glm::dvec3 normal()
    {
        std::normal_distribution<double> d;
        return {d(random_), d(random_), d(random_)};
    }
    uint32_t any_face() { return uint32_t(random_() % surface_.faces.size()); }
    glm::dvec3 any_vertex() { return surface_.vertex_m(any_face(), uint32_t(random_() % 3)); }

    const runtime::Surface& surface_;
    std::mt19937_64 random_;
    glm::dvec3 centre_;
    double size_;
    glm::dvec3 hand_;
    int habit_ = 0, left_ = 0;
    uint32_t face_ = 0, corner_ = 0;
    double place_ = 0, pace_ = 0;
};

} // namespace haptel::test
