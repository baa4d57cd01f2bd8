// The passes that produce geometry: deformation of vertices, and the geometry buffer.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

// Skinning and morphing. A compute shader writes the deformed vertices once for each group of views; all
// other passes draw them like static ones.
class DeformPass {
  public:
    DeformPass() = default;
    static Result<DeformPass> create(const PassSetup& setup);

    // Deforms all deformable parts of the scene. parts() then returns the results, ready as vertex buffers.
    Status draw(PassContext& context);
    [[nodiscard]] const DeformedParts& parts() const { return parts_; }
    // Returns the buffer with the deformed vertices, which may be a source of copies.
    [[nodiscard]] const gpu::Buffer& vertices() const { return vertices_; }

  private:
    struct Job {
        const Object* object = nullptr;
        const MeshPart* part = nullptr;
        shared::DeformPart constants{};  // push constants
    };
    Status plan(PassContext& context, std::vector<Job>& jobs);
    Result<VkDescriptorSet> descriptor_set_for(PassContext& context, const Object& object);

    gpu::Pipeline pipeline_;
    gpu::Buffer vertices_;  // shared by frames in flight: the GPU executes them one after the other
    DeformedParts parts_;
};

// Draws depth and a geometry buffer of normal, material and grain (the brushing direction of a metal), four
// samples per pixel. Base colour, metallic, roughness and occlusion that are not the material's constants
// (maps, vertex colours, tints) are written to a second buffer, the material buffer, which exists only if
// needed.
class SurfacePass {
  public:
    static Result<SurfacePass> create(const PassSetup& setup) { return SurfacePass(setup); }

    // Leaves `targets.depth` in ResourceUse::depth_read and the geometry buffers in ResourceUse::sampled.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list);

    SurfacePass() = default;

  private:
    explicit SurfacePass(const PassSetup& setup) : cache_(&setup.cache), shaders_(&setup.shaders) {}
    Result<const gpu::Pipeline*> pipeline(gpu::Device& device, const PipelineKind& kind, std::uint32_t views,
                                          bool per_pixel_material);
    // Draws Eye::hidden at the nearest depth, without colour.
    Status draw_hidden_area(PassContext& context, VkSampleCountFlagBits samples_per_pixel,
                            const std::vector<VkFormat>& colors);
    // Sets the kept depth in the hidden area to 0, the farthest. With the nearest depth, a runtime that
    // reprojects pictures by their depth would move these black pixels into the visible area.
    Status clear_hidden_depth(PassContext& context, const RenderTargets& targets);

    struct PipelineKey {
        PipelineKind kind;
        std::uint32_t views = 1;
        bool per_pixel_material = false;
        friend auto operator<=>(const PipelineKey&, const PipelineKey&) = default;
    };
    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<PipelineKey, gpu::Pipeline> pipelines_;
    // By number of views, samples per pixel, and number of colour targets.
    std::map<std::tuple<std::uint32_t, VkSampleCountFlagBits, std::size_t>, gpu::Pipeline> hidden_areas_;
};

}  // namespace bolt::render
