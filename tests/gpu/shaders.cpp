#include <doctest/doctest.h>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/pipeline.hpp"
#include "tests/gpu/shaders.hpp"
#include "tests/gpu/support.hpp"

using namespace bolt;
using namespace bolt::gpu;

TEST_CASE(
    "Reflection: finds bindings with type and count, vertex inputs with location and format, and push "
    "constants") {
    test::Gpu gpu;
    const Shader vertex = gpu.need(make_shader("triangle.vert", test_shaders("triangle.vert")));
    CHECK(vertex.reflection.stage == VK_SHADER_STAGE_VERTEX_BIT);
    CHECK(vertex.reflection.push_constants == 16);
    REQUIRE(vertex.reflection.inputs.size() == 2);
    CHECK(vertex.reflection.inputs[0].name == "position");
    CHECK(vertex.reflection.inputs[0].format == VK_FORMAT_R32G32B32_SFLOAT);
    CHECK(vertex.reflection.inputs[1].location == 3);
    CHECK(vertex.reflection.inputs[1].format == VK_FORMAT_R32G32_SFLOAT);
    REQUIRE(vertex.reflection.bindings.size() == 1);
    CHECK(vertex.reflection.bindings[0].type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);

    const Shader fragment = gpu.need(make_shader("triangle.frag", test_shaders("triangle.frag")));
    REQUIRE(fragment.reflection.bindings.size() == 2);
    CHECK(fragment.reflection.bindings[0].type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    CHECK(fragment.reflection.bindings[0].binding == 2);
    CHECK(fragment.reflection.bindings[0].count == 2);
    CHECK(fragment.reflection.bindings[0].name == "image");
    CHECK(fragment.reflection.bindings[1].set == 1);
    CHECK(fragment.reflection.bindings[1].type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);

    Pipeline pipeline;
    const Shader* both[] = {&vertex, &fragment};
    gpu.need(make_pipeline_layout(gpu.device(), both, pipeline));
    CHECK(pipeline.sets.size() == 2);
    CHECK(pipeline.bindings.size() == 3);
    CHECK(pipeline.push_stages == VK_SHADER_STAGE_VERTEX_BIT);
}

TEST_CASE("Shaders: invalid SPIR-V and stages that disagree are errors that name the shader") {
    const std::uint32_t rubbish[] = {1, 2, 3, 4, 5, 6};
    const auto broken = make_shader("rubbish.vert", rubbish);
    REQUIRE_FALSE(broken.has_value());
    CHECK(broken.error().what.starts_with("rubbish.vert: not a SPIR-V shader"));
    const auto whole = test_shaders("triangle.vert");
    CHECK_FALSE(make_shader("cut.vert", whole.first(4)).has_value());

    test::Gpu gpu;
    Shader vertex = gpu.need(make_shader("triangle.vert", test_shaders("triangle.vert")));
    Shader other = gpu.need(make_shader("double.comp", test_shaders("double.comp")));
    Pipeline pipeline;
    const Shader* both[] = {&vertex, &other};  // set 0 binding 0: uniform here, storage there
    const Status merged = make_pipeline_layout(gpu.device(), both, pipeline);
    REQUIRE_FALSE(merged.has_value());
    CHECK(merged.error().what.starts_with("double.comp: set 0 binding 0"));
}

TEST_CASE("Shaders: a vertex input without a stream and a missing binding are named") {
    test::Gpu gpu;
    const Shader vertex = gpu.need(make_shader("triangle.vert", test_shaders("triangle.vert")));
    const PipelineCache cache = gpu.need(PipelineCache::open(gpu.device(), {}));
    GraphicsInfo info;
    info.vertex = &vertex;
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {12};
    const auto hungry = make_graphics_pipeline(gpu.device(), cache, info);
    REQUIRE_FALSE(hungry.has_value());
    CHECK(hungry.error().what ==
          "triangle.vert: no vertex stream for the input \"unused_by_some\" at location 3");

    const Shader compute = gpu.need(make_shader("double.comp", test_shaders("double.comp")));
    const Pipeline pipeline = gpu.need(make_compute_pipeline(gpu.device(), cache, compute));
    const auto frames = gpu.need(Frames::create(gpu.device()));
    FrameContext& frame = *gpu.need(frames->begin());
    DescriptorWriter empty = gpu.need(DescriptorWriter::create(gpu.device(), frame, pipeline, 0));
    CHECK(empty.finish().error().what == "nothing is bound to \"Values\" (set 0 binding 0)");
    DescriptorWriter wrong = gpu.need(DescriptorWriter::create(gpu.device(), frame, pipeline, 0));
    const TransientRange piece = gpu.need(frame.allocate(64));
    CHECK(wrong.range(0, piece).range(7, piece).finish().error().what == "no shader has set 0 binding 7");
    gpu.need(frames->submit(frame));
    gpu.need(frames->finish());
}
