#include "engine/assets/write/buffer.hpp"

#include <algorithm>

namespace bolt::assets {

Json BufferBuilder::min_max(std::span<const float> floats, std::size_t width) {
    std::vector<double> low;
    std::vector<double> high;
    for (std::size_t i = 0; i < floats.size(); ++i) {
        const double value = static_cast<double>(floats[i]);  // exact: validators compare bits
        const std::size_t component = i % width;
        if (i < width) {
            low.push_back(value);
            high.push_back(value);
        } else {
            low[component] = std::min(low[component], value);
            high[component] = std::max(high[component], value);
        }
    }
    return {{"min", low}, {"max", high}};
}

int BufferBuilder::add_bytes(std::span<const std::byte> bytes, std::size_t stride, std::size_t count,
                             BufferTarget use, const AccessorLayout& layout, const Json& bounds) {
    const auto [place, fresh] = shared_.try_emplace({use, stride}, views_.size());
    if (fresh) views_.push_back({use, stride, {}});
    std::string& target = views_[place->second].bytes;
    Json accessor = {{"bufferView", place->second}};
    if (!target.empty()) accessor["byteOffset"] = target.size();
    accessor["componentType"] = layout.component;
    if (layout.normalized) accessor["normalized"] = true;
    accessor["count"] = count;
    accessor["type"] = layout.type;
    if (layout.bounded) accessor.update(bounds);
    target.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    accessors_.push_back(std::move(accessor));
    return static_cast<int>(accessors_.size()) - 1;
}

int BufferBuilder::add_file(std::span<const std::uint8_t> bytes) {
    views_.push_back({BufferTarget::other, 0, std::string(bytes.begin(), bytes.end())});
    return static_cast<int>(views_.size()) - 1;
}

std::string BufferBuilder::finish(Json& root) {
    constexpr int array_buffer = 34962;
    constexpr int element_array_buffer = 34963;
    std::string chunk;
    Json views = Json::array();
    for (const BufferView& view : views_) {
        Json entry = {{"buffer", 0}};
        if (!chunk.empty()) entry["byteOffset"] = chunk.size();
        entry["byteLength"] = view.bytes.size();
        if (view.use == BufferTarget::vertices) {
            entry["byteStride"] = view.stride;
            entry["target"] = array_buffer;
        }
        if (view.use == BufferTarget::indices) entry["target"] = element_array_buffer;
        views.push_back(std::move(entry));
        chunk += view.bytes;
        chunk.resize((chunk.size() + 3U) & ~std::size_t{3U}, '\0');
    }
    if (!accessors_.empty()) root["accessors"] = std::move(accessors_);
    if (!views.empty()) {
        root["bufferViews"] = std::move(views);
        root["buffers"] = {{{"byteLength", chunk.size()}}};
    }
    return chunk;
}

}  // namespace bolt::assets
