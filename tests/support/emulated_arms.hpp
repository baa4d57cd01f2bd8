// The controls of the emulated libraries of vendors (tools/emulate/arms), as functions that a test can call.
// A program has one emulation of each library, so that only one arm of a vendor may exist.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <vector>

#include "haptics/device/vendor_library.hpp"
#include "tools/emulate/arms/force_dimension.h"
#include "tools/emulate/arms/open_haptics.h"

namespace bolt::test {

// Finds functions of a library by their names. A library or a function that is missing fails the test.
class EmulatedLibrary {
  public:
    explicit EmulatedLibrary(const char* path) : library_(opened({path})) {}

    class Symbol {
      public:
        Symbol(device::VendorLibrary& library, const char* name) : library_(library), name_(name) {}
        template <class Function>
        operator Function*() const {  // NOLINT: converts to the type of the pointer that it initialises
            Function* function = nullptr;
            library_.find(name_, function);
            const bool found = function != nullptr;
            REQUIRE_MESSAGE(found, name_);
            return function;
        }

      private:
        device::VendorLibrary& library_;
        const char* name_;
    };
    Symbol operator[](const char* name) { return {library_, name}; }

  private:
    static device::VendorLibrary opened(const std::vector<std::filesystem::path>& paths) {
        auto library = device::VendorLibrary::open(paths);
        REQUIRE_MESSAGE(library, (library ? "" : library.error().message()));
        return std::move(*library);
    }

    device::VendorLibrary library_;
};

struct ForceDimensionControls {
    EmulatedLibrary library{BOLT_EMULATED_FORCE_DIMENSION};
    decltype(emu_reset)* reset = library["emu_reset"];
    decltype(emu_advance)* advance = library["emu_advance"];
    decltype(emu_hand)* hand = library["emu_hand"];
    decltype(emu_intend)* intend = library["emu_intend"];
    decltype(emu_turn)* turn = library["emu_turn"];
    decltype(emu_initialized)* initialized = library["emu_initialized"];
    decltype(emu_active_wrist)* active_wrist = library["emu_active_wrist"];
    decltype(emu_model)* model = library["emu_model"];
    decltype(emu_weight)* weight = library["emu_weight"];
    decltype(emu_buttons)* buttons = library["emu_buttons"];
    decltype(emu_gripper)* gripper = library["emu_gripper"];
    decltype(emu_unplug)* unplug = library["emu_unplug"];
    decltype(emu_in_use)* in_use = library["emu_in_use"];
    decltype(emu_speed_limit)* speed_limit = library["emu_speed_limit"];
    decltype(emu_stale)* stale = library["emu_stale"];
    decltype(emu_corrupt)* corrupt = library["emu_corrupt"];
    decltype(emu_millimetres)* millimetres = library["emu_millimetres"];
    decltype(emu_position)* position = library["emu_position"];
    decltype(emu_force)* force = library["emu_force"];
    decltype(emu_moved_by_itself)* moved_by_itself = library["emu_moved_by_itself"];
    decltype(emu_braked)* braked = library["emu_braked"];
    decltype(emu_open)* open = library["emu_open"];
    decltype(emu_speed_limit_changes)* speed_limit_changes = library["emu_speed_limit_changes"];
};

struct OpenHapticsControls {
    EmulatedLibrary library{BOLT_EMULATED_OPEN_HAPTICS};
    decltype(emu_hd_reset)* reset = library["emu_hd_reset"];
    decltype(emu_hd_own_clock)* own_clock = library["emu_hd_own_clock"];
    decltype(emu_hd_advance)* advance = library["emu_hd_advance"];
    decltype(emu_hd_hand)* hand = library["emu_hd_hand"];
    decltype(emu_hd_intend)* intend = library["emu_hd_intend"];
    decltype(emu_hd_turn)* turn = library["emu_hd_turn"];
    decltype(emu_hd_report)* report = library["emu_hd_report"];
    decltype(emu_hd_buttons)* buttons = library["emu_hd_buttons"];
    decltype(emu_hd_calibration)* calibration = library["emu_hd_calibration"];
    decltype(emu_hd_inkwell)* inkwell = library["emu_hd_inkwell"];
    decltype(emu_hd_only_name)* only_name = library["emu_hd_only_name"];
    decltype(emu_hd_unplug)* unplug = library["emu_hd_unplug"];
    decltype(emu_hd_in_use)* in_use = library["emu_hd_in_use"];
    decltype(emu_hd_licensed)* licensed = library["emu_hd_licensed"];
    decltype(emu_hd_heat)* heat = library["emu_hd_heat"];
    decltype(emu_hd_speed_limit)* speed_limit = library["emu_hd_speed_limit"];
    decltype(emu_hd_corrupt)* corrupt = library["emu_hd_corrupt"];
    decltype(emu_hd_raise)* raise = library["emu_hd_raise"];
    decltype(emu_hd_late)* late = library["emu_hd_late"];
    decltype(emu_hd_switch_off)* switch_off = library["emu_hd_switch_off"];
    decltype(emu_hd_force)* force = library["emu_hd_force"];
    decltype(emu_hd_open)* open = library["emu_hd_open"];
    decltype(emu_hd_running)* running = library["emu_hd_running"];
    decltype(emu_hd_initialisations)* initialisations = library["emu_hd_initialisations"];
    decltype(emu_hd_refused)* refused = library["emu_hd_refused"];
};

}  // namespace bolt::test
