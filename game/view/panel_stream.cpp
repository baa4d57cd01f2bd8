#include "game/view/panel_stream.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace bolt::view {

namespace {

constexpr std::size_t texel_size = 4;
constexpr int compression = 1;  // zstd's fastest usual level: large areas of one colour shrink a hundredfold

struct TileGrid {
    VkExtent2D extent{};
    [[nodiscard]] std::uint32_t columns() const { return (extent.width + panel_tile - 1) / panel_tile; }
    [[nodiscard]] std::uint32_t rows() const { return (extent.height + panel_tile - 1) / panel_tile; }
    [[nodiscard]] VkRect2D place(std::uint32_t column, std::uint32_t row) const {
        const std::uint32_t x = column * panel_tile, y = row * panel_tile;
        return {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                {std::min(panel_tile, extent.width - x), std::min(panel_tile, extent.height - y)}};
    }
    // The offset of a row of a tile in the picture, bytes.
    [[nodiscard]] std::size_t offset(const VkRect2D& place, std::uint32_t row) const {
        const auto x = static_cast<std::size_t>(place.offset.x),
                   y = static_cast<std::size_t>(place.offset.y) + row;
        return (y * extent.width + x) * texel_size;
    }
};

std::size_t bytes_of(VkExtent2D extent) { return std::size_t{extent.width} * extent.height * texel_size; }

Error damaged_panel() {
    return {ErrorCode::failed, "the panel's picture that another process sent is damaged",
            "the same program in all processes"};
}

}  // namespace

std::vector<PanelTile> changed_tiles(std::span<const std::byte> now, std::span<const std::byte> before,
                                     VkExtent2D extent) {
    const TileGrid grid{extent};
    std::vector<PanelTile> tiles;
    for (std::uint32_t row = 0; row < grid.rows(); ++row) {
        for (std::uint32_t column = 0; column < grid.columns(); ++column) {
            const VkRect2D place = grid.place(column, row);
            const std::size_t length = place.extent.width * texel_size;
            bool same = before.size() == now.size();
            for (std::uint32_t y = 0; y < place.extent.height && same; ++y) {
                const std::size_t at = grid.offset(place, y);
                same = std::memcmp(now.data() + at, before.data() + at, length) == 0;
            }
            if (same) continue;
            PanelTile& tile = tiles.emplace_back();
            tile.column = static_cast<std::uint16_t>(column);
            tile.row = static_cast<std::uint16_t>(row);
            for (std::uint32_t y = 0; y < place.extent.height; ++y) {
                const auto texels = now.subspan(grid.offset(place, y), length);
                tile.texels.insert(tile.texels.end(), texels.begin(), texels.end());
            }
        }
    }
    return tiles;
}

void put_tiles(cluster::MessageWriter& message, std::span<const PanelTile> tiles) {
    cluster::MessageWriter plain;
    plain.put(static_cast<std::uint32_t>(tiles.size()));
    for (const PanelTile& tile : tiles) {
        plain.put(tile.column);
        plain.put(tile.row);
        plain.put_all(std::span<const std::byte>(tile.texels));
    }
    const cluster::Message& bytes = plain.message();
    cluster::Message compressed(ZSTD_compressBound(bytes.size()));
    const std::size_t size =
        ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), compression);
    compressed.resize(ZSTD_isError(size) != 0 ? 0 : size);
    message.put_all(std::span<const std::byte>(compressed));
}

Result<std::vector<PanelTile>> get_tiles(cluster::MessageReader& message, VkExtent2D extent) {
    const TileGrid grid{extent};
    const cluster::Message compressed = message.get_all<std::byte>();
    const unsigned long long size = ZSTD_getFrameContentSize(compressed.data(), compressed.size());
    // Each tile has two numbers and a length besides its texels.
    const std::size_t most = bytes_of(extent) + 16 * (1 + std::size_t{grid.columns()} * grid.rows());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR || size > most)
        return fail(damaged_panel());
    cluster::Message bytes(static_cast<std::size_t>(size));
    const std::size_t got = ZSTD_decompress(bytes.data(), bytes.size(), compressed.data(), compressed.size());
    if (ZSTD_isError(got) != 0 || got != bytes.size()) return fail(damaged_panel());
    cluster::MessageReader plain(bytes);
    const auto count = plain.get<std::uint32_t>();
    std::vector<PanelTile> tiles;
    for (std::uint32_t i = 0; i < count && plain.ok(); ++i) {
        PanelTile& tile = tiles.emplace_back();
        tile.column = plain.get<std::uint16_t>();
        tile.row = plain.get<std::uint16_t>();
        tile.texels = plain.get_all<std::byte>();
        if (tile.column >= grid.columns() || tile.row >= grid.rows() ||
            tile.texels.size() != bytes_of(grid.place(tile.column, tile.row).extent))
            plain.mark_damaged();
    }
    if (!plain.ok()) return fail(damaged_panel());
    return tiles;
}

