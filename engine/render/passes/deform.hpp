// Skinning and morphing: a compute shader writes the deformed vertices once, and all other passes draw them
// like static ones.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class DeformPass {
  public:
    DeformPass() = default;
    static Result<DeformPass> create(const PassMaker& maker);

    // Deforms all deformable parts of the scene; the results are in parts(), ready as vertex buffers.
    Status draw(PassContext& context);
    [[nodiscard]] const DeformedParts& parts() const { return parts_; }
    // The buffer of the deformed vertices, which may be copied from.
    [[nodiscard]] const gpu::Buffer& vertices() const { return vertices_; }

  private:
    struct Job {
        const Object* object = nullptr;
        const MeshPart* part = nullptr;
        shared::DeformPart numbers{};
    };
    Status plan(PassContext& context, std::vector<Job>& jobs);
    Result<VkDescriptorSet> set_for(PassContext& context, const Object& object);

    gpu::Pipeline pipeline_;
    gpu::Buffer vertices_;  // shared by frames in flight: the GPU executes them one after the other
    DeformedParts parts_;
};

}  // namespace bolt::render
