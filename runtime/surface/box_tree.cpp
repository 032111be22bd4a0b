#include "runtime/surface/box_tree.h"

#if HAPTEL_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <limits>

namespace haptel::runtime {

namespace {

// Embree sees the object within [-1, 1] and the workspace within [-4, 4].
constexpr double scale = 1.0 / Lattice::extent;

// Rounding to float moves a query's start by half an ulp of 4 and its end by half an ulp of 8 more. Four ulps of 4
// cover that twice, and the rounding of the boxes.
constexpr float widening = 4.0f * 0x1p-21f;

glm::vec3 embree_point(const glm::dvec3& p)
{
    return glm::vec3(p * scale);
}

#if RTC_VERSION_MAJOR >= 4
using QueryContext = RTCRayQueryContext;
void init(QueryContext& context)
{
    rtcInitRayQueryContext(&context);
}
void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
void init(QueryContext& context)
{
    rtcInitIntersectContext(&context);
}
void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray)
{
    rtcIntersect1(scene, &context, &ray);
}
#endif

// Embree hands the context back to the callback: first the part it knows, then ours.
struct SegmentQuery {
    QueryContext embree;
    SegmentVisitor* visitor;
};

// The fraction as Embree may compare it: rounded up, past any rounding of its own.
float rounded_up(double fraction)
{
    return float(fraction * (1.0 + 1e-6) + 1e-30);
}

void visit_face(const RTCIntersectFunctionNArguments* arguments)
{
    if (!arguments->valid[0]) return;
    SegmentQuery& query = *reinterpret_cast<SegmentQuery*>(arguments->context);
    const float upto = rounded_up(query.visitor->visit(arguments->primID));
    RTCRayHit& ray = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
    if (upto < ray.ray.tfar) {
        ray.ray.tfar = upto;
        ray.hit.geomID = arguments->geomID;
        ray.hit.primID = arguments->primID;
    }
}

struct Boxes {
    const std::vector<glm::dvec3>& vertices;
    const std::vector<Face>& faces;

    void of(uint32_t face, glm::dvec3& minimum, glm::dvec3& maximum) const
    {
        const auto& corners = faces[face].vertex;
        const glm::dvec3 &a = vertices[corners[0]], &b = vertices[corners[1]], &c = vertices[corners[2]];
        minimum = glm::min(a, glm::min(b, c));
        maximum = glm::max(a, glm::max(b, c));
    }
};

void box_of_face(const RTCBoundsFunctionArguments* arguments)
{
    glm::dvec3 minimum, maximum;
    static_cast<const Boxes*>(arguments->geometryUserPtr)->of(arguments->primID, minimum, maximum);
    const glm::vec3 low = embree_point(minimum) - widening, high = embree_point(maximum) + widening;
    *arguments->bounds_o = {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
}

struct BallQuery {
    const Boxes& boxes;
    glm::dvec3 centre;
    double radius;
    BallVisitor& visitor;
};

// As Embree may compare it: past any rounding of its own.
float query_radius(double radius)
{
    return float(radius * scale) * (1.0f + 1e-6f) + widening;
}

bool visit_box(RTCPointQueryFunctionArguments* arguments)
{
    BallQuery& query = *static_cast<BallQuery*>(arguments->userPtr);
    glm::dvec3 minimum, maximum;
    query.boxes.of(arguments->primID, minimum, maximum);
    const glm::dvec3 away = query.centre - glm::clamp(query.centre, minimum, maximum);
    if (glm::dot(away, away) > query.radius * query.radius) return false;
    const double upto = query.visitor.visit(arguments->primID);
    if (!(upto < query.radius)) return false;
    query.radius = upto;
    arguments->query->radius = upto > 0 ? query_radius(upto) : 0;
    return true;
}

struct BallList {
    std::size_t most;
    std::vector<uint32_t>& faces;
    bool more = false;
};

bool list_face(RTCPointQueryFunctionArguments* arguments)
{
    BallList& list = *static_cast<BallList*>(arguments->userPtr);
    list.more = list.faces.size() == list.most;
    if (!list.more) {
        list.faces.push_back(arguments->primID);
        return false;
    }
    arguments->query->radius = 0; // that is enough
    return true;
}

void ask(RTCScene scene, const glm::dvec3& centre, double radius, RTCPointQueryFunction told, void* asker)
{
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const glm::vec3 at = embree_point(centre);
    RTCPointQuery query = {};
    query.x = at.x, query.y = at.y, query.z = at.z;
    query.radius = query_radius(radius);
    rtcPointQuery(scene, &query, &context, told, asker);
}

// One device for the process; a single thread, so that building does not start others behind the servo's back.
RTCDevice embree()
{
    static const RTCDevice device = rtcNewDevice("threads=1");
    return device;
}

} // namespace

struct BoxTree::Handles {
    Boxes boxes;
    RTCScene scene = nullptr;

    ~Handles()
    {
        if (scene) rtcReleaseScene(scene);
    }
};

BoxTree::~BoxTree() = default;

std::unique_ptr<const BoxTree> BoxTree::build(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                              std::string& error)
{
    const RTCDevice device = embree();
    if (!device) {
        error = "cannot start Embree, the collision tree";
        return nullptr;
    }
    std::unique_ptr<BoxTree> tree(new BoxTree);
    tree->handles_.reset(new Handles{{vertices, faces}});
    tree->handles_->scene = rtcNewScene(device);
    rtcSetSceneFlags(tree->handles_->scene, RTC_SCENE_FLAG_ROBUST);

    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, uint32_t(faces.size()));
    rtcSetGeometryUserData(geometry, &tree->handles_->boxes);
    rtcSetGeometryBoundsFunction(geometry, box_of_face, nullptr);
    rtcSetGeometryIntersectFunction(geometry, visit_face);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree->handles_->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(tree->handles_->scene);

    if (const RTCError code = rtcGetDeviceError(device); code != RTC_ERROR_NONE) {
        error = "cannot build the collision tree: Embree reports error " + std::to_string(int(code));
        return nullptr;
    }
    return tree;
}

void BoxTree::segment(const glm::dvec3& from, const glm::dvec3& to, SegmentVisitor& visitor) const noexcept
{
    SegmentQuery query;
    init(query.embree);
    query.visitor = &visitor;

    const glm::vec3 start = embree_point(from), along = embree_point(to - from);
    RTCRayHit ray = {};
    ray.ray.org_x = start.x, ray.ray.org_y = start.y, ray.ray.org_z = start.z;
    ray.ray.dir_x = along.x, ray.ray.dir_y = along.y, ray.ray.dir_z = along.z;
    ray.ray.tfar = rounded_up(1.0);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(handles_->scene, query.embree, ray);
}

void BoxTree::ball(const glm::dvec3& centre, double radius, BallVisitor& visitor) const noexcept
{
    BallQuery ball{handles_->boxes, centre, radius, visitor};
    ask(handles_->scene, centre, radius, visit_box, &ball);
}

bool BoxTree::ball(const glm::dvec3& centre, double radius, std::size_t most,
                   std::vector<uint32_t>& faces) const noexcept
{
    faces.clear();
    BallList list{most, faces};
    ask(handles_->scene, centre, radius, list_face, &list);
    return !list.more;
}

} // namespace haptel::runtime
