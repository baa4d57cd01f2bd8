#include "tests/monado/headset_driver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/gpu/resources.hpp"
#include "tests/support/need.hpp"

namespace bolt::test {

Status HeadsetDriver::start(view::GpuContext& gpu_context) {
    gpu_ = &gpu_context;
    return app_.start(gpu_context);
}

void HeadsetDriver::release() {
    app_.release();
    gpu_ = nullptr;
    drawn_.reset();
}

// How well the runtime returns what was sent in the user's last turn.
void HeadsetDriver::compare(const view::Immersion& immersion) {
    for (std::size_t side = 0; side < sent_.sides.size(); ++side) {
        const xr::HandInput &sent = sent_.sides[side], &got = immersion.hands.sides[side];
        if (!sent.active || !sent.grip) continue;
        if (!got.active || !got.grip) {
            ++frames_.without_hand;
            continue;
        }
        frames_.grip_error =
            std::max(frames_.grip_error, glm::distance(sent.grip->pose.position, got.grip->pose.position));
        if (std::abs(sent.grasp - got.grasp) > 1e-3F || std::abs(sent.select - got.select) > 1e-3F)
            frames_.unlike_trigger = true;
    }
}

Status HeadsetDriver::update(const view::WindowFrame& window) {
    view::WindowFrame slow = window;
    slow.seconds = std::min(window.seconds, options_.step);
    const auto now = std::chrono::steady_clock::now();
    const bool seen = window.immersion != nullptr && window.immersion->attentive;
    if (seen) {
        compare(*window.immersion);
        received_ = window.immersion->hands;
        ++frames_.count;
        if (last_frame_) frames_.seconds += std::chrono::duration<double>(now - *last_frame_).count();
    }
    last_frame_ = seen ? std::optional(now) : std::nullopt;
    BOLT_TRY(take_picture());
    return app_.update(slow);
}

Status HeadsetDriver::draw(gpu::FrameContext& frame, const view::WindowFrame& window) {
    const bool seen = window.immersion != nullptr && window.immersion->attentive;
    const double time = app_.lesson() ? app_.lesson()->session->time() : 0.0;
    newly_drawn_ = !seen || !drawn_ || app_.screen() != trainer::ShownScreen::lesson ||
                   time >= drawn_at_ + options_.draw_interval || time < drawn_at_;
    if (newly_drawn_) {
        drawn_at_ = time;
        BOLT_TRY(app_.draw(frame, window));
        if (seen && !window.immersion->groups.empty()) drawn_ = window.immersion->groups.front().size;
    }
    if (seen) user_done_ = turns_.give();
    return {};
}

// The pictures of the last frame, which were copied into the headset's.
Status HeadsetDriver::take_picture() {
    if (options_.pictures.empty() || !drawn_ || !newly_drawn_) return {};
    BOLT_TRY(gpu_->frames->finish());
    std::vector<render::Picture> eyes;
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
        const render::ImageLayer made = gpu_->renderer->picture(eye, view::immersive_group);
        BOLT_TRY_ASSIGN(const auto texels,
                        gpu::download_image(*gpu_->device, *made.image, gpu::ResourceUse::transfer_from, 4, 0,
                                            made.layer));
        render::Picture& picture = eyes.emplace_back(render::Picture{drawn_->width, drawn_->height, {}});
        for (const std::byte b : texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
    }
    return view::write_picture(view::side_by_side(eyes),
                               options_.pictures / fmt::format("{:05}.png", pictures_++));
}

void HeadsetDriver::frame(const Pose& head, const xr::Hands& hands) {
    sent_ = hands;
    need(remote_.send(head, hands));
    turns_.take();
}

}  // namespace bolt::test
