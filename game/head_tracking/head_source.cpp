#include "game/head_tracking/head_source.hpp"

#include <algorithm>
#include <limits>

#include "engine/tracking/recorded_poses.hpp"

namespace bolt::head_tracking {

using content::HeadTracker;

namespace {

constexpr double search_interval = 1.0;  // s

xr::TrackedDevice device_of(content::TrackedPose pose) {
    switch (pose) {
        case content::TrackedPose::left_hand:
            return xr::TrackedDevice::left_controller;
        case content::TrackedPose::right_hand:
            return xr::TrackedDevice::right_controller;
        case content::TrackedPose::headset:
            break;
    }
    return xr::TrackedDevice::headset;
}

}  // namespace

Result<HeadSource> HeadSource::open(const content::HeadTracking& head, const std::filesystem::path& folder) {
    HeadSource source;
    source.registration_ = {content::orientation_of(head.axes), head.scale, head.tracker_in_room,
                            head.head_in_body};
    source.settings_.fixed_head = head.fixed_head;
    source.settings_.dropout_time = head.hold;
    source.settings_.fade_time = head.fade;
    source.settings_.max_speed = head.max_speed;
    source.settings_.jump_time = head.jump_time;
    source.body_ = head.body;
    source.flystick_ = head.flystick;
    if (head.tracker == HeadTracker::dtrack) {
        BOLT_TRY_ASSIGN(auto receiver, tracking::DtrackReceiver::open(head.port));
        source.receiver_ = std::move(receiver);
    } else if (head.tracker == HeadTracker::file) {
        BOLT_TRY_ASSIGN(auto poses, tracking::load_recorded_poses(folder / head.recording));
        source.recording_ = std::move(poses);
    } else if (head.tracker == HeadTracker::openxr) {
        source.tracked_ = device_of(head.pose);
        BOLT_TRY_ASSIGN(source.openxr_, xr::PoseTracker::open(*source.tracked_));
    }
    return source;
}

void HeadSource::add_sample(const tracking::BodySample& body) {
    ++counts_.samples;
    waiting_.push_back({body.time, tracking::head_in_room(registration_, body.pose)});
}

void HeadSource::read_wand(const tracking::DtrackFrame& frame, double now) {
    if (!flystick_) return;
    const tracking::DtrackFlystick* seen = tracking::find_flystick(frame, flystick_->id);
    if (seen == nullptr) return;
    tracking::TrackerRegistration aim = registration_;
    aim.head_in_body = flystick_->aim_in_body;
    const auto pressed = [&](int button) {
        return button > 0 && ((seen->buttons >> (button - 1)) & 1U) != 0;
    };
    Wand& wand = wand_.emplace();
    if (seen->pose) wand.aim = tracking::head_in_room(aim, *seen->pose);
    wand.select = pressed(flystick_->select);
    wand.menu = pressed(flystick_->menu);
    wand.tool = pressed(flystick_->tool);
    wand.stick_x = seen->stick_x;
    wand.stick_y = seen->stick_y;
    wand_time_ = now;
}

// DTrack has a clock of its own, so a frame gets the time of its arrival.
void HeadSource::receive(double now) {
    const auto frame = receiver_->poll();
    counts_.dtrack = receiver_->counts();
    if (wand_ && now - wand_time_ > tracking::max_sample_age) wand_.reset();
    if (!frame) return;
    read_wand(*frame, now);
    for (const tracking::DtrackBody& body : frame->bodies) {
        const auto at = std::lower_bound(counts_.bodies.begin(), counts_.bodies.end(), body.id);
        if (at == counts_.bodies.end() || *at != body.id) counts_.bodies.insert(at, body.id);
    }
    if (const tracking::DtrackBody* body = tracking::find_body(*frame, body_)) add_sample({now, body->pose});
}

void HeadSource::play(double now) {
    if (!started_) {
        started_ = now - recording_.front().time;
        played_until_ = -std::numeric_limits<double>::infinity();
    }
    const double until = now - *started_;
    for (const tracking::BodySample& pose : tracking::poses_between(recording_, played_until_, until))
        add_sample({pose.time + *started_, pose.pose});
    played_until_ = until;
}

void HeadSource::track(double now) {
    if (!openxr_ && now >= next_search_) {
        next_search_ = now + search_interval;
        if (auto found = xr::PoseTracker::open(*tracked_)) openxr_ = std::move(*found);
    }
    if (!openxr_) return;
    const auto pose = openxr_->read();
    if (!pose)
        openxr_.reset();
    else if (*pose)
        add_sample({now, **pose});
}

tracking::FilteredHead HeadSource::at(double now) {
    if (tracked_) track(now);
    if (receiver_) receive(now);
    if (!recording_.empty()) play(now);
    const tracking::FilteredHead head = tracking::filter_head(state_, settings_, waiting_, now);
    waiting_.clear();
    return head;
}

}  // namespace bolt::head_tracking
