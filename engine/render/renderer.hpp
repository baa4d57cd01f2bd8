// The frame, from the scene to a picture: an ordered list of passes (frame.cpp reads like it).
//
//   shadow   depth of what light 0 sees; kept while nothing in it moves
//   occlusion  how much light neighbours keep away, at half the size, if the scene asks for it
//   scene    everything, 4 samples a pixel, lit and tone-mapped, resolved into the target
//
// Several views are drawn in one pass by multiview, a layer each; on software rasterisers one after the
// other, each into images of its own: on lavapipe (Mesa 22.3) the sky did not appear in any layer but the
// first, with and without multiview, for a reason that was not found.
#pragma once

#include <array>
#include <map>

#include "engine/gpu/descriptors.hpp"
#include "engine/render/draw_list.hpp"

namespace bolt::render {

// Pictures are 8-bit sRGB, one layer a view.
inline constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_SRGB;
inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat occlusion_format = VK_FORMAT_R8_UNORM;

struct RendererOptions {
    std::uint32_t shadow_size = 2048;
    std::filesystem::path pipeline_cache;  // empty: none on disk
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_4_BIT;
    enum class Multiview : std::uint8_t {
        where_it_works,
        always,
        never
    } multiview = Multiview::where_it_works;
};

// Images as large as a picture, with a layer for each view that is drawn in the same pass.
struct Targets {
    gpu::Image drawn, depth, picture;
    gpu::Image small_depth, raw_occlusion, occlusion;  // half the size; made when a scene asks for them
};

// Where a view's picture is.
struct Layer {
    const gpu::Image* image = nullptr;
    std::uint32_t layer = 0;
};

struct Statistics {
    std::uint64_t triangles = 0;
    std::uint32_t draws = 0, instances = 0;
    bool shadow_drawn = false;
};

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(gpu::Device& device, const RendererOptions& options);

    // Records a frame. The pictures are in use `transfer_from` afterwards.
    Status render(gpu::Frame& frame, const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent);

    [[nodiscard]] Layer picture(std::uint32_t view) const {
        return {&targets_[view / views_a_pass_].picture, view % views_a_pass_};
    }
    [[nodiscard]] const Statistics& statistics() const { return statistics_; }
    [[nodiscard]] Status save_pipelines() const { return cache_.save(); }

  private:
    struct Passes;  // frame.cpp

    Status prepare(const RendererOptions& options);
    Status resize(gpu::Frame& frame, VkExtent2D extent, std::uint32_t views);
    [[nodiscard]] bool multiview() const;
    Result<const gpu::Pipeline*> scene_pipeline(const Kind& kind, std::uint32_t views);
    Result<const gpu::Pipeline*> sky_pipeline(std::uint32_t views);
    struct OcclusionPipelines {
        gpu::Pipeline depth, slices, smooth;
    };
    Result<const OcclusionPipelines*> occlusion_pipelines(std::uint32_t views);
    Status make_occlusion_targets(Targets& targets);

    gpu::Device* device_ = nullptr;
    RendererOptions options_;
    gpu::PipelineCache cache_;
    std::map<std::string, gpu::Shader> shaders_;
    gpu::Pipeline shadow_pipeline_;
    std::map<std::pair<Kind, std::uint32_t>, gpu::Pipeline> scene_pipelines_;
    std::map<std::uint32_t, gpu::Pipeline> sky_pipelines_;
    std::map<std::uint32_t, OcclusionPipelines> occlusion_pipelines_;
    gpu::Image albedo_table_, shadow_map_;
    EnvironmentLight no_environment_;
    gpu::Sampler clamped_, comparing_, nearest_;
    GpuTexture white_;
    gpu::ImageView white_array_;
    std::vector<Targets> targets_;  // one a pass
    VkExtent2D extent_{};
    std::uint32_t views_ = 0, views_a_pass_ = 1;
    std::uint64_t shadow_key_ = 0;  // of what the shadow map holds; 0: nothing
    Statistics statistics_;
};

}  // namespace bolt::render
