// Peer: Bullet. The casing is a triangle tree. The tool is a set of convex hulls, because Bullet needs convex
// moving bodies. Each hull holds one slice across the tool's longest side; the hulls fill the jaw. The times
// are comparable, the contacts are not.
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <glm/common.hpp>

#include "tools/bench/contact_peers.hpp"

namespace bolt::bench {
namespace {

btVector3 to_bullet(const Vec3& p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

struct ContactCounter : btCollisionWorld::ContactResultCallback {
    int count = 0;
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
        ++count;
        return 0;
    }
};

class Bullet final : public Peer {
  public:
    Bullet(Parts casing, Parts tool) {
        for (const collision::ContactMesh& part : casing)
            for (std::size_t t = 0; t < part.triangles.size(); ++t) {
                const auto [a, b, c] = corners(part, t);
                triangles_.addTriangle(to_bullet(a), to_bullet(b), to_bullet(c));
            }
        casing_shape_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
        casing_.setCollisionShape(casing_shape_.get());
        add_hulls(tool);
        tool_.setCollisionShape(&tool_shape_);
        world_.addCollisionObject(&casing_);
        world_.addCollisionObject(&tool_);
    }
    ~Bullet() override {
        world_.removeCollisionObject(&tool_);
        world_.removeCollisionObject(&casing_);
    }
    Bullet(const Bullet&) = delete;
    Bullet& operator=(const Bullet&) = delete;

    bool touches(const Pose& pose) override {
        const Quat q(pose.orientation);
        const btQuaternion turn(static_cast<btScalar>(q.x), static_cast<btScalar>(q.y),
                                static_cast<btScalar>(q.z), static_cast<btScalar>(q.w));
        tool_.setWorldTransform(btTransform(turn, to_bullet(pose.position)));
        ContactCounter contacts;
        world_.contactPairTest(&tool_, &casing_, contacts);
        return contacts.count > 0;
    }

  private:
    void add_hulls(Parts tool) {
        constexpr std::size_t slices = 24;
        Vec3 low(1e9);
        Vec3 high(-1e9);
        for (const collision::ContactMesh& part : tool)
            for (const glm::vec3& v : part.vertices) {
                low = glm::min(low, Vec3(v));
                high = glm::max(high, Vec3(v));
            }
        const Vec3 size = high - low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        for (std::size_t i = 0; i < slices; ++i) hulls_.push_back(std::make_unique<btConvexHullShape>());
        // A triangle belongs to all slices that it spans.
        const auto slice = [&](const Vec3& p) {
            const double share = (p[axis] - low[axis]) / size[axis];
            return std::min(slices - 1, static_cast<std::size_t>(share * static_cast<double>(slices)));
        };
        for (const collision::ContactMesh& part : tool)
            for (std::size_t t = 0; t < part.triangles.size(); ++t) {
                const auto face = corners(part, t);
                const auto [first, last] = std::minmax({slice(face[0]), slice(face[1]), slice(face[2])});
                for (std::size_t s = first; s <= last; ++s)
                    for (const Vec3& p : face) hulls_[s]->addPoint(to_bullet(p), false);
            }
        for (const auto& hull : hulls_) {
            hull->optimizeConvexHull();
            hull->recalcLocalAabb();
            hull->setMargin(0);
            tool_shape_.addChildShape(btTransform::getIdentity(), hull.get());
        }
    }

    btTriangleMesh triangles_;
    std::unique_ptr<btBvhTriangleMeshShape> casing_shape_;
    std::vector<std::unique_ptr<btConvexHullShape>> hulls_;
    btCompoundShape tool_shape_;
    btCollisionObject casing_, tool_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

}  // namespace

std::unique_ptr<Peer> make_bullet(Parts casing, Parts tool) { return std::make_unique<Bullet>(casing, tool); }

}  // namespace bolt::bench
