// The triangles around the centre of a ball, each with a plane that separates it from the ball. The plane goes through
// the point of the triangle that was nearest to the centre when the plane was computed, at right angles to the
// direction there. A triangle is convex, so it lies behind that plane wherever the ball moves afterwards, and the
// distance to the plane is a lower bound of the distance to the triangle. On a fine mesh with hundreds of triangles
// near the ball that bound spares most of them, and a step of the solver recomputes only the planes that hold the ball.
//
// Of a fine mesh a ball meets hundreds at once, and is held by three. It knows those near together in groups, each by
// the plane of a flat cylinder around it (surface/discs.h), and looks into one only when the solver is about to make
// its plane hold: what a tick looks at does not grow with the mesh. A group that there is no room to look into stays
// solid.
//
// Lattice units. One servo thread owns one; only the constructor allocates.
#pragma once

#include "runtime/contact/project.h"
#include "runtime/surface/box_tree.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace haptel::runtime {

// What rounding may take from a distance: below 2e-12 of the object.
inline constexpr double distance_rounding = 1;

class NearFaces final : public RenewedRows {
public:
    explicit NearFaces(const Surface& surface);

    // Room for so many.
    static constexpr std::size_t faces_most = 1 << 14;
    // Looked at in one tick before the rest of the way is left to the next: it bounds the time of a tick. From one
    // question for boxes() to the next no more groups are looked into than twice as many.
    static constexpr std::size_t per_tick = 1 << 10;

    // Finds all that come within `radius` of the centre; false: their boxes are more than `most`, and none is kept.
    bool find(const glm::dvec3& centre, double radius, std::size_t most = faces_most) noexcept;
    // The same, in groups as large as keep off a ball of `ball_radius` there.
    bool find_groups(const glm::dvec3& centre, double ball_radius, double radius) noexcept;
    std::size_t count() const noexcept { return faces_.size(); }
    // So many groups were looked into that finding anew costs less than going through all.
    bool is_crowded() const noexcept { return faces_.size() > found_ + per_tick; }
    bool is_full() const noexcept { return faces_.size() + BoxTree::width > faces_.capacity(); }
    // That the tree delivered since it was asked last.
    std::size_t boxes() noexcept { return std::exchange(boxes_, 0); }

    // Picks the triangles that a ball of this radius may touch while its centre stays within `reach` of this one. Their
    // planes are those seen from this centre (`here`), or from one near it before (`before`): whoever is held by one of
    // these renews it. `ahead`: of a triangle that is not touched its own plane where the ball is before
    // that: it comes over the edges of a valley in one step. Where that ends planes have to be laid here.
    enum class Laid : uint8_t { before, here, ahead };
    // Screened: what lies behind the plane of a nearer one is left out. A ball that keeps before that plane does not
    // come to it, and one that slides over an edge is not held by what falls off beyond; a plane that screens others
    // cannot be renewed.
    enum class Screened : uint8_t { no, yes };
    void pick(const glm::dvec3& centre, double radius, double reach, Screened screened, Laid laid) noexcept;
    // Of those picked, as if they were picked again for a shorter reach.
    void keep_near(double reach) noexcept;
    // Of those within reach, screened or not, all that may come within `radius` of a place.
    template <class Visit>
    void for_each_near(const glm::dvec3& at, double radius, Visit&& visit) noexcept
    {
        for (std::size_t i = 0; i < place_of_.size(); ++i) {
            const std::size_t place = place_of_[i];
            const auto is_near = [&] { return glm::dot(planes_[place].normal, at) - planes_[place].offset <= radius; };
            if (!is_group(place) && is_near()) visit(faces_[place]);
            while (is_group(place) && is_near() && renew(static_cast<uint32_t>(i))) {
            }
        }
    }
    // Where its centre may be: in front of each of them by the radius.
    std::span<const HalfSpace> rows() const noexcept override { return picked_; }
    uint32_t face(uint32_t picked) const noexcept { return faces_[place_of_[picked]]; }
    bool is_solid(uint32_t picked) const noexcept { return is_group(place_of_[picked]); } // a group
    // The open_share of the way from the centre, as they are seen from there. As long as it stays in front of the rows
    // `along` it does not meet what lies behind one of those.
    double open(const glm::dvec3& way, double tolerance, std::span<const uint32_t> along = {}) noexcept;

    // Brings those picked to the front that a ball there comes as near to as to any, but for `within`, and counts them;
    // how far before the nearest it is. Unless they screen others they are seen from the centre.
    struct Touching {
        std::size_t count;
        double gap;
    };
    Touching touching(const glm::dvec3& centre, double within) noexcept;
    // Computes the plane of a picked triangle again, as seen from the centre that they are picked from.
    void see_from(const glm::dvec3& centre) noexcept;
    bool renew(uint32_t picked) noexcept override;

    // Of those found none comes nearer to the ball that they were picked for than this.
    double gap() const noexcept;
    // Distance of the nearest one, but at most `most`.
    double distance(const glm::dvec3& centre, double most) noexcept;

private:
    static constexpr uint32_t group = BoxTree::is_face; // of a number in faces_: a node

    bool is_group(std::size_t place) const noexcept { return faces_[place] & group; }
    void keep(std::size_t count) noexcept // the first of those known
    {
        faces_.resize(count), planes_.resize(count), corners_.resize(count), laid_.resize(count);
    }
    bool add_behind(uint32_t node) noexcept;
    bool look_into(std::size_t place) noexcept;
    template <class Visit>
    void for_each_close(Visit&& visit) noexcept;
    bool is_behind(std::size_t place, const HalfSpace& row) const noexcept;
    void lay(std::size_t place) noexcept;
    HalfSpace seen(std::size_t place, Laid laid) const noexcept;
    void pick_screened(Laid laid) noexcept;
    double ahead(const HalfSpace& plane) const noexcept { return glm::dot(plane.normal, centre_) - plane.offset; }

    const Surface* surface_;
    std::vector<uint32_t> faces_; // room for all is made beforehand
    std::size_t boxes_ = 0, found_ = 0;
    std::vector<HalfSpace> planes_;
    std::vector<std::array<glm::dvec3, 3>> corners_; // of each, side by side in memory
    std::vector<uint64_t> laid_;                     // seen from which centre; 0: from none
    std::vector<HalfSpace> picked_;
    std::vector<uint32_t> place_of_; // of those picked, above; then of those that they screen
    bool screened_ = false;
    double radius_ = 0, near_ = 0; // they were picked for,
    glm::dvec3 picked_at_{0};      // from here
    glm::dvec3 found_at_{0};       // those around are known,
    double found_within_ = 0;      // so far
    glm::dvec3 centre_{0};         // seen from here
    uint64_t centres_ = 1;         // so far
    glm::dvec3 renewed_at_{0};     // centre since which planes are as good as those seen from here,
    uint64_t renewed_since_ = 1;   // and its number
};

} // namespace haptel::runtime
