#include "game/sound/synth.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::sound {

namespace {

constexpr double inaudible = 1e-7;  // of full scale, −140 dB: what is below stops

}  // namespace

Bank::Bank(std::span<const Tone> tones, double rate) {
    for (const Tone& tone : tones) {
        if (count_ == most || tone.frequency > 0.45 * rate) continue;
        Mode& mode = modes_[count_++];
        mode.turn = std::polar(std::exp(-1.0 / (tone.decay * rate)), 2.0 * pi * tone.frequency / rate);
        mode.level = tone.level;
    }
}

double Bank::next(double force) {
    if (!rings_ && force == 0.0) return 0.0;
    double sum = 0.0;
    double loudest = std::abs(force);
    for (std::size_t i = 0; i < count_; ++i) {
        Mode& m = modes_[i];
        const double re = m.state.real() * m.turn.real() - m.state.imag() * m.turn.imag() + force;
        const double im = m.state.real() * m.turn.imag() + m.state.imag() * m.turn.real();
        m.state = {re, im};
        sum += m.level * im;
        loudest = std::max({loudest, std::abs(re), std::abs(im)});
    }
    rings_ = loudest > inaudible;
    if (!rings_)
        for (Mode& m : modes_) m.state = 0.0;
    return sum;
}

double Pulse::next() {
    if (area == 0.0) return 0.0;
    age += 1.0;
    if (age <= 0.0) return 0.0;
    if (age >= length) {
        area = 0.0;
        return 0.0;
    }
    return area / length * (1.0 - std::cos(2.0 * pi * age / length));
}

void Pulses::add(double area, double length, double delay) {
    if (area == 0.0) return;
    for (Pulse& p : pulses_) {
        if (p.area != 0.0) continue;
        p = {area, std::max(length, 2.0), -std::floor(delay)};
        ++count_;
        return;
    }
}

double Pulses::next() {
    if (count_ == 0) return 0.0;
    double sum = 0.0;
    for (Pulse& p : pulses_) {
        if (p.area == 0.0) continue;
        sum += p.next();
        if (p.area == 0.0) --count_;
    }
    return sum;
}

