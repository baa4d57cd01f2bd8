// Sends the picture of a panel to other processes: the tiles that have changed, compressed without loss. The
// picture is drawn by one process only, because its contents (menus, text fields, names) are that process's.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/cluster/message.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/render/passes/panels.hpp"

namespace bolt::view {

inline constexpr std::uint32_t panel_tile = 64;   // px, edge of a tile
inline constexpr std::size_t panel_piece = 48;    // tiles in a frame, at most
inline constexpr std::uint32_t max_panel = 4096;  // px, edge of a panel

// A part of a panel's picture: texels in the panel's format, rows from the top.
struct PanelTile {
    std::uint16_t column = 0, row = 0;  // in tiles
    std::vector<std::byte> texels;
};

// The tiles in which two pictures of the same size differ; all of them if `before` is empty.
std::vector<PanelTile> changed_tiles(std::span<const std::byte> now, std::span<const std::byte> before,
                                     VkExtent2D extent);

void put_tiles(cluster::MessageWriter& message, std::span<const PanelTile> tiles);
// The tiles that put_tiles() wrote. Fails on a damaged message, and if a tile is not in a picture of this
// size.
Result<std::vector<PanelTile>> get_tiles(cluster::MessageReader& message, VkExtent2D extent);

class PanelSender {
  public:
    // Copies the panel's picture, which this frame has drawn, for a later write(). Does nothing if the last
    // copy has not been written yet.
    Status record(gpu::Device& device, gpu::FrameContext& frame, const render::PanelPicture& panel);
    // Writes the next changed tiles of the copy, at most panel_piece, once the GPU has completed it, two
    // frames after record() or later. Writes nothing and returns false if there are none.
    bool write(cluster::MessageWriter& message);
    // Call it before the GPU objects are destroyed; the receivers keep their picture.
    void release();

  private:
    gpu::Buffer copy_;
    VkExtent2D extent_{};
    std::uint64_t frame_ = 0;                // counts record()
    std::optional<std::uint64_t> recorded_;  // when copy_ was recorded; none: it has been written
    std::vector<std::byte> sent_;            // the picture that the receivers have once waiting_ is sent
    std::vector<PanelTile> waiting_;         // changed, and not written yet
};

class PanelReceiver {
  public:
    // Reads what PanelSender::write() wrote; it is shown from the next draw() on.
    Status read(cluster::MessageReader& message);
    // Copies new tiles to the panel's picture. Call it before the frame draws the panel.
    Status draw(gpu::Device& device, gpu::FrameContext& frame);
    // Null: nothing has been received.
    [[nodiscard]] const render::PanelPicture* picture() const { return picture_ ? &*picture_ : nullptr; }
    void release();

  private:
    VkExtent2D extent_{};
    std::vector<PanelTile> waiting_;
    std::optional<render::PanelPicture> picture_;
};

}  // namespace bolt::view
