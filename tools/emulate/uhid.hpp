// An emulated HID device plugged into the kernel through /dev/uhid: /dev/hidraw* and all. Needs root, and the
// module uhid.
#pragma once

#include <functional>
#include <memory>

#include "engine/base/result.hpp"
#include "tools/emulate/hid.hpp"

namespace bolt::emulate {

class Uhid {
  public:
    // A thread plays the device from now on, every millisecond.
    static Result<Uhid> plug_in(std::unique_ptr<HidDevice> device);

    Uhid(Uhid&&) noexcept;
    Uhid& operator=(Uhid&&) noexcept;
    ~Uhid();  // unplugs it

    // Looks at the device, or does something to it, while it is not being played.
    void with(const std::function<void(HidDevice&)>& look) const;

  private:
    struct Shared;
    explicit Uhid(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate
