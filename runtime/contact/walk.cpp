#include "runtime/contact/contact.h"
#include "runtime/contact/grain_pull.h"
#include "runtime/contact/proxy.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <cmath>

namespace haptel::runtime {

namespace {

// The only tolerances, in lattice units (below 2e-12 of the object): they cover the rounding of the proxy, which is
// a double and no lattice point, and nothing else.
constexpr double lift_off = 8;    // height of the hand at which the surface lets go
constexpr double feature = 32;    // nearer to an edge or a vertex than this is on it
constexpr double departure = 64;  // least way that is worth a turn: more than `feature`, else cycles
constexpr double on_plane = 4;    // nearer to a neighbour's plane than this is on it
constexpr double clear_above = 2; // height that rounding to the lattice cannot undo
constexpr double lattice_unit = 1;

// Of a fan whose normals cancel rounding leaves less.
constexpr double least_outward = 1e-9;

// Length of the sum of two unit normals below which the faces nearly fold onto each other.
constexpr double sharp = 1.0 / 16;

class Walk {
public:
    Walk(const Surface& surface, Proxy& proxy, const glm::dvec3& hand, const Friction& friction, ContactCounters& count)
        : surface_(surface), proxy_(proxy), hand_(hand), friction_(friction), count_(count)
    {
    }

    void run(uint32_t step_limit);

private:
    enum class Step : uint8_t { again, stop };

    const glm::dvec3& vertex(uint32_t face, uint32_t corner) const { return surface_.vertex(face, corner); }
    glm::dvec3 edge_vector(uint32_t face, uint32_t edge) const { return vertex(face, next(edge)) - vertex(face, edge); }
    // Within the face, at a right angle to its edge, as long as the edge.
    glm::dvec3 inward(uint32_t face, uint32_t edge) const
    {
        return glm::cross(surface_.faces[face].normal, edge_vector(face, edge));
    }

    void put(Proxy::On on, uint32_t face, uint32_t side, uint32_t index = 0)
    {
        proxy_.on = on, proxy_.face = face, proxy_.side = side, proxy_.index = index;
    }
    void settle();
    void step_onto_edge(uint32_t face, uint32_t side, uint32_t edge);

    Step from_face();
    bool touches_across(const SideEdge& link, uint32_t face, uint32_t edge) const;
    Step from_edge();
    Step leave_edge(uint32_t face, uint32_t edge, const SideEdge& link);
    bool free_of_edge(uint32_t face, uint32_t edge, uint32_t side) const;
    Step from_vertex();

    Step leave(const StartsOn& start, const glm::dvec3& offset);
    bool slips_into(const SideEdge& to) const;
    Step slide_over_grain(uint32_t face, uint32_t side, uint32_t from_edge, uint32_t or_edge);
    Step slide(uint32_t face, uint32_t side, uint32_t from_edge, uint32_t or_edge);
    Step go_within(uint32_t face, uint32_t side, const glm::dvec3& target, uint32_t from_edge, uint32_t or_edge);
    Step slide_along(uint32_t face, uint32_t edge, uint32_t side);

