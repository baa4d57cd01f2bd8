// What happens to samples when sound devices come and go, in a time of the test's own.

#include "engine/audio/feeder.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace bolt;
using namespace bolt::audio;

namespace {

// What somebody heard, and a card that can be pulled out.
struct Room {
    bool there = true, plugged = true;
    std::size_t free = in_queue;
    std::vector<float> heard;
    double volume = -1.0;
    int attempts = 0;
};

class Card final : public Sink {
  public:
    explicit Card(Room& room) : room_(room) {
        room_.free = in_queue;
        room_.volume = -1.0;  // a new one knows nothing
    }
    [[nodiscard]] std::string name() const override { return "card"; }
    Result<std::size_t> room() override {
        if (!room_.plugged) return fail(ErrorCode::no_device, "pulled out");
        return room_.free;
    }
    Status play(std::span<const float, block> samples) override {
        if (!room_.plugged) return fail(ErrorCode::no_device, "pulled out");
        REQUIRE(room_.free > 0);
        --room_.free;
        room_.heard.insert(room_.heard.end(), samples.begin(), samples.end());
        return {};
    }
    Status set_volume(double volume) override {
        room_.volume = volume;
        return {};
    }

  private:
    Room& room_;
};

OpenSink card_in(Room& room) {
    return [&room]() -> Result<std::unique_ptr<Sink>> {
        ++room.attempts;
        if (!room.there) return fail(ErrorCode::no_device, "no card", "a card");
        return std::make_unique<Card>(room);
    };
}

// Samples that count.
struct Counter {
    float next = 0.0F;
    Fill fill() {
        return [this](std::span<float> samples) {
            for (float& sample : samples) sample = next++;
        };
    }
};

}  // namespace

TEST_CASE("a sink gets as much as it has room for, every sample once and in order") {
    Room room;
    Counter counter;
    Feeder feeder(card_in(room), counter.fill());
    feeder.turn(0.0, 0.5);
    CHECK(feeder.report().playing);
    CHECK(feeder.report().device == "card");
    CHECK(room.heard.size() == in_queue * block);
    CHECK(room.volume == 0.5);
    feeder.turn(0.01, 0.5);
    CHECK(room.heard.size() == in_queue * block);  // no room, no samples
    room.free = 2;
    feeder.turn(0.02, 7.0);
    CHECK(room.volume == 1.0);
    REQUIRE(room.heard.size() == (in_queue + 2) * block);
    for (std::size_t i = 0; i < room.heard.size(); ++i) REQUIRE(room.heard[i] == static_cast<float>(i));
    CHECK(feeder.report().blocks == in_queue + 2);
}

TEST_CASE("without a device nothing is asked for, the reason is known, and it is tried less and less often") {
    Room room;
    room.there = false;
    Counter counter;
    Feeder feeder(card_in(room), counter.fill());
    std::vector<double> tried;
    for (double now = 0.0; now < 600.0; now += 0.25) {
        const int before = room.attempts;
        feeder.turn(now, 1.0);
        if (room.attempts != before) tried.push_back(now);
    }
    CHECK_FALSE(feeder.report().playing);
    CHECK(feeder.report().trouble.find("no card") != std::string::npos);
    CHECK(counter.next == 0.0F);
    const std::vector<double> expected{0, 1, 3, 7, 15, 31, 63, 127, 191, 255, 319, 383, 447, 511, 575};
    CHECK(tried == expected);
    room.there = true;
    feeder.turn(700.0, 1.0);
    CHECK(feeder.report().playing);
    CHECK(feeder.report().trouble.empty());
    CHECK(room.heard.front() == 0.0F);
}

TEST_CASE(
    "a device that is pulled out is opened again when it is back, at the volume that is wished by then") {
    Room room;
    Counter counter;
    Feeder feeder(card_in(room), counter.fill());
    feeder.turn(0.0, 1.0);
    room.plugged = false;
    room.there = false;
    feeder.turn(1.0, 1.0);
    CHECK_FALSE(feeder.report().playing);
    CHECK(feeder.report().losses == 1);
    CHECK(feeder.report().trouble.find("pulled out") != std::string::npos);
    for (double now = 1.0; now < 5.0; now += 0.1) feeder.turn(now, 1.0);
    room.plugged = room.there = true;
    for (double now = 5.0; now < 9.0; now += 0.1) feeder.turn(now, 0.3);
    CHECK(feeder.report().playing);
    CHECK(feeder.report().openings == 2);
    CHECK(room.volume == 0.3);
    room.plugged = false;
    feeder.turn(9.0, 0.3);
    room.plugged = true;
    feeder.turn(11.0, 0.3);
    CHECK(feeder.report().openings == 3);
    CHECK(room.volume == 0.3);
    // Nothing was made while nobody listened.
    CHECK(room.heard.size() == 3 * in_queue * block);
    CHECK(room.heard.back() == static_cast<float>(3 * in_queue * block - 1));
}

TEST_CASE("a device that opens and fails at once is not asked all the time") {
    Room room;
    room.plugged = false;
    Counter counter;
    Feeder feeder(card_in(room), counter.fill());
    for (double now = 0.0; now < 60.0; now += 0.005) feeder.turn(now, 1.0);
    CHECK(room.attempts == 6);  // at 0, 1, 3, 7, 15, 31
}
