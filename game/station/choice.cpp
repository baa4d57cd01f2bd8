#include "game/station/choice.hpp"

#include <fmt/format.h>

#include "engine/base/nearest.hpp"

namespace bolt::station_setup {

std::optional<Use> use_of(device::HidKind kind) {
    switch (kind) {
        case device::HidKind::puck:
            return Use::mover;
        case device::HidKind::board:
        case device::HidKind::wheel:
            return Use::wheel;
        case device::HidKind::other:
            break;
    }
    return std::nullopt;
}

const char* words(Use use) { return use == Use::mover ? "moves the tool" : "turns the wrench on its bolt"; }

Result<device::ListedDevice> find(std::span<const device::ListedDevice> there, const std::string& id) {
    std::vector<std::string> ids;
    for (const device::ListedDevice& l : there) {
        ids.push_back(l.id);
        if (l.id != id) continue;
        if (l.trouble) return fail(*l.trouble);
        return l;
    }
    const std::string near = nearest(id, ids);
    return fail(ErrorCode::no_device, fmt::format("there is no device {}", id),
                near.empty() ? "one that `boltwright devices` lists" : fmt::format("did you mean {}?", near));
}

Result<Choice> choose(std::span<const device::ListedDevice> there, std::span<const std::string> ids) {
    Choice choice;
    for (const std::string& id : ids) {
        BOLT_TRY_ASSIGN(const auto found, find(there, id));
        const std::optional<Use> use = use_of(found.kind);
        if (!use)
            return fail(ErrorCode::usage, fmt::format("{} ({}) is nothing to train with", id, found.name),
                        "a SpaceMouse, an OpenFFBoard or a wheel with force feedback");
        std::optional<device::ListedDevice>& place = *use == Use::mover ? choice.mover : choice.wheel;
        if (place)
            return fail(ErrorCode::usage,
                        fmt::format("both {} and {} are one that {}", place->id, id, words(*use)),
                        "one of them");
        place = found;
    }
    return choice;
}

Choice choose_any(std::span<const device::ListedDevice> there) {
    Choice choice;
    for (const device::ListedDevice& l : there) {
        const std::optional<Use> use = use_of(l.kind);
        if (!use || l.trouble) continue;
        std::optional<device::ListedDevice>& place = *use == Use::mover ? choice.mover : choice.wheel;
        if (!place) place = l;
    }
    return choice;
}

std::vector<std::string> ids_of(const Choice& choice) {
    std::vector<std::string> ids;
    for (const auto* one : {&choice.mover, &choice.wheel})
        if (one->has_value()) ids.push_back((*one)->id);
    return ids;
}

}  // namespace bolt::station_setup
