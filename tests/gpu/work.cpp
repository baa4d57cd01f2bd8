// Compute, drawing and transfers on the GPU, over many frames, without validation messages.
#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "engine/base/file.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/gpu/resources.hpp"
#include "tests/gpu/shaders.hpp"
#include "tests/gpu/support.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::gpu;

namespace {

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

template <class T>
void write(const TransientRange& piece, const T& value) {
    std::memcpy(piece.bytes.data(), &value, sizeof value);
}

}  // namespace

TEST_CASE("Compute: a shader doubles numbers in every frame, and transient memory grows on demand") {
    test::Gpu gpu;
    Device& device = gpu.device();
    const PipelineCache cache = gpu.need(PipelineCache::open(device, {}));
    const Shader shader = gpu.need(make_shader("double.comp", test_shaders("double.comp")));
    const Pipeline pipeline = gpu.need(make_compute_pipeline(device, cache, shader));
    const auto frames = gpu.need(Frames::create(device));
    constexpr std::uint32_t n = 1000;
    for (std::uint32_t round = 0; round < 7; ++round) {
        FrameContext& frame = *gpu.need(frames->begin());
        const VkCommandBuffer commands = frame.commands();
        frame.begin_timing("double");
        // Later rounds exceed the first buffer of 1 MiB.
        const TransientRange padding = gpu.need(frame.allocate(VkDeviceSize{300'000} * (round + 1)));
        CHECK(padding.bytes.size() == std::size_t{300'000} * (round + 1));
        const TransientRange values = gpu.need(frame.allocate(n * sizeof(std::uint32_t)));
        std::vector<std::uint32_t> numbers(n);
        std::iota(numbers.begin(), numbers.end(), round);
        std::memcpy(values.bytes.data(), numbers.data(), values.bytes.size());
        DescriptorWriter writer = gpu.need(DescriptorWriter::create(device, frame, pipeline, 0));
        const VkDescriptorSet set = gpu.need(writer.range(0, values).finish());
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle.get());
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout.get(), 0, 1, &set,
                                0, nullptr);
        vkCmdDispatch(commands, (n + 63) / 64, 1, 1);
        memory_barrier(commands, ResourceUse::storage_write, ResourceUse::host_read);
        frame.end_timing();
        gpu.need(frames->submit(frame));
        gpu.need(device.idle());
        std::vector<std::uint32_t> doubled(n);
        std::memcpy(doubled.data(), values.bytes.data(), values.bytes.size());
        for (std::uint32_t i = 0; i < n; ++i) REQUIRE(doubled[i] == 2 * (i + round));
    }
    gpu.need(frames->finish());
    REQUIRE(frames->timings().size() == 1);
    CHECK(frames->timings()[0].name == "double");
    CHECK(frames->timings()[0].milliseconds >= 0.0);
}

TEST_CASE("Frames: many descriptor sets can be allocated, and retired resources are freed") {
    test::Gpu gpu;
    Device& device = gpu.device();
    const PipelineCache cache = gpu.need(PipelineCache::open(device, {}));
    const Shader shader = gpu.need(make_shader("double.comp", test_shaders("double.comp")));
    const Pipeline pipeline = gpu.need(make_compute_pipeline(device, cache, shader));
    const auto frames = gpu.need(Frames::create(device));
    const VkDeviceSize before = device.memory().bytes_in_use();
    for (int round = 0; round < 5; ++round) {
        FrameContext& frame = *gpu.need(frames->begin());
        for (int i = 0; i < 700; ++i) (void)gpu.need(frame.descriptor_set(pipeline.sets[0].get()));
        frame.retire(
            gpu.need(Buffer::create(device, 1 << 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::device)));
        gpu.need(frames->submit(frame));
    }
    gpu.need(frames->finish());
    CHECK(device.memory().bytes_in_use() == before);
}

TEST_CASE("Drawing: a triangle covers the expected pixels with multisampling, depth and a resolve") {
    test::Gpu gpu;
    Device& device = gpu.device();
    constexpr VkExtent2D extent{64, 64};
    constexpr VkFormat format = VK_FORMAT_R8G8B8A8_UNORM, depth_format = VK_FORMAT_D32_SFLOAT;
    const PipelineCache cache = gpu.need(PipelineCache::open(device, {}));
    const Shader vertex = gpu.need(make_shader("triangle.vert", test_shaders("triangle.vert")));
    const Shader fragment = gpu.need(make_shader("triangle.frag", test_shaders("triangle.frag")));
    GraphicsInfo info;
    info.vertex = &vertex;
    info.fragment = &fragment;
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0},
                    {3, VK_FORMAT_R32G32_SFLOAT, 0, 12},
                    {5, VK_FORMAT_R32_SFLOAT, 0, 0}};
    info.strides = {20};
    info.colors = {format};
    info.depth = depth_format;
    info.samples = VK_SAMPLE_COUNT_4_BIT;
    const Pipeline red = gpu.need(make_graphics_pipeline(device, cache, info));
    info.constants = 1;
    const Pipeline green = gpu.need(make_graphics_pipeline(device, cache, info));

    // Counter-clockwise with y up; y goes down in Vulkan, so the view flips it. It covers half of the
    // picture.
    const std::vector<float> corners{-1, -1, 0.5F, 0, 0, 1, -1, 0.5F, 0, 0, -1, 1, 0.5F, 0, 0};
    const Buffer vertices =
        gpu.need(upload_buffer(device, bytes_of(corners), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
    const std::vector<float> palette{0, 0, 0, 0, 1, 0, 0, 1};
    const Buffer colors =
        gpu.need(upload_buffer(device, bytes_of(palette), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
    ImageInfo texture_info{
        format,
        {4, 4},
        3,
        1,
        false,
        VK_SAMPLE_COUNT_1_BIT,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    Image texture = gpu.need(Image::create(device, texture_info));
    gpu.need(upload_image(device, texture, bytes_of(std::vector<std::uint8_t>(64, 100))));
    const Sampler sampler = gpu.need(make_sampler(device, {}));

    ImageInfo many{format, extent, 1, 1, false, VK_SAMPLE_COUNT_4_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
    const Image drawn = gpu.need(Image::create(device, many));
    ImageInfo one{format,
                  extent,
                  1,
                  1,
                  false,
                  VK_SAMPLE_COUNT_1_BIT,
                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    const Image resolved = gpu.need(Image::create(device, one));
    ImageInfo deep{depth_format,
                   extent,
                   1,
                   1,
                   false,
                   VK_SAMPLE_COUNT_4_BIT,
                   VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
    const Image depth = gpu.need(Image::create(device, deep));
    const ImageRange depth_range{VK_IMAGE_ASPECT_DEPTH_BIT};

    const auto frames = gpu.need(Frames::create(device));
    for (int round = 0; round < 3; ++round) {
        FrameContext& frame = *gpu.need(frames->begin());
        const VkCommandBuffer commands = frame.commands();
        image_barrier_discarding(commands, drawn.get(), ResourceUse::color_target, ResourceUse::color_target);
        image_barrier_discarding(commands, resolved.get(), ResourceUse::transfer_from,
                                 ResourceUse::color_target);
        image_barrier_discarding(commands, depth.get(), ResourceUse::depth_target, ResourceUse::depth_target,
                                 depth_range);
        VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        color.imageView = drawn.view();
        color.imageLayout = color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
        color.resolveImageView = resolved.view();
        color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        color.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        color.clearValue.color = {{0.0F, 0.0F, 1.0F, 1.0F}};
        VkRenderingAttachmentInfo behind{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        behind.imageView = depth.view();
        behind.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        behind.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        behind.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
        rendering.renderArea.extent = extent;
        rendering.layerCount = 1;
        rendering.colorAttachmentCount = 1;
        rendering.pColorAttachments = &color;
        rendering.pDepthAttachment = &behind;
        vkCmdBeginRendering(commands, &rendering);
        const VkViewport viewport{0, 0, 64, 64, 0, 1};
        const VkRect2D scissor{{0, 0}, extent};
        vkCmdSetViewport(commands, 0, 1, &viewport);
        vkCmdSetScissor(commands, 0, 1, &scissor);
        const TransientRange view = gpu.need(frame.allocate(64));
        write(view, std::array<float, 16>{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        const VkBuffer buffer = vertices.get();
        const VkDeviceSize zero = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &zero);
        // Green is half a picture to the right and farther away: red wins where both cover a pixel.
        for (const Pipeline* pipeline : {&red, &green}) {
            DescriptorWriter writer = gpu.need(DescriptorWriter::create(device, frame, *pipeline, 0));
            std::vector<VkDescriptorImageInfo> pair(
                2, {sampler.get(), texture.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
            const VkDescriptorSet sets[] = {
                gpu.need(writer.range(0, view).images(2, pair).finish()),
                gpu.need(gpu.need(DescriptorWriter::create(device, frame, *pipeline, 1))
                             .buffer(0, colors.get(), 0, VK_WHOLE_SIZE)
                             .finish())};
            const std::array<float, 4> offset =
                pipeline == &red ? std::array<float, 4>{0, 0, 0, 0} : std::array<float, 4>{1, 0, -0.25F, 0};
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->handle.get());
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout.get(), 0, 2,
                                    sets, 0, nullptr);
            vkCmdPushConstants(commands, pipeline->layout.get(), pipeline->push_stages, 0, 16, offset.data());
            vkCmdDraw(commands, 3, 1, 0, 0);
        }
        vkCmdEndRendering(commands);
        image_barrier(commands, resolved.get(), ResourceUse::color_target, ResourceUse::transfer_from);
        gpu.need(frames->submit(frame));
    }
    gpu.need(frames->finish());
    const std::vector<std::byte> texels =
        gpu.need(download_image(device, resolved, ResourceUse::transfer_from, 4));
    const auto at = [&](std::size_t x, std::size_t y) {
        std::array<int, 4> rgba{};
        for (std::size_t c = 0; c < 4; ++c) rgba[c] = std::to_integer<int>(texels[4 * (y * 64 + x) + c]);
        return rgba;
    };
    // Rows go down: red is below the diagonal from the upper left, green the same shifted by half a picture.
    CHECK(at(2, 40) == std::array{255, 0, 0, 255});
    CHECK(at(40, 50) == std::array{255, 0, 0, 255});  // both triangles cover this pixel, and red is nearer
    CHECK(at(50, 30) == std::array{0, 255, 0, 255});
    CHECK(at(60, 10) == std::array{0, 0, 255, 255});
    CHECK(at(20, 10) == std::array{0, 0, 255, 255});
    // Some of the four samples of a pixel on the diagonal are covered.
    const auto edge = at(25, 25);
    CHECK(edge[0] > 0);
    CHECK(edge[0] < 255);
}

TEST_CASE("Transfer: images are read back unchanged, and mip levels are means of their texels") {
    test::Gpu gpu;
    Device& device = gpu.device();
    ImageInfo info{
        VK_FORMAT_R8G8B8A8_UNORM,
        {4, 2},
        2,
        2,
        false,
        VK_SAMPLE_COUNT_1_BIT,
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    Image image = gpu.need(Image::create(device, info));
    std::vector<std::uint8_t> texels(2 * 8 * 4);
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<std::uint8_t>(3 * i);
    gpu.need(upload_image(device, image, bytes_of(texels)));
    for (std::uint32_t layer = 0; layer < 2; ++layer) {
        const auto back = gpu.need(download_image(device, image, ResourceUse::sampled, 4, 0, layer));
        REQUIRE(back.size() == 32);
        CHECK(std::memcmp(back.data(), texels.data() + 32 * layer, 32) == 0);
        const auto half = gpu.need(download_image(device, image, ResourceUse::sampled, 4, 1, layer));
        REQUIRE(half.size() == 8);
        // 2 × 2 texels (0, 1, 4, 5), with channels three apart.
        const double mean = 0.25 * (texels[32 * layer] + texels[32 * layer + 4] + texels[32 * layer + 16] +
                                    texels[32 * layer + 20]);
        CHECK(std::abs(std::to_integer<int>(half[0]) - mean) <= 1.0);
    }
}

TEST_CASE("PipelineCache: a saved cache is restored, and a foreign or damaged one is ignored") {
    test::Gpu gpu;
    const test::Folder folder;
    const auto file = folder / "deep" / "pipelines.bin";
    const Shader shader = gpu.need(make_shader("double.comp", test_shaders("double.comp")));
    {
        const PipelineCache cache = gpu.need(PipelineCache::open(gpu.device(), file));
        CHECK_FALSE(cache.restored());
        (void)gpu.need(make_compute_pipeline(gpu.device(), cache, shader));
        gpu.need(cache.save());
    }
    CHECK(gpu.need(PipelineCache::open(gpu.device(), file)).restored());
    std::string bytes = gpu.need(read_file(file, 1 << 24, ErrorCode::failed));
    bytes[12] = static_cast<char>(bytes[12] + 1);  // from another device
    gpu.need(write_file(file, bytes));
    CHECK_FALSE(gpu.need(PipelineCache::open(gpu.device(), file)).restored());
    gpu.need(write_file(file, "short"));
    const PipelineCache cache = gpu.need(PipelineCache::open(gpu.device(), file));
    CHECK_FALSE(cache.restored());
    (void)gpu.need(make_compute_pipeline(gpu.device(), cache, shader));
}

TEST_CASE("Validation: a wrong layout and a missing barrier are detected") {
    test::Gpu gpu;
    gpu.expect_messages();
    const Buffer a =
        gpu.need(Buffer::create(gpu.device(), 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::device));
    const Buffer b = gpu.need(
        Buffer::create(gpu.device(), 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                       MemoryUse::device));
    gpu.need(submit_and_wait(gpu.device(), [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, 256};
        vkCmdCopyBuffer(commands, a.get(), b.get(), 1, &region);
        vkCmdCopyBuffer(commands, a.get(), b.get(), 1, &region);  // two writes without a barrier
    }));
    REQUIRE(gpu.log().messages.size() == 1);
    CHECK(gpu.log().messages[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE") != std::string::npos);
    const auto bad = Buffer::create(gpu.device(), 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::device);
    gpu.need(submit_and_wait(gpu.device(), [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, 256};
        vkCmdCopyBuffer(commands, a.get(), bad->get(), 1, &region);  // created without the transfer usage
    }));
    CHECK(gpu.log().messages.size() >= 2);
}
