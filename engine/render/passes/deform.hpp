// Vertices of what bends, where joints and morph targets move them: a compute shader writes them once, and
// all other passes draw them as they draw any others.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class DeformPass {
  public:
    DeformPass() = default;
    static Result<DeformPass> create(const PassMaker& maker);

    // Everything of the scene that bends, into `parts()`. Vertex buffers may be drawn from it afterwards.
    Status draw(PassContext& context);
    [[nodiscard]] const DeformedParts& parts() const { return parts_; }
    // What the parts lie in; may be copied from.
    [[nodiscard]] const gpu::Buffer& vertices() const { return vertices_; }

  private:
    struct Job {
        const Object* object = nullptr;
        const Part* part = nullptr;
        shared::DeformPart numbers{};
    };
    Status plan(PassContext& context, std::vector<Job>& jobs);
    Result<VkDescriptorSet> set_for(PassContext& context, const Object& object);

    gpu::Pipeline pipeline_;
    gpu::Buffer vertices_;  // of all frames in flight: the GPU works on one after the other
    DeformedParts parts_;
};

}  // namespace bolt::render