namespace {

// How loud each is, of full scale, before the limiter; chosen, by how the samples of lessons look.
constexpr double strike_level = 0.55, scrape_gain = 0.5, run_level = 0.06, mark_level = 0.08,
                 groan_level = 0.2, click_level = 0.5, slip_level = 1.2, crackle_level = 0.04,
                 bell_level = 0.16, gong_level = 0.22;

constexpr double glide_time = 4e-3, crackle_time = 25e-3;  // s

// A free steel bar bends in these: (k L)² relative to the first of 4.730 (Blevins, Formulas for Natural
// Frequency and Mode Shape, 1979). A hand that holds it damps the low ones least.
constexpr double bar_ratios[] = {1.0, 2.757, 5.404, 8.933, 13.34};
constexpr double bar_decays[] = {0.06, 0.045, 0.03, 0.02, 0.015};  // s
constexpr double bar_levels[] = {1.0, 0.8, 0.6, 0.4, 0.25};
constexpr double sound_in_steel = 5170.0;  // m/s along a bar, √(E/ρ)

double bar_frequency(double length, double height) {
    // 4.730²/(2π √12) c h / L²
    return 1.028 * sound_in_steel * height / square(length);
}

Bank make_wrench(const servo::Wrench& wrench, double rate) {
    // The handle ends a little behind the grip, and is two thirds as thick as the head.
    const double length = std::max(1.15 * wrench.handle_length, 0.05);
    const double height = std::max(0.66 * wrench.jaw.thickness, 2e-3);
    std::array<Tone, 5> tones;
    for (std::size_t i = 0; i < tones.size(); ++i)
        tones[i] = {bar_frequency(length, height) * bar_ratios[i], bar_decays[i], bar_levels[i]};
    return {tones, rate};
}

// A hollow casting, damped by its own graphite; chosen.
constexpr Tone casing_tones[] = {{173, 0.05, 1.0}, {291, 0.04, 0.9},   {468, 0.03, 0.7},
                                 {742, 0.02, 0.5}, {1130, 0.015, 0.4}, {1730, 0.01, 0.3}};
// A nut on its bolt: short and high; chosen.
constexpr Tone nut_tones[] = {{2870, 0.02, 1.0}, {4330, 0.015, 0.7}, {6120, 0.01, 0.4}};
// What a bolt that is being stretched sets humming: joint and wrench as one; chosen.
constexpr Tone groan_tones[] = {{187, 0.03, 1.0}, {311, 0.025, 0.8}, {534, 0.015, 0.6}, {905, 0.01, 0.3}};
constexpr Tone ratchet_tones[] = {{1860, 0.012, 0.8}, {3170, 0.01, 1.0}, {4720, 0.006, 0.6}};
// Two notes a fifth apart, and a low one: none of them is a sound of steel.
constexpr Tone bell_tones[] = {{784.0, 0.25, 1.0}, {1568.0, 0.15, 0.2}};
constexpr Tone second_bell_tones[] = {{1174.7, 0.3, 1.0}, {2349.3, 0.15, 0.2}};
constexpr Tone gong_tones[] = {{146.8, 0.3, 1.0}, {220.2, 0.2, 0.6}, {293.7, 0.15, 0.3}};

constexpr double half_at = 0.3;  // m/s: a strike half as loud as can be

// s: Hertz' contact time falls with the fifth root of the speed; here for a steel wrench of some 0.3 kg, and
// on paint and castings longer.
double contact_time(double speed, Met met) {
    return (met == Met::nut ? 0.12e-3 : 0.35e-3) * std::pow(std::max(speed, 1e-3), -0.2);
}

constexpr double roughness = 0.25e-3;       // m from ridge to ridge of what it slides over
constexpr double full_press = 10.0;         // N
constexpr double full_slide = 0.15;         // m/s
constexpr std::uint32_t scrape_every = 16;  // samples between two looks at where the band is

constexpr double full_run = 8.0;       // rad/s of a nut that fingers spin well
constexpr double most_pitch = 3000.0;  // Hz
constexpr double ticks_below = 150.0;  // Hz: single ticks up to here, the tone from here

constexpr double least_hold = 0.004, more_hold = 0.012;  // rad that the nut sticks before it lets go
constexpr double most_lets_go = 300.0;                   // 1/s

double sane(float value, double most) {
    return std::isfinite(value) ? std::clamp(static_cast<double>(value), 0.0, most) : 0.0;
}

// Straight up to a half, from there bent so that it never gets to 1.
double limited(double x) {
    const double beyond = std::abs(x) - 0.5;
    return beyond <= 0.0 ? x : std::copysign(0.5 + 0.49 * std::tanh(beyond / 0.49), x);
}

double white(Random& noise) { return 2.0 * noise.uniform() - 1.0; }

// The area of a pulse that makes a bank as loud as is wanted: its modes add up.
void hit(Pulses& pulses, double loud, double seconds, double rate, double delay = 0.0) {
    pulses.add(loud, seconds * rate, delay * rate);
}

double scrape(Synth& s) {
    const double slide = s.slide.next(s.follow), press = s.press.next(s.follow);
    if (slide == 0.0 || press == 0.0) {
        s.scrape *= 0.99;
        if (std::abs(s.scrape) < 1e-7) {
            s.scrape = 0.0;
            return 0.0;
        }
    }
    if (s.counted % scrape_every == 0) {
        const double centre = std::clamp(slide / roughness, 250.0, 5000.0);
        const double shrink = std::exp(-pi * 0.8 * centre / s.rate);
        s.scrape_turn = std::polar(shrink, 2.0 * pi * centre / s.rate);
        s.scrape_level = std::sqrt(1.0 - square(shrink));
    }
    const double loud = std::min(1.0, slide / full_slide) * std::sqrt(std::min(1.0, press / full_press));
    s.scrape = s.scrape * s.scrape_turn + s.scrape_level * loud * white(s.noise);
    return scrape_gain * s.scrape.imag();
}

double run(Synth& s) {
    const double speed = s.run.next(s.follow);
    if (speed == 0.0) return 0.0;
    const double pitch = std::min(marks_a_turn * speed / (2.0 * pi), most_pitch);
    const double loud = std::min(1.0, speed / full_run);
    s.phase += pitch / s.rate;
    if (s.phase >= 1.0) {
        s.phase -= 1.0;
        const double apart = square(ticks_below / (ticks_below + pitch));
        s.on_nut.add(mark_level * apart * (0.3 + 0.7 * loud) * s.noise.uniform(0.6, 1.0), 0.15e-3 * s.rate);
    }
    // From a buzz to a note: a pitch that is not heard as one is left to the ticks.
    const double note = square(pitch) / (square(pitch) + square(ticks_below));
    const double turn = 2.0 * pi * s.phase;
    return run_level * loud * note *
           (std::sin(turn) + 0.4 * std::sin(2.0 * turn) + 0.2 * std::sin(3.0 * turn));
}

double creep(Synth& s) {
    const double speed = s.creep.next(s.follow), load = s.load.next(s.follow);
    if (speed > 0.0 && load > 0.0) {
        s.wound += speed / s.rate;
        if (s.wound > s.holds) {
            s.wound = 0.0;
            // The more it bears the longer it sticks.
            const double hold = least_hold + more_hold * std::min(1.0, load) * s.noise.uniform();
            s.holds = std::max(hold, speed / most_lets_go);
            hit(s.on_groan, groan_level * square(load) * s.noise.uniform(0.5, 1.0), 0.8e-3, s.rate);
        }
    }
    return s.groan.next(s.on_groan.next());
}

// Steel that is scraped off the corners.
double crackle(Synth& s) {
    if (s.crackle == 0.0) return 0.0;
    s.crackle *= s.dies;
    if (s.crackle < 1e-4) s.crackle = 0.0;
    return crackle_level * s.crackle * white(s.noise);
}

}  // namespace

