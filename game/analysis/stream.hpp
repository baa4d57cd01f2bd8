// A stream of samples of unknown length, kept within a fixed size. Peaks are never lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "haptics/joint/stage.hpp"

namespace bolt::analysis {

// One sample of a joint at work.
struct CurvePoint {
    double time = 0.0;    // s from the start of the session
    double angle = 0.0;   // rad, nut angle
    double torque = 0.0;  // N·m at the wrench, tightening positive
    double clamp = 0.0;   // N
    joint::Stage stage = joint::Stage::navigation;
    std::uint16_t stroke = 0;  // counts re-grips of the visit: lines break between strokes
};

// Equal shares of the stream, each kept as its first, lowest, highest (by torque) and last sample. When the
// shares run out, neighbours are joined and the share doubles.
class CurveStream {
  public:
    explicit CurveStream(std::size_t most_buckets = 2048);

    void add(const CurvePoint& point);
    [[nodiscard]] bool empty() const { return buckets_.empty(); }
    [[nodiscard]] std::vector<CurvePoint> points() const;  // in time

  private:
    struct Bucket {
        CurvePoint first, low, high, last;
        std::size_t count = 0;
    };
    static void join(Bucket& into, const Bucket& next);
    void halve();

    std::size_t most_;
    std::size_t share_ = 1;
    std::vector<Bucket> buckets_;
};

}  // namespace bolt::analysis
