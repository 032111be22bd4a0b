// Could the proxy really have gone there? An accomplice tries to go the same way, and is not allowed to cheat.
//
// The accomplice is a point that never touches a triangle: it moves along straight segments each of which is open by
// ExactMesh. For every single step of a proxy it must come to a point that bears the proxy's claim out:
//   - the proxy is on nothing: that very point; if it lies on a triangle, one within `reach`, best of all in the
//     direction in which all decide ties;
//   - the proxy is on side s of face f: a point within `reach` of it, on side s of f's plane, from which a short
//     straight line to f, where it is within `reach` of the proxy, meets nothing before f.
// On the way it may look for detours, but only within `reach` of the proxy's place before or after the step. So all its
// way since the start is one curve in free space that the proxy was never farther from than `reach`: what it can follow
// is proven possible on any mesh, open, non-manifold, badly wound or piercing itself. What it cannot follow went
// through a triangle, or through a gap narrower than what it finds among `tries` random points.
//
// Of a face narrower than what its grid resolves, 1/1024 unit, the side cannot be shown: `sideless` counts these.
#pragma once

#include "runtime/contact/proxy.h"
#include "tests/runtime/surface/exact_mesh.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace haptel::test {

class Accomplice {
public:
    static constexpr double reach = 256; // lattice units: 2.4e-10 of the object's half extent
    static constexpr int tries = 4000;

    Accomplice(const ExactMesh& mesh, uint64_t seed) : mesh_(mesh), random_(seed) {}

    // Where the probe is put down.
    void put(const glm::dvec3& hand);

    // After one step of the proxy. False: it cannot follow. Then it must be put anew.
    bool follow(const runtime::Proxy& proxy);

    // Whether the proxy rests although the accomplice could go straight on and come nearer to the hand, along a face, a
    // crease or right toward it, by at least 5 % of a way of 1e-6 half extents: from where it is, and from others of
    // the points that bear the proxy out, down to 0.2 units from it.
    bool could_go_nearer(const runtime::Proxy& proxy, const glm::dvec3& hand);

    uint64_t detours = 0; // steps that took more than a straight segment
    uint64_t sideless = 0;

private:
    using Points = std::vector<glm::dvec3>;

    // A step: from where, and the proxy after it.
    struct Followed {
        glm::dvec3 at{0};
        runtime::Proxy proxy;
    };

    bool go(const runtime::Proxy& proxy);
    bool go_otherwise(const runtime::Proxy& proxy);
    bool bears_out(const runtime::Proxy& proxy, const glm::dvec3& point) const;
    glm::dvec3 witness(const runtime::Proxy& proxy, int attempt);
    glm::dvec3 scout(const glm::dvec3& around, const std::vector<uint32_t>& faces, double radius);
    bool could_go_nearer_from(const glm::dvec3& point, const glm::dvec3& hand) const;
    bool search(const runtime::Proxy& proxy, const Points& goals, int most);
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
    glm::dvec3 in_ball();

    const ExactMesh& mesh_;
    std::mt19937_64 random_;
    glm::dvec3 at_{0};     // the accomplice
    glm::dvec3 before_{0}; // the proxy it last followed
    Followed last_;
    bool placed_ = false;
};

} // namespace haptel::test
