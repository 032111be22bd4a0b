// Contact of a ball with one surface: the proxy is the ball's centre, kept at least its radius away from every
// triangle, as near to the hand as it can slide.
//
// Seen from the centre, a triangle lies behind the plane that touches the ball there if ball and triangle touch, or
// would touch. As long as the centre stays in front of all these planes no triangle comes nearer than the radius: each
// move is a straight way within the intersection of half-spaces, so that nothing is crossed at any speed and by any
// mesh, self-piercing ones included. The nearest point of the intersection to the hand is exact (half_spaces.h); the
// planes that hold the ball are laid anew there, until that moves nothing. What one tick may look at is bounded: where
// there are many triangles the ball may have a part of its way left for the next, and until then it touches as it did.
//
// One servo thread owns a contact. update() allocates nothing, never throws, and gives the same bits for the same
// sequence of poses. Everything is in the object's space, metres.
#pragma once

#include "runtime/contact/contact.h"
#include "runtime/contact/near_faces.h"

#include <cstdint>
#include <memory>
#include <span>

namespace haptel::runtime {

class SphereContact {
public:
    // The radius is at most the largest side of the object's box: larger balls do not fit beside it.
    SphereContact(std::shared_ptr<const Surface> surface, double radius_m);

    // One tick: where it touches, at most three places, the one that presses most first. The proxy_m of each is the
    // point touched, its depth and normal what it holds of the way from the hand to the proxy: depths times normals
    // add up to that way, friction's lag apart. The first tick puts the ball down where the hand is; what it overlaps
    // there it does not push away, but as it leaves it grows to its radius.
    std::span<const Contact> update(const glm::dvec3& centre_m, const Friction& friction = {}) noexcept;
    // A ball that was put down smaller, for what it overlapped there, goes out of that as far as the way is free, and
    // grows by as much; one that lacks more than `most_m` of its radius stays. True: it went, and the next tick tells.
    bool move_out(double most_m) noexcept;
    // One tick of a probe that is free and known to have met nothing on its way.
    void follow(const glm::dvec3& centre_m) noexcept;
    void reset() noexcept;

    // At least so far is it from the ball to the nearest triangle; 0: not known.
    double gap_m(const glm::dvec3& centre_m) const noexcept;

    std::span<const Contact> contacts() const noexcept { return {contacts_, contact_count_}; } // of the last tick
    glm::dvec3 proxy_m() const noexcept { return surface_->lattice.metres(centre_); }
    const ContactCounters& counters() const noexcept { return counters_; }
    const Surface& surface() const noexcept { return *surface_; }

private:
    static constexpr uint32_t rounds_max = 48;

    // Where it is known what may be met.
    struct Neighbourhood {
        glm::dvec3 centre{0};
        double margin = -1; // below 0: none
        // How far the ball's centre may move before something may be met that was not found.
        double room(const glm::dvec3& from) const { return margin - glm::distance(from, centre); }
    };

    // What became of a tick's way.
    struct Way {
        NearestInHalfSpaces found; // that holds the ball where it is
        uint32_t round = 0;
        bool cut = false;        // there is more of it than a tick may take
        bool on_the_way = false; // the last step was as long as it might be
        bool blind = false;      // there is too much around to be looked at
    };

    void place() noexcept;
    bool look_around(double margin) noexcept;
    NearestInHalfSpaces approach(double step_max) noexcept;
    Way go(bool until_it_touches) noexcept;
    void move(const Friction& friction) noexcept;
    void push_no_harder_than(double way_m) noexcept;
    uint32_t outermost(uint32_t face, const glm::dvec3& normal, const glm::dvec3& centre) const noexcept;
    void hold_by_friction(const NearestInHalfSpaces& found, const Friction& friction) noexcept;
    void describe(const NearestInHalfSpaces& found, const glm::dvec3& nearest) noexcept;

    std::shared_ptr<const Surface> surface_;
    double radius_, grown_; // lattice units; `grown_` of the ball that was put down into something
    glm::dvec3 hand_{0}, hand_before_{0}, centre_{0};
    bool placed_ = false, sliding_ = false;
    NearFaces faces_;
    Neighbourhood around_, close_;    // of all found, of those picked
    double margin_ = 0;               // that suits the density of the mesh here
    double lag_ = 0;                  // by which friction held the ball back
    glm::dvec3 path_[rounds_max + 1]; // of this tick, from where it began to touch
    uint32_t path_length_ = 0;
    Contact contacts_[3];
    std::size_t contact_count_ = 0;
    ContactCounters counters_;
};

} // namespace haptel::runtime
