// Peer: the Flexible Collision Library. Triangles against triangles in trees of oriented boxes, up to 1,000
// contacts.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include "tools/bench/contact_peers.hpp"

namespace bolt::bench {
namespace {

using FclModel = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<FclModel> make_fcl_model(Parts parts) {
    auto model = std::make_shared<FclModel>();
    model->beginModel();
    for (const collision::ContactMesh& part : parts)
        for (std::size_t t = 0; t < part.triangles.size(); ++t) {
            const auto [a, b, c] = corners(part, t);
            const auto at = [](const Vec3& p) { return fcl::Vector3d(p.x, p.y, p.z); };
            model->addTriangle(at(a), at(b), at(c));
        }
    model->endModel();
    return model;
}

class Fcl final : public Peer {
  public:
    Fcl(Parts casing, Parts tool)
        : casing_(make_fcl_model(casing), fcl::Transform3d::Identity()),
          tool_(make_fcl_model(tool), fcl::Transform3d::Identity()) {}
    bool touches(const Pose& pose) override {
        const Quat& q = pose.orientation;
        tool_.setTransform(fcl::Quaterniond(q.w, q.x, q.y, q.z),
                           fcl::Vector3d(pose.position.x, pose.position.y, pose.position.z));
        const fcl::CollisionRequestd request(1000, true);
        fcl::CollisionResultd result;
        return fcl::collide(&tool_, &casing_, request, result) > 0;
    }

  private:
    fcl::CollisionObjectd casing_, tool_;
};

}  // namespace

std::unique_ptr<Peer> make_fcl(Parts casing, Parts tool) { return std::make_unique<Fcl>(casing, tool); }

}  // namespace bolt::bench