double Glide::next(double share) {
    now += share * (target - now);
    if (std::abs(target - now) < 1e-7) now = target;
    return now;
}

Synth make_synth(const servo::Setup& setup, int rate, std::uint64_t seed) {
    Synth s;
    s.rate = rate;
    s.follow = 1.0 - std::exp(-1.0 / (glide_time * s.rate));
    s.dies = std::exp(-1.0 / (crackle_time * s.rate));
    s.noise = Random(seed, 7);
    s.wrench = make_wrench(setup.wrench, s.rate);
    s.casing = {casing_tones, s.rate};
    s.nut = {nut_tones, s.rate};
    s.groan = {groan_tones, s.rate};
    s.ratchet = {ratchet_tones, s.rate};
    s.bell = {bell_tones, s.rate};
    s.second_bell = {second_bell_tones, s.rate};
    s.gong = {gong_tones, s.rate};
    s.holds = least_hold;
    return s;
}

void sound(Synth& s, const Heard& heard) {
    if (const double speed = sane(heard.strike, 10.0); speed > 0.0) {
        const double loud = strike_level * speed / (speed + half_at);
        const double seconds = contact_time(speed, heard.met);
        hit(s.on_wrench, 0.5 * loud, seconds, s.rate);
        if (heard.met == Met::nut)
            hit(s.on_nut, 0.35 * loud, seconds, s.rate);
        else
            hit(s.on_casing, 0.5 * loud, seconds, s.rate);
    }
    s.slide.target = sane(heard.slide, 3.0);
    s.press.target = sane(heard.press, 100.0);
    s.run.target = sane(heard.run, 200.0);
    s.creep.target = sane(heard.creep, 50.0);
    s.load.target = sane(heard.load, 1.5);
    if (const double hard = sane(heard.slip, 1.5); hard > 0.0) {
        hit(s.on_wrench, slip_level * (0.3 + 0.7 * hard), 0.2e-3, s.rate);
        hit(s.on_nut, slip_level * (0.3 + 0.7 * hard), 0.15e-3, s.rate);
        s.crackle = std::min(1.0, s.crackle + 0.3 + 0.7 * hard);
    }
    if (heard.click) {
        hit(s.on_ratchet, click_level, 0.3e-3, s.rate);
        hit(s.on_ratchet, 0.4 * click_level, 0.3e-3, s.rate, 0.018);
    }
    if (heard.done) {
        hit(s.on_bell, bell_level, 0.5e-3, s.rate);
        hit(s.on_second_bell, bell_level, 0.5e-3, s.rate, 0.12);
    }
    if (heard.mistake) hit(s.on_gong, gong_level, 2e-3, s.rate);
}

void rest(Synth& s) { sound(s, {}); }

void render(Synth& s, std::span<float> samples) {
    const double step = steepest / s.rate;
    for (float& sample : samples) {
        double sum = scrape(s) + run(s) + creep(s);
        sum += s.wrench.next(s.on_wrench.next()) + s.casing.next(s.on_casing.next());
        sum += s.nut.next(s.on_nut.next() + crackle(s)) + s.ratchet.next(s.on_ratchet.next());
        sum += s.bell.next(s.on_bell.next()) + s.second_bell.next(s.on_second_bell.next());
        sum += s.gong.next(s.on_gong.next());
        s.last += std::clamp(limited(sum) - s.last, -step, step);
        sample = static_cast<float>(s.last);
        ++s.counted;
    }
}

}  // namespace bolt::sound
