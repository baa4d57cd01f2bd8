#include "game/station/bench.hpp"

#include <utility>

namespace bolt::station {

namespace {

class AtWork final : public Bench {
  public:
    AtWork(Station station, std::optional<device::Puck> puck)
        : puck_(std::move(puck)), station_(std::move(station)) {}

    void wish(const Wishes& wishes) override { station_.wish(wishes); }
    void push(const device::Push& push) override {
        if (puck_) puck_->put(push);
    }
    bool next(Ticked& tick) override { return station_.next(tick); }
    const Ticked& newest() override { return station_.newest(); }
    [[nodiscard]] std::uint64_t lost() const override { return station_.lost(); }
    const ShownHand* hand() override { return station_.hand(); }
    std::vector<std::string> troubles() override { return station_.troubles(); }
    [[nodiscard]] const Layout& layout() const override { return station_.layout(); }
    [[nodiscard]] const servo::Setup& setup() const override { return station_.setup(); }
    const servo::Timing* stop() override {
        station_.stop();
        return &station_.servo().timing();
    }

  private:
    std::optional<device::Puck> puck_;
    Station station_;
};

}  // namespace

Result<std::unique_ptr<Bench>> start_bench(Plan plan, std::optional<device::Puck> puck) {
    Result<Station> station = Station::start(std::move(plan));
    if (!station) return fail(station.error());
    return std::make_unique<AtWork>(std::move(*station), std::move(puck));
}

}  // namespace bolt::station
