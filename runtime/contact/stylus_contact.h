// Contact of a stylus with one surface: both ends and the shaft between them, which rests on edges and, by two of them,
// on vertices.
//
// The hand holds a stylus from its tip p to its tail q. The proxy is a second stylus, from P to Q: of all that the
// first can reach without passing through the surface, the one that minimises |P - p|^2 + |Q - q|^2. So a spring of the
// object's stiffness connects each end with its proxy, and the force on the hand is minus the gradient of the springs'
// energy: without friction no closed path gains energy. A contact at the share s of the shaft (0: tip, 1: tail) pushes
// with stiffness * depth / ((1 - s)^2 + s^2): like a point at the tip, twice as hard in the middle.
//
// The proxy is a capsule of the radius of a point that is a ball (Lattice::point_radius). What holds it are rows of one
// projection (project.h): planes between its ends and the triangles near them, and for each edge that its shaft has met
// a plane at right angles to both, which turns with the shaft. It goes straight to where the rows let it come nearest
// to the hand, as far as it knows what is around its ends, and looks again. The shaft meets edges in the order of time,
// and takes no place in which exact arithmetic finds it crossing a triangle, so that nothing is passed through at any
// speed. It is felt as a line: rows are projected once more without the radius.
//
// What one tick may look at is bounded. Where that is reached the stylus stays at the place that it has come to, at
// most four radii farther from the hand than before the tick, and the part of the springs' force that no known contact
// explains is told at the ends (Contact::unsettled).
//
// A stylus that is put down across the surface, or comes from beyond the workspace of the lattice with its whole
// length, is held by its tip alone until it crosses nothing; so is one that could not follow for 64 ms on end.
//
// One servo thread owns a contact. update() allocates nothing, never throws, and gives the same bits for the same
// sequence of poses. Everything is in the object's space, metres. Friction holds the ends; the shaft slides freely. Its
// pushes and what friction does to the ends are found together (stylus_friction.h): an end that friction keeps in its
// place does not make way for an edge, so the other has to, and friction bears what the edge pushes the kept end with.
#pragma once

#include "runtime/contact/project.h"
#include "runtime/contact/shaft.h"
#include "runtime/contact/sphere_contact.h"
#include "runtime/contact/stylus_friction.h"
#include "runtime/surface/swept_region.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace haptel::runtime {

class StylusContact {
public:
    // `rate_hz`: of the ticks.
    explicit StylusContact(std::shared_ptr<const Surface> surface, double rate_hz = 1000);

