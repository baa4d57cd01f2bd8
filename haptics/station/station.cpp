#include "haptics/station/station.hpp"

#include <atomic>

#include "engine/base/spsc_ring.hpp"
#include "haptics/station/hand_line.hpp"

namespace bolt::station {

namespace {

constexpr double hangs = 0.5;              // s that no read and no write of a driver takes
constexpr std::size_t kept_ticks = 32768;  // for a recorder to come by: half a minute at 1 kHz

}  // namespace

struct Station::Shared {
    Layout layout;
    servo::Setup setup;
    servo::State state;
    State mapped;
    std::optional<device::Line> mover, wheel;
    std::optional<glove::Driver> glove;
    std::optional<HandLine> hand;
    TripleBuffer<Wishes> wishes;
    double age = 0.0;  // s, of the newest of them
    TripleBuffer<Ticked> ticked;
    Passed counted;
    TripleBuffer<Passed> passed;
    SpscRing<Ticked> ticks{kept_ticks};
    std::atomic<std::uint64_t> lost{0};
    std::optional<servo::Thread> thread;  // the last member: it stops first

    bool tick(const servo::Beat& beat) {
        Heard heard;
        if (mover) heard.mover = mover->told();
        if (wheel) heard.wheel = wheel->told();
        age = wishes.update() ? 0.0 : age + setup.dt * (1.0 + static_cast<double>(beat.missed));
        heard.wishes = wishes.latest();
        heard.age = age;
        if (hand) heard.hand = hand->grip();
        heard.missed = beat.missed;
        const bool works = !heard.wishes.pause;
        const Answer answer = works ? station::tick(layout, setup, mapped, state, heard)
                                    : station::pause(layout, setup, mapped, heard);
        if (mover) mover->order(answer.mover, true);
        if (wheel) wheel->order(answer.wheel, true);
        count(counted.mover, mapped.mover, answer.mover);
        count(counted.wheel, mapped.wheel, answer.wheel);
        passed.write(counted);
        if (hand)
            hand->place(
                {in_hand(layout, setup, mapped, heard.wishes), mapped.lies.value_or(mapped.output.tool)});
        const Ticked now{beat.number,           mapped.input, mapped.output,
                         mapped.workspace.tool, mapped.lies,  mapped.pressed};
        ticked.write(now);
        if (works && !ticks.push(now)) lost.fetch_add(1, std::memory_order_relaxed);
        return true;
    }
};

Station::Station(std::unique_ptr<Shared> shared) : shared_(std::move(shared)) {}
Station::Station(Station&&) noexcept = default;
Station& Station::operator=(Station&&) noexcept = default;
Station::~Station() = default;

namespace {

Status open(const device::Open& opens, const Plan& plan, std::optional<device::Line>& line,
            std::optional<device::Description>& description) {
    if (!opens) return {};
    Result<device::Line> started = device::Line::start(opens, plan.line);
    if (!started) return fail(started.error());
    line = std::move(*started);
    auto found = line->await(plan.patience);
    if (!found) return fail(found.error());
    description = **found;
    return {};
}

}  // namespace

Result<Station> Station::start(Plan plan) {
    auto shared = std::make_unique<Shared>();
    Shared& s = *shared;
    s.layout.mover_buttons = plan.mover_buttons;
    s.layout.wheel_buttons = plan.wheel_buttons;
    s.layout.workspace = plan.workspace;
    s.layout.home = plan.home;
    if (Status ok = open(plan.mover, plan, s.mover, s.layout.mover); !ok) return fail(ok.error());
    if (Status ok = open(plan.wheel, plan, s.wheel, s.layout.wheel); !ok) return fail(ok.error());
    if (Status ok = check(s.layout); !ok) return fail(ok.error());
    if (plan.hand && plan.glove.empty())
        return fail(ErrorCode::no_device, "a hand without a glove", "the port that its glove is on");
    if (plan.hand) s.layout.wrist = plan.hand->wrist;
    if (plan.hand)
        s.hand = HandLine::start(glove::Driver::start(plan.glove), std::move(*plan.hand));
    else if (!plan.glove.empty())
        s.glove = glove::Driver::start(plan.glove);

    s.setup = plan.setup(limits_of(s.layout), 1.0 / plan.servo.rate);
    if (plan.state) {
        Result<servo::State> state = plan.state(s.setup);
        if (!state) return fail(state.error());
        s.state = std::move(*state);
    } else {
        s.state = servo::initial_state(s.setup);
    }
    s.mapped = initial_state(s.layout);
    s.wishes.write(plan.wishes);

    Result<servo::Thread> thread =
        servo::Thread::start(plan.servo, [&s](const servo::Beat& beat) { return s.tick(beat); });
    if (!thread) return fail(thread.error());
    s.thread = std::move(*thread);
    return Station(std::move(shared));
}

void Station::wish(const Wishes& wishes) { shared_->wishes.write(wishes); }

const Ticked& Station::newest() {
    shared_->ticked.update();
    return shared_->ticked.latest();
}

bool Station::next(Ticked& tick) { return shared_->ticks.pop(tick); }
std::uint64_t Station::lost() const { return shared_->lost.load(std::memory_order_relaxed); }

std::vector<std::string> Station::troubles() {
    std::vector<std::string> words;
    for (auto* line : {&shared_->mover, &shared_->wheel}) {
        if (!line->has_value()) continue;
        const device::Report& report = (*line)->report();
        if (!report.trouble.empty()) words.push_back(report.trouble);
        if (report.state == device::State::usable && (*line)->away() > hangs)
            words.push_back(report.description->name + " hangs: unplug it and plug it in again");
    }
    const Ticked& tick = newest();
    // That a device is silent its line has said better.
    const force::Fault fault = tick.output.fault;
    if (tick.input.enabled && fault != force::Fault::none && (fault != force::Fault::silent || words.empty()))
        words.emplace_back(force::name(fault));
    if (shared_->glove && shared_->glove->report().trouble[0] != '\0')
        words.emplace_back(shared_->glove->report().trouble.data());
    if (shared_->hand)
        for (std::string& trouble : shared_->hand->troubles()) words.push_back(std::move(trouble));
    return words;
}

const device::Report* Station::mover() { return shared_->mover ? &shared_->mover->report() : nullptr; }
const device::Report* Station::wheel() { return shared_->wheel ? &shared_->wheel->report() : nullptr; }
const glove::Report* Station::gloved() {
    return shared_->hand ? &shared_->hand->report() : shared_->glove ? &shared_->glove->report() : nullptr;
}
const Passed& Station::passed() {
    shared_->passed.update();
    return shared_->passed.latest();
}
const ShownHand* Station::hand() { return shared_->hand ? &shared_->hand->shown() : nullptr; }
const Layout& Station::layout() const { return shared_->layout; }
const servo::Setup& Station::setup() const { return shared_->setup; }
glove::Driver* Station::glove() { return shared_->glove ? &*shared_->glove : nullptr; }
servo::Thread& Station::servo() { return *shared_->thread; }
void Station::stop() { shared_->thread->stop(); }

}  // namespace bolt::station
