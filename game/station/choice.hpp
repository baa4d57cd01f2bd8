// Which of the devices that are there a station uses, and what for. Pure: device::list() says what is there.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptics/device/list.hpp"

namespace bolt::station {

enum class Use : std::uint8_t {
    mover,  // moves the tool
    wheel,  // turns the wrench on its bolt, and feels it
};
// None: nothing that a station could use it for.
std::optional<Use> use_of(device::HidKind kind);
const char* words(Use use);

// The one with this id. An error: there is none (with the nearest), or it cannot be used, and what mends
// that.
Result<device::Listed> find(std::span<const device::Listed> there, const std::string& id);

struct Choice {
    std::optional<device::Listed> mover, wheel;
};

// The devices with these ids, one for each use. An error as above, or two of a kind, or one of no use.
Result<Choice> choose(std::span<const device::Listed> there, std::span<const std::string> ids);

// The first of each kind that can be used.
Choice choose_any(std::span<const device::Listed> there);
std::vector<std::string> ids_of(const Choice& choice);

}  // namespace bolt::station
