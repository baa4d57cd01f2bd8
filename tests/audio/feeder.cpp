// Tests of the feeder in simulated time, while sound devices appear and disappear.

#include "engine/audio/speaker.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace bolt;
using namespace bolt::audio;

namespace {

// A simulated sound card that can be unplugged, and the samples that it played.
struct CardState {
    bool present = true, plugged = true;
    std::size_t free = max_queued_blocks;
    std::vector<float> played_samples;
    double volume = -1.0;
    int attempts = 0;
};

class Card final : public Sink {
  public:
    explicit Card(CardState& card) : card_(card) {
        card_.free = max_queued_blocks;
        card_.volume = -1.0;  // a new device has no volume yet
    }
    [[nodiscard]] std::string name() const override { return "card"; }
    Result<std::size_t> free_blocks() override {
        if (!card_.plugged) return fail(ErrorCode::no_device, "pulled out", {});
        return card_.free;
    }
    Status play(std::span<const float, block_size> samples) override {
        if (!card_.plugged) return fail(ErrorCode::no_device, "pulled out", {});
        REQUIRE(card_.free > 0);
        --card_.free;
        card_.played_samples.insert(card_.played_samples.end(), samples.begin(), samples.end());
        return {};
    }
    Status set_volume(double volume) override {
        card_.volume = volume;
        return {};
    }

  private:
    CardState& card_;
};

OpenSink open_card(CardState& card) {
    return [&card]() -> Result<std::unique_ptr<Sink>> {
        ++card.attempts;
        if (!card.present) return fail(ErrorCode::no_device, "no card", "a card");
        return std::make_unique<Card>(card);
    };
}

// Samples with increasing values.
struct Counter {
    float next = 0.0F;
    FillSamples fill() {
        return [this](std::span<float> samples) {
            for (float& sample : samples) sample = next++;
        };
    }
};

}  // namespace

TEST_CASE("Feeder: fills the sink with every sample once and in order") {
    CardState card;
    Counter counter;
    Feeder feeder(open_card(card), counter.fill());
    feeder.update(0.0, 0.5);
    CHECK(feeder.status().playing);
    CHECK(feeder.status().device == "card");
    CHECK(card.played_samples.size() == max_queued_blocks * block_size);
    CHECK(card.volume == 0.5);
    feeder.update(0.01, 0.5);
    CHECK(card.played_samples.size() == max_queued_blocks * block_size);  // a full sink requests no samples
    card.free = 2;
    feeder.update(0.02, 7.0);
    CHECK(card.volume == 1.0);
    REQUIRE(card.played_samples.size() == (max_queued_blocks + 2) * block_size);
    for (std::size_t i = 0; i < card.played_samples.size(); ++i)
        REQUIRE(card.played_samples[i] == static_cast<float>(i));
    CHECK(feeder.status().blocks == max_queued_blocks + 2);
}

TEST_CASE(
    "Feeder: without a device no samples are requested, the reason is reported, and attempts become rarer") {
    CardState card;
    card.present = false;
    Counter counter;
    Feeder feeder(open_card(card), counter.fill());
    std::vector<double> tried;
    for (double now = 0.0; now < 600.0; now += 0.25) {
        const int before = card.attempts;
        feeder.update(now, 1.0);
        if (card.attempts != before) tried.push_back(now);
    }
    CHECK_FALSE(feeder.status().playing);
    CHECK(feeder.status().problem.find("no card") != std::string::npos);
    CHECK(counter.next == 0.0F);
    const std::vector<double> expected{0, 1, 3, 7, 15, 31, 63, 127, 191, 255, 319, 383, 447, 511, 575};
    CHECK(tried == expected);
    card.present = true;
    feeder.update(700.0, 1.0);
    CHECK(feeder.status().playing);
    CHECK(feeder.status().problem.empty());
    CHECK(card.played_samples.front() == 0.0F);
}

TEST_CASE("Feeder: an unplugged device is reopened when it returns, at the current volume") {
    CardState card;
    Counter counter;
    Feeder feeder(open_card(card), counter.fill());
    feeder.update(0.0, 1.0);
    card.plugged = false;
    card.present = false;
    feeder.update(1.0, 1.0);
    CHECK_FALSE(feeder.status().playing);
    CHECK(feeder.status().losses == 1);
    CHECK(feeder.status().problem.find("pulled out") != std::string::npos);
    for (double now = 1.0; now < 5.0; now += 0.1) feeder.update(now, 1.0);
    card.plugged = card.present = true;
    for (double now = 5.0; now < 9.0; now += 0.1) feeder.update(now, 0.3);
    CHECK(feeder.status().playing);
    CHECK(feeder.status().openings == 2);
    CHECK(card.volume == 0.3);
    card.plugged = false;
    feeder.update(9.0, 0.3);
    card.plugged = true;
    feeder.update(11.0, 0.3);
    CHECK(feeder.status().openings == 3);
    CHECK(card.volume == 0.3);
    // No samples were requested without a device.
    CHECK(card.played_samples.size() == 3 * max_queued_blocks * block_size);
    CHECK(card.played_samples.back() == static_cast<float>(3 * max_queued_blocks * block_size - 1));
}

TEST_CASE("Feeder: a device that fails right after opening is not reopened continuously") {
    CardState card;
    card.plugged = false;
    Counter counter;
    Feeder feeder(open_card(card), counter.fill());
    for (double now = 0.0; now < 60.0; now += 0.005) feeder.update(now, 1.0);
    CHECK(card.attempts == 6);  // at 0, 1, 3, 7, 15 and 31 s
}