Status PanelSender::record(gpu::Device& device, gpu::FrameContext& frame, const render::PanelPicture& panel) {
    ++frame_;
    if (recorded_ || !waiting_.empty()) return {};
    const std::size_t size = bytes_of(panel.extent());
    if (copy_.size() < size) {
        BOLT_TRY_ASSIGN(auto copy, gpu::Buffer::create(device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                       gpu::MemoryUse::readback));
        if (copy_.size() > 0) frame.retire(std::move(copy_));
        copy_ = std::move(copy);
    }
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {panel.extent().width, panel.extent().height, 1};
    vkCmdCopyImageToBuffer(frame.commands(), panel.image().get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           copy_.get(), 1, &region);
    gpu::memory_barrier(frame.commands(), gpu::ResourceUse::transfer_to, gpu::ResourceUse::host_read);
    extent_ = panel.extent();
    recorded_ = frame_;
    return {};
}

// The frame that recorded the copy is complete once gpu::frames_in_flight later frames have begun.
bool PanelSender::write(cluster::MessageWriter& message) {
    if (recorded_ && waiting_.empty() && copy_.size() > 0 && frame_ >= *recorded_ + gpu::frames_in_flight) {
        const std::span<const std::byte> now = copy_.bytes().first(bytes_of(extent_));
        waiting_ = changed_tiles(now, sent_, extent_);
        sent_.assign(now.begin(), now.end());
        recorded_.reset();
    }
    if (waiting_.empty()) return false;
    const std::size_t count = std::min(waiting_.size(), panel_piece);
    message.put(extent_.width);
    message.put(extent_.height);
    put_tiles(message, std::span(waiting_).first(count));
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
    return true;
}

void PanelSender::release() {
    copy_ = {};
    recorded_.reset();
}

Status PanelReceiver::read(cluster::MessageReader& message) {
    const VkExtent2D extent{message.get<std::uint32_t>(), message.get<std::uint32_t>()};
    if (!message.ok() || extent.width > max_panel || extent.height > max_panel) return fail(damaged_panel());
    if (extent.width != extent_.width || extent.height != extent_.height) waiting_.clear();
    extent_ = extent;
    BOLT_TRY_ASSIGN(auto tiles, get_tiles(message, extent));
    for (PanelTile& tile : tiles) waiting_.push_back(std::move(tile));
    return {};
}

Status PanelReceiver::draw(gpu::Device& device, gpu::FrameContext& frame) {
    if (waiting_.empty()) return {};
    if (!picture_ || picture_->extent().width != extent_.width ||
        picture_->extent().height != extent_.height) {
        BOLT_TRY_ASSIGN(auto made, render::PanelPicture::create(device, extent_));
        if (picture_) frame.retire(picture_->release());
        picture_.emplace(std::move(made));
        picture_->clear(frame);
    }
    const VkCommandBuffer commands = frame.commands();
    const VkImage image = picture_->image().get();
    gpu::image_barrier(commands, image, gpu::ResourceUse::transfer_from, gpu::ResourceUse::transfer_to);
    const TileGrid grid{extent_};
    for (const PanelTile& tile : waiting_) {
        BOLT_TRY_ASSIGN(const auto range, frame.allocate(tile.texels.size()));
        std::copy(tile.texels.begin(), tile.texels.end(), range.bytes.begin());
        const VkRect2D place = grid.place(tile.column, tile.row);
        VkBufferImageCopy region{};
        region.bufferOffset = range.offset;
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageOffset = {place.offset.x, place.offset.y, 0};
        region.imageExtent = {place.extent.width, place.extent.height, 1};
        vkCmdCopyBufferToImage(commands, range.buffer, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &region);
    }
    gpu::image_barrier(commands, image, gpu::ResourceUse::transfer_to, gpu::ResourceUse::transfer_from);
    waiting_.clear();
    return {};
}

void PanelReceiver::release() { picture_.reset(); }

}  // namespace bolt::view
