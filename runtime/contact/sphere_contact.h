// Contact of a ball with one surface: the proxy is the ball's centre, kept at least its radius away from every
// triangle, as near to the hand as it can slide.
//
// Seen from the centre, a triangle lies behind the plane that touches the ball there if ball and triangle touch, or
// would touch. As long as the centre stays in front of all these planes no triangle comes nearer than the radius: each
// move is a straight way within the intersection of half-spaces, so that nothing is crossed at any speed and by any
// mesh, self-piercing ones included. The nearest point of the intersection to the hand is exact (project.h); the
// planes that hold the ball are laid anew there, until that moves nothing. What one tick may look at is bounded: where
// there are many triangles the ball may have a part of its way left for the next, and until then it touches as it did.
#pragma once

#include "runtime/contact/end_contact.h"
#include "runtime/contact/near_faces.h"
#include "runtime/geometry/nearest_point.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace haptel::runtime {

class SphereContact final : public EndContact {
public:
    // The radius is at most the largest side of the object's box: larger balls do not fit beside it. None: of a point,
    // which Lattice::point_radius holds off the surface; that is not felt.
    explicit SphereContact(std::shared_ptr<const Surface> surface, std::optional<double> radius_m = {});

    // The proxy_m of each contact is the point touched, its depth and normal what it holds of the way from the hand to
    // the proxy: depths times normals add up to that way, friction's lag apart. The first tick puts the ball down where
    // the hand is; what it overlaps there it does not push away, but as it leaves it grows to its radius.
    std::span<const Contact> update(const glm::dvec3& centre_m, const Friction& friction = {}) noexcept
    {
        tick(centre_m, friction);
        return contacts();
    }

    void tick(const glm::dvec3& hand_m, const Friction& friction) noexcept override { tick(hand_m, friction, nullptr); }
    // `tail`, lattice units: the other end of a stylus, which is put down from there. A shaft that enters the object by
    // a front side touches there; one that comes out of it does not: its tail is inside.
    void tick(const glm::dvec3& hand_m, const Friction& friction, const glm::dvec3* tail) noexcept;
    void follow(const glm::dvec3& hand_m) noexcept override;
    void reset() noexcept override;
    bool move_out(double most_m) noexcept override;
    double gap_m(const glm::dvec3& hand_m) const noexcept override;
    std::span<const Contact> contacts() const noexcept override { return {contacts_, contact_count_}; }
    const Contact& contact() const noexcept override { return contacts_[0]; }
    const Surface& surface() const noexcept { return *surface_; }
    glm::dvec3 proxy_m() const noexcept { return surface_->lattice.metres(proxy_.at); }

    const Proxy& proxy() const noexcept override { return proxy_; }

    // Of the last tick: where each straight piece of its way ended, as far as it touched.
    std::span<const glm::dvec3> places() const noexcept { return {path_.data(), path_length_}; }

    // For a stylus, which holds both its ends and its shaft by one projection. Lattice units.
    bool is_placed() const noexcept { return placed_; }
    void restart(const glm::dvec3& at) noexcept; // anew, at a free place
    void set_sliding(bool sliding) noexcept { proxy_.sliding = sliding; }
    // As a point of its own, to a lattice point; what it touches is told. False: it has not come to rest, and does not
    // know what it touches.
    bool go(const glm::dvec3& hand, const Friction& friction) noexcept;
    void come_back(const glm::dvec3& at) noexcept;                             // from there to where it was
    void slide_on(const glm::dvec3& way_m, const Friction& friction) noexcept; // a tick begins
    // What is known of what is around. A point, which meets few faces, looks as far as it goes at first.
    void forget() noexcept { around_ = close_ = {}, margin_ = is_point_ ? Lattice::extent : 0.0; }
    // Goes to a place and lays the planes that hold the end while it stays within the length that is returned, at most
    // `reach`, of there. 0: there is too much around to be looked at, or more than `most` planes. `is_first`: of a
    // tick, and what it holds at first is looked at again.
    double look_from(const glm::dvec3& at, double reach, std::size_t most, bool is_first) noexcept;
    std::span<const HalfSpace> planes() const noexcept { return faces_.rows(); }
    double radius() const noexcept { return grown_; }
    // How many of the planes the end touches, or is as near to as its radius; these come first.
    std::size_t touching() noexcept;
    // Tells what holds it, by planes and pushes of those alone; it aims at a place, and friction holds it by `lag`.
    void tell_held(const glm::dvec3& aim, std::span<const uint32_t> planes, std::span<const double> pushes,
                   const glm::dvec3& lag) noexcept;

private:
    // Lattice units: a point that can fly no farther has landed.
    static constexpr double touching_gap = 64;
    // A point looks farther around than margin_of_point only for so many, and where it flies for fewer.
    static constexpr std::size_t far_faces = 256;
    static constexpr double centre_settled = 1e-8; // of the radius: what is left of a way counts as none
    // In a tick; of the planes that it comes to touch in a round against friction.
    static constexpr uint32_t rounds_max = 48, turns_max = 4;

