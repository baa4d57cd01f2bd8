#include "game/analysis/stream.hpp"

#include <algorithm>
#include <iterator>

namespace bolt::analysis {

namespace {

// A hand that holds still says nothing new; its last sample keeps the time.
bool same_reading(const CurvePoint& a, const CurvePoint& b) {
    return a.angle == b.angle && a.torque == b.torque && a.clamp == b.clamp && a.stage == b.stage &&
           a.stroke == b.stroke;
}

}  // namespace

CurveStream::CurveStream(std::size_t most_buckets) : most_(std::max<std::size_t>(2, most_buckets)) {}

void CurveStream::join(Bucket& into, const Bucket& next) {
    if (next.low.torque < into.low.torque) into.low = next.low;
    if (next.high.torque > into.high.torque) into.high = next.high;
    into.last = next.last;
    into.count += next.count;
}

void CurveStream::halve() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < buckets_.size(); i += 2, ++kept) {
        Bucket joined = buckets_[i];
        if (i + 1 < buckets_.size()) join(joined, buckets_[i + 1]);
        buckets_[kept] = joined;
    }
    buckets_.resize(kept);
    share_ *= 2;
}

void CurveStream::add(const CurvePoint& point) {
    if (!buckets_.empty() && same_reading(buckets_.back().last, point)) {
        buckets_.back().last.time = point.time;
        return;
    }
    const Bucket one{point, point, point, point, 1};
    if (!buckets_.empty() && buckets_.back().count < share_) {
        join(buckets_.back(), one);
        return;
    }
    if (buckets_.size() == most_) halve();
    buckets_.push_back(one);
}

std::vector<CurvePoint> CurveStream::points() const {
    std::vector<CurvePoint> out;
    for (const Bucket& bucket : buckets_) {
        CurvePoint four[] = {bucket.first, bucket.low, bucket.high, bucket.last};
        std::stable_sort(std::begin(four), std::end(four),
                         [](const CurvePoint& a, const CurvePoint& b) { return a.time < b.time; });
        for (const CurvePoint& p : four)
            if (out.empty() || !same_reading(out.back(), p)) out.push_back(p);
    }
    return out;
}

}  // namespace bolt::analysis