    // One tick: the hand's tip and tail, metres, in the object's space. In the first tick the stylus is put down along
    // the way from its tail to its tip: if that way enters the object through a front side, the tip touches there. If
    // the tail is not finite, the tip is treated as a point. Returns the tip's contact, whether it touches or not.
    const Contact& update(const glm::dvec3& tip_m, const glm::dvec3& tail_m,
                          const EndsFriction& friction = {}) noexcept;
    void follow(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;
    // Between two ticks, as EndContact's.
    void look_around() noexcept;
    void reset() noexcept;

    // Where the stylus touches: the tip first, then the shaft, then the tail, then what no contact accounts for
    // (Contact::unsettled). Each depth_m is the contact's force over the stiffness. The sum of depth_m * normal, plus
    // lag_m of the ends, is (P - p) + (Q - q).
    std::span<const Contact> contacts() const noexcept { return {contacts_.data(), contact_count_}; }

    // The proxy of the whole stylus, in lattice units; both ends are lattice points, and it crosses no triangle.
    // Nothing while the tip alone is held. Of a stylus that reaches beyond the workspace only the part within.
    std::optional<Shaft> ideal() const noexcept;

    // At least so far is it from any point of the stylus, where it was last, to the nearest triangle; 0: not known.
    double gap_m(const glm::dvec3& tip_m, const glm::dvec3& tail_m) const noexcept;

    ContactCounters counters() const noexcept;
    const Surface& surface() const noexcept { return tip_->surface(); }

    // For so long a shaft may fall behind its ends, whatever the rate.
    static constexpr double patience_s = 0.064;

private:
    static constexpr uint32_t sides_max = 4;
    static constexpr std::size_t planes_max = 96; // of an end
    static constexpr double push_settled = 1e-3;  // lattice units: what a push may leave violated
    // In a tick, one a round at least. Slow strokes need up to 12, a tail that goes 6 m/s past 327 680 triangles 24;
    // with fewer a shaft that lies on those falls behind where it goes 2 m/s.
    static constexpr uint32_t sweeps_max = 32;
    // So many boxes of triangles are looked at on one straight way: what a shaft meets that lies on a plate of 256 by
    // 256 cells. A longer way is tried in part.
    static constexpr std::size_t triangles_per_move = 1024;

    // A contact of the shaft with an edge.
    struct Side {
        uint32_t face = 0, edge = 0;
        bool fresh = true;    // met in this round
        bool reached = false; // the shaft has passed over it
        double sign = 1;      // of the shaft's height over it, as `passing` has it
        double push = 0;      // lattice units
        double share = 0;     // of the stylus, where it touches
        glm::dvec3 normal{0}, point{0};
    };
    struct Obstacle {
        uint32_t face = 0, edge = 0;
        double time = 0; // share of the move
        int side = 0;
        bool exact = false; // not met on the way, but crossed at the end of it
        double height = 0;  // over the edge that it comes near
    };
    struct FrictionOfEnds {
        EndFriction tip, tail;
    };
    // Of an end in rows_, and how far they hold for it.
    struct EndRows {
        uint32_t first = 0, count = 0;
        double reach = 0;
    };

    const glm::dvec3& edge_end(uint32_t face, uint32_t edge, uint32_t which) const noexcept;
    Passing passing_of(const Side& side, const Shaft& shaft) const noexcept;

    bool take(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;
    Shaft within(const glm::dvec3& tip, const glm::dvec3& tail) const noexcept;
    Shaft extended(const Shaft& part) const noexcept;
    void start(const glm::dvec3& tip_m, const Friction& friction) noexcept;
    bool pass_freely(const glm::dvec3& tip_m, const glm::dvec3& tail_m) noexcept;

    bool go_apart(const EndsFriction& friction) noexcept;
    void resolve(const EndsFriction& friction) noexcept;
    bool look(double reach, const FrictionOfEnds& ends, bool is_first) noexcept;
    std::span<const ShaftRow> turn_sides(const Shaft& at, double gap) noexcept;
    void take_hold(EndFriction& friction, const EndRows& rows, const Projection<Shaft>& held, const glm::dvec3& at,
                   double radius) const noexcept;
    Projection<Shaft> solve(FrictionOfEnds& ends) noexcept;
    double known_share(const Shaft& to, double stride, const Projection<Shaft>& held,
                       const FrictionOfEnds& ends) noexcept;
    Shaft on_the_way(const Shaft& to, double share, const FrictionOfEnds& ends) noexcept;
    void hold(const FrictionOfEnds& ends, bool settled) noexcept;
    bool move(const Shaft& to) noexcept;
    SweptRegion swept_to(const Shaft& to) const noexcept;
    bool find_near(const SweptRegion& swept) noexcept;
    bool blocked(const Shaft& to, const SweptRegion& swept, Obstacle& obstacle) noexcept;
    bool is_below_a_side(uint32_t vertex0, uint32_t vertex1, const Shaft& to) const noexcept;
    void approach(const Shaft& to, const Obstacle& obstacle) noexcept;
    bool is_side(const glm::dvec3& edge0, const glm::dvec3& edge1) const noexcept;
    void touch(const Obstacle& obstacle) noexcept;
    void see(uint32_t face, uint32_t edge, const Shaft& to) noexcept;
    void let_go_of_ended() noexcept;
    bool meets_fresh(const Side& side) const noexcept;
    double away(const Shaft& part) const noexcept;
    void drop(uint32_t side) noexcept;
    void report() noexcept;
    void tell(double along, uint32_t face, const glm::dvec3& point, const glm::dvec3& normal, double push) noexcept;
    void tell_what_is_left() noexcept;
    uint32_t nearest_face(const SphereContact& end, double along) const noexcept;

    std::unique_ptr<SphereContact> tip_, tail_;
    Shaft hand_;                 // lattice units, neither rounded nor clamped
    double begin_ = 0, end_ = 1; // shares of the stylus that lie in the workspace
    Shaft reached_;              // the hand for which the shaft was held last
    Shaft shaft_;                // lattice points
    bool has_shaft_ = false;     // of the last tick
    bool tracked_ = false;       // the shaft crosses nothing
    Obstacle close_;
    Obstacle met_; // by the last move
    std::array<Side, sides_max> sides_;
    uint32_t side_count_ = 0;
    std::array<ShaftRow, 2 * planes_max + sides_max> rows_; // of the tip, the tail, the sides
    uint32_t row_count_ = 0;                                // of both ends
    EndRows tip_rows_, tail_rows_;
    Shaft left_;                                  // of what the springs are drawn by, what no row accounts for
    Clearance<Shaft> clear_;                      // of each end
    std::array<Contact, sides_max + 8> contacts_; // of each end three, and what is left
    uint32_t contact_count_ = 0;
    std::array<uint32_t, triangles_per_move> near_; // triangles, of the way that was looked at last
    std::size_t near_count_ = 0;
    uint32_t sweeps_left_ = 0; // in this tick
    uint32_t stuck_ticks_ = 0; // in a row
    uint32_t patience_ticks_;  // patience_s
    ContactCounters counters_; // of the shaft, and of rounds of both ends with it
};

} // namespace haptel::runtime
