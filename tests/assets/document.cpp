#include "tests/assets/document.hpp"

#include <doctest/doctest.h>

namespace bolt::assets {

std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = (word << 8U) | (k < left ? std::uint32_t{bytes[i + k]} : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += k <= left ? digits[(word >> (18U - 6U * k)) & 63U] : '=';
    }
    return text;
}

void set_buffer(json& document, const Bytes& bytes) {
    document["buffers"] =
        json::array({{{"byteLength", bytes.size()},
                      {"uri", "data:application/octet-stream;base64," + base64(bytes.get())}}});
    document["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", bytes.size()}}});
}

json triangle_document() {
    json document = json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "triangle", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 0, "byteOffset": 36, "componentType": 5123, "count": 3, "type": "SCALAR"}]})");
    set_buffer(
        document,
        Bytes().add({0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F}).add<std::uint16_t>({0, 1, 2, 0}));
    return document;
}

std::string glb(const json& document, const std::string& chunk) {
    std::string text = document.dump();
    text.resize((text.size() + 3U) & ~std::size_t{3U}, ' ');
    const auto u32 = [](std::size_t value) {
        std::string bytes(4, '\0');
        const auto word = static_cast<std::uint32_t>(value);
        std::memcpy(bytes.data(), &word, 4);
        return bytes;
    };
    std::string body = u32(text.size()) + "JSON" + text;
    if (!chunk.empty()) body += u32(chunk.size()) + std::string("BIN\0", 4) + chunk;
    return "glTF" + u32(2) + u32(12 + body.size()) + body;
}

Model read(const json& document) {
    auto model = parse_gltf(document.dump(), "made.gltf");
    REQUIRE_MESSAGE(model, model.error().message());
    return std::move(*model);
}

Error refusal(const json& document) {
    const auto model = parse_gltf(document.dump(), "hostile.gltf");
    REQUIRE_FALSE(model);
    CHECK(model.error().code == ErrorCode::bad_content);
    CHECK(model.error().file == "hostile.gltf");
    CHECK_FALSE(model.error().what.empty());
    return model.error();
}

}  // namespace bolt::assets