    const Surface& surface_;
    Proxy& proxy_;
    const glm::dvec3& hand_;
    const Friction& friction_;
    ContactCounters& count_;
};

void Walk::run(uint32_t step_limit)
{
    Step step = Step::again;
    for (uint32_t steps = 0; step == Step::again && steps < step_limit; ++steps, ++count_.walk_steps) {
        settle();
        switch (proxy_.on) {
        case Proxy::On::face: step = from_face(); break;
        case Proxy::On::edge: step = from_edge(); break;
        case Proxy::On::vertex: step = from_vertex(); break;
        case Proxy::On::nothing: step = Step::stop; break;
        }
    }
    count_.walks_cut += step == Step::again;
}

// Onto the lowest feature at the proxy's place: what may be reached next is decided there.
void Walk::settle()
{
    if (proxy_.on == Proxy::On::face) {
        double nearest = feature;
        uint32_t edge = 3;
        for (uint32_t i = 0; i < 3; ++i) {
            const glm::dvec3 in = inward(proxy_.face, i);
            const double away = glm::dot(in, proxy_.at - vertex(proxy_.face, i)), square = glm::dot(in, in);
            if (away > 0 && away * away > feature * feature * square) continue; // nearly always
            const double distance = away / std::sqrt(square);
            if (distance >= nearest) continue;
            nearest = distance;
            edge = i;
        }
        if (edge < 3) step_onto_edge(proxy_.face, proxy_.side, edge);
    } else if (proxy_.on == Proxy::On::edge) {
        step_onto_edge(proxy_.face, proxy_.side, proxy_.index);
    }
}

// Onto the near edge of the face that the proxy is on, or rather onto an end of it that is near.
void Walk::step_onto_edge(uint32_t face, uint32_t side, uint32_t edge)
{
    const glm::dvec3 along = edge_vector(face, edge);
    const double length = glm::length(along);
    const double way = glm::dot(proxy_.at - vertex(face, edge), along) / length;
    const bool near_begin = way < feature, near_end = length - way < feature;
    if (near_begin || near_end) {
        put(Proxy::On::vertex, face, side, near_begin && (!near_end || 2 * way < length) ? edge : next(edge));
        proxy_.at = vertex(face, proxy_.index);
    } else {
        put(Proxy::On::edge, face, side, edge);
        proxy_.at = vertex(face, edge) + way / length * along;
    }
}

// --- what to do on a face, an edge, a vertex

Walk::Step Walk::from_face()
{
    const uint32_t face = proxy_.face;
    const double height = glm::dot(hand_ - vertex(face, 0), surface_.facet_normal(face, proxy_.side));
    if (height < lift_off) return slide(face, proxy_.side, 3, 3);

    // Deep in a sharp fold the opposite face may be nearer than rounding: then links say on which side of it
    // the proxy is, not the sweep.
    StartsOn start = StartsOn::nothing();
    for (uint32_t i = 0; i < 3; ++i) {
        const SideEdge link = surface_.faces[face].link[i][proxy_.side];
        if (!touches_across(link, face, i)) continue;
        const glm::dvec3 normal = surface_.facet_normal(link.face(), link.side());
        if (glm::dot(hand_ - vertex(face, i), normal) >= 0) {
            start.also(link.face());
            continue;
        }
        put(Proxy::On::face, link.face(), link.side());
        return Step::again;
    }
    return leave(start, clear_above * surface_.facet_normal(face, proxy_.side));
}

// Whether the neighbour over a concave edge lies on the proxy within rounding.
bool Walk::touches_across(const SideEdge& link, uint32_t face, uint32_t edge) const
{
    const uint32_t other = link.face();
    if (other == face) return false;
    const glm::dvec3& corner = vertex(face, edge);
    const glm::dvec3 normal = surface_.facet_normal(other, link.side());
    if (glm::dot(proxy_.at - corner, normal) > on_plane) return false;
    const glm::dvec3& tip = vertex(other, previous(link.edge()));
    if (glm::dot(tip - corner, surface_.facet_normal(face, proxy_.side)) <= 0) return false;
    for (uint32_t i = 0; i < 3; ++i)
        if (glm::dot(inward(other, i), proxy_.at - vertex(other, i)) < 0) return false;
    return true;
}

Walk::Step Walk::from_edge()
{
    const uint32_t face = proxy_.face, edge = proxy_.index;
    const Face& data = surface_.faces[face];
    const SideEdge link = data.link[edge][proxy_.side];
    const glm::dvec3 to_hand = hand_ - proxy_.at;
    const double pull_here = glm::dot(to_hand, glm::normalize(inward(face, edge)));
    const double pull_there = glm::dot(to_hand, glm::normalize(inward(link.face(), link.edge())));
    // Over a grain it may leave an edge along which it is pulled, by a lattice unit's rounding.
    if (std::max(pull_here, pull_there) > (friction_.grain.is_there ? -1 : 0)) {
        const SideEdge to = pull_here >= pull_there ? SideEdge(face, edge, proxy_.side) : link;
        const glm::dvec3 normal = surface_.facet_normal(to.face(), to.side());
        if (glm::dot(hand_ - vertex(face, edge), normal) >= lift_off) return leave_edge(face, edge, link);
        const SideEdge other = pull_here >= pull_there ? link : SideEdge(face, edge, proxy_.side);
        if (friction_.grain.is_there && !slips_into(to) && slips_into(other))
            return slide(other.face(), other.side(), other.edge(), 3);
        return slide(to.face(), to.side(), to.edge(), 3);
    }
    if (free_of_edge(face, edge, proxy_.side)) return leave_edge(face, edge, link);
    return slide_along(face, edge, proxy_.side);
}

// Over a grain it need not go to where the hand is.
bool Walk::slips_into(const SideEdge& to) const
{
    if (glm::dot(hand_ - vertex(to.face(), to.edge()), surface_.facet_normal(to.face(), to.side())) >= lift_off)
        return false;
    const GrainPull pull(surface_, proxy_.at, hand_, friction_, to.face(), to.side());
    return glm::dot(pull.slip(), inward(to.face(), to.edge())) > 0;
}

// The hand is in the free wedge of the edge. The way starts above both faces if that is near, which suits any
// wedge; else above the one that the hand is above, if the wedge is wider than a half-space: its plane then
// has the way on one side and the object on the other. In a fold too sharp for that, and beside a border, the
// faces are passed over.
Walk::Step Walk::leave_edge(uint32_t face, uint32_t edge, const SideEdge& link)
{
    const glm::dvec3 here = surface_.facet_normal(face, proxy_.side);
    const glm::dvec3 there = surface_.facet_normal(link.face(), link.side());
    const glm::dvec3 between = here + there;
    const double square = glm::dot(between, between);
    if (square > sharp * sharp) return leave(StartsOn::nothing(), 2 * clear_above / square * between);

    const glm::dvec3 to_hand = hand_ - vertex(face, edge);
    const double above_here = glm::dot(to_hand, here), above_there = glm::dot(to_hand, there);
    const bool border = link.face() == face;
    const bool wide = border || glm::dot(vertex(link.face(), previous(link.edge())) - vertex(face, edge), here) < 0;
    if (wide && std::max(above_here, above_there) >= lift_off)
        return leave(StartsOn::nothing(), clear_above * (above_here >= above_there ? here : there));
    const auto& corners = surface_.faces[face].vertex;
    return leave(StartsOn::on_edge(corners[edge], corners[next(edge)]), glm::dvec3(0));
}

// Whether the hand, to which the edge is nearer than both its faces, is on the free side of it.
bool Walk::free_of_edge(uint32_t face, uint32_t edge, uint32_t side) const
{
    const SideEdge link = surface_.faces[face].link[edge][side];
    const glm::dvec3 to_hand = hand_ - vertex(face, edge);
    const glm::dvec3 outward = surface_.facet_normal(face, side) + surface_.facet_normal(link.face(), link.side());
    if (link.face() != face && glm::dot(hand_ - proxy_.at, outward) <= 0) return false;
    const glm::dvec3 along = edge_vector(face, edge);
    return glm::length(glm::cross(to_hand, along)) >= lift_off * glm::length(along);
}

Walk::Step Walk::from_vertex()
{
    const glm::dvec3 to_hand = hand_ - proxy_.at;
    NearestInFan nearest;
    const uint32_t own = surface_.fan_of(proxy_.face, proxy_.index, proxy_.side);
    const auto each_fan = [&](auto&& visit) { // the fan walked on, and others that it meets in this vertex
        uint32_t fan = own;
        do {
            const Fan& data = surface_.fans[fan];
            visit(fan == own ? Sector{proxy_.face, proxy_.index, proxy_.side}
                             : Sector{data.start.face(), data.start.edge(), data.start.side()});
            fan = data.next;
        } while (fan != own);
    };
    each_fan([&](const Sector& start) { nearest.consider(surface_, start, to_hand); });

    const auto [face, corner, side] = nearest.sector;
    const StartsOn here = StartsOn::on_vertex(surface_.faces[proxy_.face].vertex[proxy_.index]);
    if (nearest.way == 0) {
        bool free_of_vertex = glm::length(to_hand) >= lift_off;
        each_fan([&](const Sector& start) {
            if (!free_of_vertex) return;
            const FanOutward outward(surface_, start);
            free_of_vertex =
                !outward.closed || glm::dot(outward.normal, to_hand) > least_outward * glm::length(to_hand);
        });
        return free_of_vertex ? leave(here, glm::dvec3(0)) : Step::stop;
    }
    if (nearest.edge == NearestInFan::into_sector) {
        if (glm::dot(to_hand, surface_.facet_normal(face, side)) >= lift_off) return leave(here, glm::dvec3(0));
        if (friction_.grain.is_there) {
            // As without friction, but for a hand that is by what friction holds nearer.
            const glm::dvec3 held = GrainPull(surface_, proxy_.at, hand_, friction_, face, side).held();
            NearestInFan there;
            each_fan([&](const Sector& start) { there.consider(surface_, start, to_hand - held); });
            if (there.way <= departure) return Step::stop;
            const auto [into, at, of] = there.sector;
            const bool is_below = glm::dot(to_hand, surface_.facet_normal(into, of)) < 0;
            return is_below ? slide(into, of, at, previous(at)) : slide_along(face, corner, side);
        }
        return nearest.way > departure ? slide(face, side, corner, previous(corner)) : Step::stop;
    }
    if (free_of_edge(face, nearest.edge, side)) return leave(here, glm::dvec3(0));
    return nearest.way > departure ? slide_along(face, nearest.edge, side) : Step::stop;
}

// --- moves

// Straight to the hand unless the object is in the way. The way starts on a lattice point beside the proxy, by an
// offset that keeps rounding from putting it below the surface: a grazing way could pass under the next face.
Walk::Step Walk::leave(const StartsOn& start, const glm::dvec3& offset)
{
    const glm::dvec3 from = glm::round(proxy_.at + offset);
    Crossing crossing;
    if (first_crossing(surface_, from, hand_, start, crossing, count_)) {
        land(surface_, proxy_, crossing, from, hand_);
        return Step::again;
    }
    proxy_.on = Proxy::On::nothing;
    proxy_.at = hand_;
    return Step::stop;
}

// Over the face toward the foot of the hand on it, as far as the face goes. Edges from which the walk comes are
// not crossed again (3: none).
Walk::Step Walk::slide(uint32_t face, uint32_t side, uint32_t from_edge, uint32_t or_edge)
{
    if (friction_.grain.is_there) return slide_over_grain(face, side, from_edge, or_edge);
    const glm::dvec3 normal = surface_.facet_normal(face, side);
    const double height = glm::dot(hand_ - vertex(face, 0), normal);
    const glm::dvec3 way = hand_ - height * normal - proxy_.at;
    proxy_.pressed = std::max(0.0, -height);
    const double share = share_past(friction_, glm::length(way), proxy_.pressed, lattice_unit, proxy_.sliding);
    put(Proxy::On::face, face, side);
    if (share == 0) return Step::stop;
    return go_within(face, side, proxy_.at + share * way, from_edge, or_edge);
}

// As slide, past an ellipse of friction. A slip that leads out by an edge that is not crossed again goes along it.
Walk::Step Walk::slide_over_grain(uint32_t face, uint32_t side, uint32_t from_edge, uint32_t or_edge)
{
    const GrainPull pull(surface_, proxy_.at, hand_, friction_, face, side);
    proxy_.pressed = pull.depth();
    put(Proxy::On::face, face, side);
    if (!proxy_.sliding && pull.is_held(friction_.static_coefficient)) return Step::stop;
    glm::dvec3 slip = pull.slip();
    for (const uint32_t edge : {from_edge, or_edge}) {
        if (edge > 2) continue;
        const glm::dvec3 in = inward(face, edge);
        slip -= std::min(0.0, glm::dot(in, slip)) / glm::dot(in, in) * in;
    }
    const bool rounding = glm::length(slip) <= lattice_unit;
    if (rounding && friction_.dynamic_coefficient > 0) return Step::stop;
    if (from_edge < 3 && glm::dot(inward(face, from_edge), slip) < -glm::length(inward(face, from_edge)))
        return Step::stop; // in a corner, out by one edge where it goes along the other
    proxy_.sliding = proxy_.sliding || !rounding;
    return go_within(face, side, proxy_.at + slip, from_edge, or_edge);
}

// Over the face to the target in its plane, at most to its edges.
Walk::Step Walk::go_within(uint32_t face, uint32_t side, const glm::dvec3& target, uint32_t from_edge, uint32_t or_edge)
{
    double exit_at = HUGE_VAL;
    uint32_t exit = 3;
    for (uint32_t i = 0; i < 3; ++i) {
        if (i == from_edge || i == or_edge) continue;
        const glm::dvec3 in = inward(face, i);
        const double end = glm::dot(in, target - vertex(face, i));
        if (end >= 0) continue;
        const double begin = std::max(0.0, glm::dot(in, proxy_.at - vertex(face, i)));
        const double at = begin / (begin - end);
        if (at >= exit_at) continue;
        exit_at = at;
        exit = i;
    }
    proxy_.at = exit == 3 ? target : proxy_.at + exit_at * (target - proxy_.at);
    if (exit == 3) return Step::stop;
    step_onto_edge(face, side, exit);
    return Step::again;
}

// Along the edge toward the foot of the hand on it, at most to its end.
Walk::Step Walk::slide_along(uint32_t face, uint32_t edge, uint32_t side)
{
    const glm::dvec3& begin = vertex(face, edge);
    const glm::dvec3 along = edge_vector(face, edge), from_hand = begin - hand_, across = glm::cross(from_hand, along);
    const double length = glm::length(along);
    const double here = glm::dot(proxy_.at - begin, along) / length;
    const double way = glm::dot(hand_ - begin, along) / length - here;
    // How deep the hand is, as friction feels it: in a groove below both its walls together.
    proxy_.pressed = glm::length(across) / length;
    const SideEdge link = surface_.faces[face].link[edge][side];
    const glm::dvec3 normal = surface_.facet_normal(face, side);
    const glm::dvec3 both = normal + surface_.facet_normal(link.face(), link.side());
    const double square = glm::dot(both, both);
    const bool groove = glm::dot(vertex(link.face(), previous(link.edge())) - begin, normal) > 0;
    if (groove && square > sharp * sharp)
        proxy_.pressed = std::max(proxy_.pressed, 2 * glm::dot(from_hand, both) / square);
    double eased = 1; // in this direction friction bears so much more or less
    if (friction_.grain.is_there) {
        const glm::dvec3 push = glm::cross(along, across);
        if (const double pushes = glm::length(push); pushes > 0)
            eased = length / FrictionEllipse(friction_.grain, push / pushes).size(along);
    }
    const double share = share_past(friction_, std::abs(way), eased * proxy_.pressed, lattice_unit, proxy_.sliding);
    put(Proxy::On::edge, face, side, edge);
    if (share == 0) return Step::stop;
    const double there = here + share * way;
    const glm::dvec3 from = proxy_.at;
    proxy_.at = begin + glm::clamp(there, 0.0, length) / length * along;
    step_onto_edge(face, side, edge);
    return proxy_.on == Proxy::On::vertex && proxy_.at != from ? Step::again : Step::stop;
}

} // namespace

void walk(const Surface& surface, Proxy& proxy, const glm::dvec3& hand, const Friction& friction,
          ContactCounters& count, uint32_t step_limit) noexcept
{
    Walk(surface, proxy, hand, friction, count).run(step_limit);
}

void land(const Surface& surface, Proxy& proxy, const Crossing& crossing, const glm::dvec3& from,
          const glm::dvec3& to) noexcept
{
    proxy.on = Proxy::On::face;
    proxy.face = crossing.face;
    proxy.side = crossing.side;
    proxy.at = crossing_point(surface, crossing, from, to);
}

} // namespace haptel::runtime
