#include "radiosity/facet_hits.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "mesh/walk.h"

namespace tyndall::radiosity {
namespace {

// Of the hull's diagonal: well above single precision's rounding of coordinates about its centre.
constexpr double above_surface = 4e-6;
// Of the same: how far past an interface the next facet is looked for.
constexpr double past_interface = 2e-7;

}  // namespace

struct FacetHits::Tree {
    // A triangle: a facet, or a face of the hull (no facet).
    struct Triangle {
        FacetId facet;
        bool opaque = false;
        std::array<std::uint32_t, 2> media{none, none};  // on its front and back
        Point corner{0.0};
        Direction normal{0.0};  // towards the front; of the hull: outwards
    };

    const Enclosure& e;
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = device ? rtcNewScene(device) : nullptr;
    Point centre;
    double diagonal;
    std::vector<Triangle> triangles;
    std::vector<std::array<mesh::VertexId, 3>> corners;

    explicit Tree(const Enclosure& enclosure)
        : e(enclosure),
          centre(0.5 * (e.mesh.hull_min + e.mesh.hull_max)),
          diagonal(glm::distance(e.mesh.hull_min, e.mesh.hull_max)) {
        if (!device || !scene)
            throw std::runtime_error("Embree cannot be started on this machine.");
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        for (std::size_t f = 0; f < e.mesh.facets.size(); ++f) add_facet(FacetId(f));
        for (std::size_t t = 0; t < e.mesh.tets.size(); ++t)
            for (int k = 0; k < 4; ++k) add_hull(TetId(t), k);
        build();
    }
    ~Tree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    std::uint32_t medium_in(TetId tet) const {
        return !tet.valid() || e.solid(tet) ? none : e.medium_of(tet);
    }

    void add_facet(FacetId id) {
        const auto& facet = e.mesh.facets[id.value];
        const bool opaque = facet.opacity == mesh::Opacity::opaque;
        const std::array media{medium_in(facet.tets[0]), medium_in(facet.tets[1])};
        if (!opaque && media[0] == media[1]) return;
        triangles.push_back(
            {id, opaque, media, e.mesh.points[facet.corners[0].value], mesh::normal(e.mesh, id)});
        corners.push_back(facet.corners);
    }

    void add_hull(TetId tet, int face) {
        if (e.mesh.neighbours[tet.value][face].valid()) return;
        const FacetId facet = e.mesh.tet_facets[tet.value][face];
        if (facet.valid() && e.mesh.facets[facet.value].opacity == mesh::Opacity::opaque) return;
        std::array<mesh::VertexId, 3> c;
        for (int k = 0; k < 3; ++k) c[k] = e.mesh.tets[tet.value][mesh::face_corners[face][k]];
        const auto& p = e.mesh.points;
        const Point a = p[c[0].value];
        const Direction normal = glm::normalize(glm::cross(p[c[1].value] - a, p[c[2].value] - a));
        triangles.push_back({FacetId(), false, {none, medium_in(tet)}, a, normal});
        corners.push_back(c);
    }

