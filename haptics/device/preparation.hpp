// The needs of an arm before it can be used, such as the user's permission that the arm may move by itself.
// The thread that asks the user and the thread that opens the arm share the permission.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "engine/base/result.hpp"

namespace bolt::device {

// The action that a connected device needs before it can be opened. After it, opening the device succeeds.
enum class DeviceNeed : std::uint8_t {
    none,
    permission,  // to move by itself, so that it finds its position
    inkwell,     // its stylus or handle in the inkwell (the holder on its base), where it is calibrated
    user,        // the action that Preparation::instruction names
    wait,        // it calibrates itself without a visible movement
};

// A need with the text that the device gives for it.
struct Preparation {
    DeviceNeed need = DeviceNeed::none;
    std::string instruction;  // of the device, for DeviceNeed::user
    bool operator==(const Preparation&) const = default;
};

struct PreparationDetail : ErrorDetail {
    Preparation preparation;
};

inline void set_preparation(Error& error, Preparation preparation) {
    auto detail = std::make_shared<PreparationDetail>();
    detail->preparation = std::move(preparation);
    error.detail = std::move(detail);
}

// The preparation that the device needed when opening failed; DeviceNeed::none: it failed for another reason.
inline Preparation preparation_of(const Error& error) {
    const auto* detail = dynamic_cast<const PreparationDetail*>(error.detail.get());
    return detail != nullptr ? detail->preparation : Preparation{};
}

// Permits one attempt to open an arm, so that an arm that loses its position later needs a new permission.
// All members may be called from any thread.
class MovePermission {
  public:
    // Permits the next attempt. Call only after a message to the user to keep hands and things clear. No
    // effect during an attempt that has the permission already.
    void grant() {
        auto expected = State::none;
        state_.compare_exchange_strong(expected, State::granted);
    }
    // Begins an attempt. Returns true if it has the permission; end() then ends it.
    [[nodiscard]] bool acquire() {
        auto expected = State::granted;
        return state_.compare_exchange_strong(expected, State::acquired);
    }
    void end() { state_.store(State::none); }
    // True from grant() to end(): the arm moves, or is about to.
    [[nodiscard]] bool active() const { return state_.load() != State::none; }

  private:
    enum class State : std::uint8_t { none, granted, acquired };
    std::atomic<State> state_{State::none};
};

// Shows the user what a device needs; DeviceNeed::none: nothing. Called every few milliseconds while the
// device is opened, and once when it is open. Returns false to give up; the device's error then has the
// preparation. May wait, for example for an answer.
using PreparationHandler = std::function<bool(const Preparation& preparation)>;

// Lets the user take part while an arm is opened. By default a need is an error, and no arm moves.
struct ArmDialog {
    PreparationHandler on_preparation{};
    std::shared_ptr<MovePermission> permission{};
};

// The arm's need, and whether the arm moves by itself, for the screen that asks the user.
struct ArmNeeds {
    Preparation preparation;
    bool moves = false;  // it has the permission and moves by itself, or is about to
    [[nodiscard]] bool any() const { return preparation.need != DeviceNeed::none; }
};

}  // namespace bolt::device