    using Laid = NearFaces::Laid;

    // Where it is known what may be met.
    struct Neighbourhood {
        glm::dvec3 centre{0};
        double margin = -1; // below 0: none
        // How far the ball's centre may move before something may be met that was not found.
        double room(const glm::dvec3& from) const { return margin - glm::distance(from, centre); }
    };

    // What holds the ball, who presses most first, and where: at - hand = sum of push * normal, but of a point.
    struct Row {
        uint32_t face = 0;
        glm::dvec3 normal{0}; // unit
        double push = 0;
    };
    struct Held {
        glm::dvec3 at{0};
        std::size_t count = 0;
        std::array<Row, 3> row{};

        double pushes() const { return row[0].push + row[1].push + row[2].push; }
    };

    // Of the last round.
    struct Stride {
        glm::dvec3 along{0};            // the plane that held it: of all the way that it had to go
        glm::dvec3 from{0}, further{0}; // all of its step, if it went as far as those that would follow
        double left = 0;                // before that: what friction left of the way
        bool went_back = false;
    };

    // What became of a tick's way.
    struct Way {
        Held held;
        uint32_t round = 0;
        bool cut = false;        // there is more of it than a tick may take
        bool on_the_way = false; // the last step was as long as it might be
        bool blind = false;      // there is too much around to be looked at
    };

    void aim(const glm::dvec3& hand) noexcept;
    void grow() noexcept // as wide as there is room for; what was picked was for less
    {
        if (grown_ == radius_) return;
        const double widest = radius_ + distance_rounding, room = faces_.distance(proxy_.at, widest);
        grown_ = room < widest ? std::max(grown_, room - distance_rounding) : radius_;
        close_ = {};
    }
    void place(const glm::dvec3& at) noexcept;
    bool find_around(double margin, std::size_t far_most = far_faces) noexcept;
    double look_as_far_as(double way, double goes, bool flies = false) noexcept;
    void fly(double step_max) noexcept;
    Held slide(double step_max, Stride& last, bool is_last) noexcept;
    glm::dvec3 further(const Held& held, const glm::dvec3& way, Stride& last) noexcept;
    Held as_rows(const Projection<glm::dvec3>& found) noexcept;
    Held rub(double step_max, Stride& last, bool is_last) noexcept;
    void pick(double reach, Laid laid) noexcept;
    bool rubs() const noexcept { return friction_.static_coefficient > 0; }
    Way travel(bool until_it_touches) noexcept;
    bool move(const Friction& friction) noexcept;
    void pass() noexcept { path_[path_length_++] = proxy_.at; }
    void keep_told() noexcept;
    bool stands(const Held& held) noexcept;
    const NearestPoint& nearest_on(uint32_t face, const glm::dvec3& centre) noexcept;
    uint32_t touching_face(uint32_t face, const glm::dvec3& normal, const glm::dvec3& centre) noexcept;
    void tell(const Held& held, const glm::dvec3& nearest) noexcept;
    void tell_free() noexcept;
    void tell_nothing() noexcept;

    std::shared_ptr<const Surface> surface_;
    double radius_, grown_;   // lattice units; `grown_` of the ball that was put down into something
    double grown_before_ = 0; // it went
    glm::dvec3 hand_{0}, hand_before_{0};
    Proxy proxy_; // the centre; on a face, whichever, while it touches
    bool is_point_, placed_ = false;
    NearFaces faces_;
    Laid laid_ = Laid::before;     // those picked last
    Neighbourhood around_, close_; // of all found, of those picked
    double margin_;                // that suits the density of the mesh here
    Friction friction_;            // of this tick
    bool in_air_ = true;           // by now
    bool rests_ = false;           // friction holds it where it is
    bool solid_ = false;           // held by a group that there was no room to look into
    struct {                       // found last: a tick asks whether it stands there, and tells it
        uint32_t face = ~0u;
        glm::dvec3 centre{0};
        NearestPoint at{};
    } nearest_;
    std::array<glm::dvec3, turns_max*(rounds_max + 1)> path_;
    uint32_t path_length_ = 0;
    Contact contacts_[3];
    std::size_t contact_count_ = 0;
};

} // namespace haptel::runtime
