#include "game/view/head_source.hpp"

#include <limits>
#include <utility>

#include "engine/tracking/recorded_poses.hpp"

namespace bolt::view {

tracking::TrackerRegistration registration_of(const content::HeadTracking& head) {
    return {content::orientation_of(head.axes), head.scale, head.tracker_in_room, head.head_in_body};
}

Result<HeadSource> HeadSource::open(const content::HeadTracking& head, const std::filesystem::path& folder) {
    HeadSource source;
    source.registration_ = registration_of(head);
    source.settings_.fixed_head = head.fixed_head;
    source.settings_.hold = head.hold;
    source.settings_.fade = head.fade;
    source.settings_.max_speed = head.max_speed;
    source.settings_.jump_time = head.jump_time;
    source.body_ = head.body;
    switch (head.tracker) {
        case content::HeadTracker::fixed:
            break;
        case content::HeadTracker::dtrack: {
            BOLT_TRY_ASSIGN(auto receiver, tracking::DtrackReceiver::open(head.port));
            source.source_ = std::move(receiver);
            break;
        }
        case content::HeadTracker::file: {
            BOLT_TRY_ASSIGN(auto poses, tracking::load_recorded_poses(folder / head.recording));
            source.source_ = Recording{std::move(poses), {}, -std::numeric_limits<double>::infinity()};
            break;
        }
        case content::HeadTracker::openxr:
            return fail(ErrorCode::no_device, "the head's tracker is \"openxr\", which is not supported yet",
                        "\"fixed\", \"dtrack\" or \"file\"");
    }
    return source;
}

std::vector<tracking::HeadSample> HeadSource::samples_until(double seconds) {
    std::vector<tracking::HeadSample> samples;
    if (auto* receiver = std::get_if<tracking::DtrackReceiver>(&source_)) {
        // The time of arrival: the tracker's clock is another one.
        if (const std::optional<tracking::DtrackFrame> frame = receiver->poll())
            if (const tracking::DtrackBody* body = tracking::find_body(*frame, body_))
                samples.push_back({seconds, tracking::head_in_room(registration_, body->pose)});
    } else if (auto* recording = std::get_if<Recording>(&source_)) {
        if (!recording->begin) {
            const double first = recording->poses.empty() ? 0.0 : recording->poses.front().time;
            recording->begin = seconds - first;
        }
        const double until = seconds - *recording->begin;
        for (const tracking::HeadSample& pose :
             tracking::poses_between(recording->poses, recording->played, until))
            samples.push_back(
                {pose.time + *recording->begin, tracking::head_in_room(registration_, pose.pose)});
        recording->played = until;
    }
    return samples;
}

tracking::FilteredHead HeadSource::at(double seconds) {
    if (std::holds_alternative<Fixed>(source_)) return {settings_.fixed_head, tracking::HeadStatus::tracked};
    return tracking::filter_head(filter_, settings_, samples_until(seconds), seconds);
}

std::string HeadSource::take_change() {
    if (std::holds_alternative<Fixed>(source_) || !filter_.shown) return {};
    const tracking::HeadStatus status = filter_.shown->status;
    if (told_ == status) return {};
    const bool first = !told_;
    told_ = status;
    switch (status) {
        case tracking::HeadStatus::tracked:
            return first ? "head: tracked" : "head: tracked again";
        case tracking::HeadStatus::held:
            return "head: not tracked; its last pose is used";
        case tracking::HeadStatus::faded:
            return first ? "head: not tracked; the fixed pose of the display file is used"
                         : "head: not tracked; it moves to the fixed pose of the display file";
    }
    return {};
}

}  // namespace bolt::view
