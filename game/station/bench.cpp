#include "game/station/bench.hpp"

#include <utility>

namespace bolt::station_setup {

namespace {

class RunningStation final : public Bench {
  public:
    RunningStation(station::Station station, std::optional<device::VirtualPuck> puck)
        : puck_(std::move(puck)), station_(std::move(station)) {}

    void set_controls(const station::StationControls& controls) override { station_.set_controls(controls); }
    Status send(const station::StationCommand& command) override { return station_.send(command); }
    void push(const device::PuckInput& push) override {
        if (puck_) puck_->set_input(push);
    }
    bool next_tick(station::TickRecord& tick) override { return station_.next_tick(tick); }
    const station::TickRecord& latest_tick() override { return station_.latest_tick(); }
    [[nodiscard]] std::uint64_t lost_ticks() const override { return station_.lost_ticks(); }
    const station::DisplayedHand* hand() override { return station_.hand(); }
    std::vector<std::string> troubles() override { return station_.troubles(); }
    [[nodiscard]] const station::Layout& layout() const override { return station_.layout(); }
    [[nodiscard]] const servo::Setup& setup() const override { return station_.setup(); }
    const servo::Timing* stop() override {
        station_.stop();
        return &station_.servo().timing();
    }

  private:
    std::optional<device::VirtualPuck> puck_;
    station::Station station_;
};

}  // namespace

Result<std::unique_ptr<Bench>> start_bench(station::StationOptions options,
                                           std::optional<device::VirtualPuck> puck) {
    BOLT_TRY_ASSIGN(auto station, station::Station::start(std::move(options)));
    return std::make_unique<RunningStation>(std::move(station), std::move(puck));
}

}  // namespace bolt::station_setup
