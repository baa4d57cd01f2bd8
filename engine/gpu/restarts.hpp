// Whether a lost GPU is worth starting again: drivers that hang are restarted by the system and work again,
// but what loses it at once a second time will do so for ever.
#pragma once

#include <optional>

namespace bolt::gpu {

class Restarts {
  public:
    // It was lost at `now` (s): true to start it again.
    bool again(double now) {
        const bool worked = !last_ || now - *last_ >= patience;
        last_ = now;
        return worked;
    }
    static constexpr double patience = 10.0;  // s

  private:
    std::optional<double> last_;
};

}  // namespace bolt::gpu
