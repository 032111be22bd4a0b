#include "runtime/surface/box_tree.h"

#include "runtime/surface/discs.h"
#include "runtime/surface/four_boxes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr uint32_t width = BoxTree::width;

glm::vec3 rounded(const glm::dvec3& p)
{
    return glm::vec3(p * BoxTree::scale);
}

// A query says which of a node's boxes it enters and where on its way (`at`), how far that still counts (`upto`), and
// visits faces.
class SegmentQuery {
public:
    SegmentQuery(const glm::dvec3& from, const glm::dvec3& to, const BoxTree::Visit& visit)
        : from_(rounded(from)), visit_(visit)
    {
        const glm::vec3 along = rounded(to - from);
        for (int k = 0; k < 3; ++k) {
            per_along_[k] = 1 / along[k]; // infinite where it stays: then it is within for ever or never
            backward_[k] = std::signbit(along[k]);
        }
    }

    float upto = rounded_up(1);

    FourBits enters(const BoxTree::Node& node, uint32_t first, float (&at)[width]) const
    {
        Four in = all_of(0), out = all_of(upto);
        for (int axis = 0; axis < 3; ++axis) {
            const float* const near = (backward_[axis] ? node.high : node.low)[axis] + first;
            const float* const far = (backward_[axis] ? node.low : node.high)[axis] + first;
            const Four from = all_of(from_[axis]), per_along = all_of(per_along_[axis]);
            in = most_of((four(near) - from) * per_along, in); // what is not a number counts as neither
            out = least((four(far) - from) * per_along, out);
        }
        *reinterpret_cast<Four*>(at + first) = in;
        return in <= out;
    }
    void visit(uint32_t face) { upto = std::min(upto, rounded_up(visit_(face))); }

private:
    // Past any rounding.
    static float rounded_up(double fraction) { return float(fraction * (1.0 + 1e-6) + 1e-30); }

    glm::vec3 from_, per_along_;
    bool backward_[3];
    const BoxTree::Visit& visit_;
};

// `at` is the square of the distance.
class BallQuery {
public:
    BallQuery(const glm::dvec3& centre, double radius) : centre_(rounded(centre)) { shrink_to(radius); }

    float upto = 0;

    FourBits enters(const BoxTree::Node& node, uint32_t first, float (&at)[width]) const
    {
        Four square = all_of(0);
        for (int axis = 0; axis < 3; ++axis) {
            const Four centre = all_of(centre_[axis]);
            const Four off = most_of(
                most_of(four(node.low[axis] + first) - centre, centre - four(node.high[axis] + first)), all_of(0));
            square += off * off;
        }
        *reinterpret_cast<Four*>(at + first) = square;
        return square <= all_of(upto);
    }

    void shrink_to(double radius)
    {
        const float wide = float(radius * BoxTree::scale) * (1.0f + 1e-6f) + BoxTree::widening; // past any rounding
        upto = std::min(wide * wide, std::numeric_limits<float>::max()); // an empty place is infinitely far away
    }
    void end() { upto = -1; }

private:
    glm::vec3 centre_;
};

class VisitedBall : public BallQuery {
public:
    VisitedBall(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces, const glm::dvec3& centre,
                double radius, const BoxTree::Visit& visit)
        : BallQuery(centre, radius), vertices_(vertices), faces_(faces), centre_(centre), radius_(radius), visit_(visit)
    {
    }

    void visit(uint32_t face)
    {
        const auto& corners = faces_[face].vertex;
        const glm::dvec3 &a = vertices_[corners[0]], &b = vertices_[corners[1]], &c = vertices_[corners[2]];
        const glm::dvec3 away = centre_ - glm::clamp(centre_, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)));
        if (glm::dot(away, away) > radius_ * radius_) return;
        const double now = visit_(face);
        if (!(now < radius_)) return;
        radius_ = now;
        now > 0 ? shrink_to(now) : end();
    }

private:
    const std::vector<glm::dvec3>& vertices_;
    const std::vector<Face>& faces_;
    const glm::dvec3& centre_;
    double radius_;
    const BoxTree::Visit& visit_;
};

class ListedBall : public BallQuery {
public:
    ListedBall(const glm::dvec3& centre, double radius, std::size_t most, std::vector<uint32_t>& faces)
        : BallQuery(centre, radius), most_(most), faces_(faces)
    {
    }

    bool more = false;

    void visit(uint32_t face)
    {
        more = faces_.size() == most_;
        more ? end() : faces_.push_back(face);
    }

private:
    std::size_t most_;
    std::vector<uint32_t>& faces_;
};

} // namespace

BoxTree::BoxTree(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces, std::vector<Node> nodes,
                 unsigned threads)
    : vertices_(vertices), faces_(faces), nodes_(std::move(nodes)), discs_(discs_of(vertices, faces, nodes_, threads))
{
}

uint32_t BoxTree::children_near(uint32_t node, const glm::dvec3& centre, double radius) const noexcept
{
    alignas(16) float at[width];
    const BallQuery query(centre, radius);
    return bits(query.enters(nodes_[node], 0, at), query.enters(nodes_[node], half, at));
}

template <class Query>
void BoxTree::ask(Query& query) const noexcept
{
    struct Waiting {
        float at;
        uint32_t child;
    } waiting[depth_max * (width - 1) + width]; // the nearest is the last
    std::size_t count = 0;
    waiting[count++] = {0, 0};
    while (count > 0) {
        const auto [at, child] = waiting[--count];
        if (!(at <= query.upto)) continue;
        if (child & is_face) {
            query.visit(child & ~is_face);
            continue;
        }
        const Node& node = nodes_[child];
        alignas(16) float enters_at[width];
        const std::size_t first = count;
        for (uint32_t hits = bits(query.enters(node, 0, enters_at), query.enters(node, half, enters_at)); hits != 0;
             hits &= hits - 1) {
            const auto k = static_cast<uint32_t>(std::countr_zero(hits));
            std::size_t place = count++;
            for (; place > first && waiting[place - 1].at < enters_at[k]; --place) waiting[place] = waiting[place - 1];
            waiting[place] = {enters_at[k], node.child[k]};
        }
    }
}

void BoxTree::segment(const glm::dvec3& from, const glm::dvec3& to, const BoxTree::Visit& visit) const noexcept
{
    SegmentQuery query(from, to, visit);
    ask(query);
}

void BoxTree::ball(const glm::dvec3& centre, double radius, const BoxTree::Visit& visit) const noexcept
{
    VisitedBall query(vertices_, faces_, centre, radius, visit);
    ask(query);
}

bool BoxTree::ball(const glm::dvec3& centre, double radius, std::size_t most,
                   std::vector<uint32_t>& faces) const noexcept
{
    faces.clear();
    ListedBall query(centre, radius, most, faces);
    ask(query);
    return !query.more;
}

} // namespace haptel::runtime