    void build() {
        if (!triangles.empty()) {
            RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            auto* points = static_cast<float*>(
                rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                        3 * sizeof(float), e.mesh.points.size()));
            auto* indices = static_cast<unsigned*>(
                rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        3 * sizeof(unsigned), triangles.size()));
            for (std::size_t k = 0; k < e.mesh.points.size(); ++k)
                for (int axis = 0; axis < 3; ++axis)
                    points[3 * k + axis] = float(e.mesh.points[k][axis] - centre[axis]);
            for (std::size_t t = 0; t < triangles.size(); ++t)
                for (int k = 0; k < 3; ++k) indices[3 * t + k] = corners[t][k].value;
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene, geometry);
            rtcReleaseGeometry(geometry);
        }
        rtcCommitScene(scene);
    }

    // The next triangle between begin and end, and how far along it is in double precision.
    const Triangle* next(Point origin, Direction d, double begin, double end,
                         double& distance) const {
        RTCRayHit query{};
        const Point o = origin - centre;
        query.ray.org_x = float(o.x);
        query.ray.org_y = float(o.y);
        query.ray.org_z = float(o.z);
        query.ray.dir_x = float(d.x);
        query.ray.dir_y = float(d.y);
        query.ray.dir_z = float(d.z);
        query.ray.tnear = float(begin);
        query.ray.tfar = float(std::min(end, 1e30));
        query.ray.mask = ~0u;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return nullptr;
        const Triangle& triangle = triangles[query.hit.primID];
        distance = query.ray.tfar;
        const double slope = glm::dot(triangle.normal, d);
        const double exact = glm::dot(triangle.normal, triangle.corner - origin) / slope;
        if (std::abs(exact - distance) < past_interface * diagonal) distance = exact;
        distance = std::max(distance, begin);
        return &triangle;
    }
};

FacetHits::FacetHits(const Enclosure& enclosure)
    : tree_(std::make_unique<Tree>(enclosure)), offset_(above_surface * tree_->diagonal) {}
FacetHits::~FacetHits() = default;
FacetHits::FacetHits(FacetHits&&) noexcept = default;
FacetHits& FacetHits::operator=(FacetHits&&) noexcept = default;

namespace {

void add(std::vector<Stretch>& stretches, std::uint32_t medium, double begin, double end) {
    if (medium != none && end > begin) stretches.push_back({medium, begin, end});
}

}  // namespace

void FacetHits::look(Point origin, Direction direction, std::uint32_t medium, Sight& sight) const {
    const Tree& tree = *tree_;
    sight.stretches.clear();
    sight.end = SightEnd::outside;
    sight.distance = infinity;
    sight.facet = FacetId();
    sight.surface = none;
    double from = 0.0, begin = 0.0, at = 0.0;
    for (;;) {
        const auto* hit = tree.next(origin, direction, begin, infinity, at);
        if (!hit) return;  // beyond the hull there is nothing
        const bool front = glm::dot(hit->normal, direction) < 0.0;
        medium = hit->media[front ? 0 : 1];
        add(sight.stretches, medium, from, at);
        if (hit->opaque) {
            sight.end = SightEnd::surface;
            sight.distance = at;
            sight.facet = hit->facet;
            sight.side = front ? Side::front : Side::back;
            sight.surface = tree.e.facet_sides[hit->facet.value][front ? 0 : 1];
            sight.medium = medium;
            sight.normal = front ? hit->normal : -hit->normal;
            return;
        }
        if (!hit->facet.valid() && !front) return;  // out through the hull
        from = at;
        begin = at + past_interface * tree.diagonal;
    }
}

bool FacetHits::sees(Point origin, Point target, std::uint32_t medium,
                     std::vector<Stretch>& stretches) const {
    const Tree& tree = *tree_;
    stretches.clear();
    const double length = glm::distance(origin, target);
    const Direction direction = (target - origin) / length;
    const double end = length - 2.0 * offset_;
    double from = 0.0, begin = 0.0, at = 0.0;
    while (begin < end) {
        const auto* hit = tree.next(origin, direction, begin, end, at);
        if (!hit) break;
        if (hit->opaque) return false;
        const bool front = glm::dot(hit->normal, direction) < 0.0;
        add(stretches, hit->media[front ? 0 : 1], from, at);
        medium = hit->media[front ? 1 : 0];
        from = at;
        begin = at + past_interface * tree.diagonal;
    }
    add(stretches, medium, from, length);
    return true;
}

bool FacetHits::sees_out(Point origin, Direction direction, std::uint32_t medium,
                         std::vector<Stretch>& stretches) const {
    thread_local Sight sight;
    look(origin, direction, medium, sight);
    stretches.swap(sight.stretches);
    return sight.end == SightEnd::outside;
}

}  // namespace tyndall::radiosity
