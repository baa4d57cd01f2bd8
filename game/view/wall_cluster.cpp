#include "game/view/wall_cluster.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/steady_seconds.hpp"

namespace bolt::view {

namespace {

using cluster::Cluster;
using cluster::Message;
using cluster::MessageReader;
using cluster::MessageWriter;
using platform::InputEvent;

// A process may compile shaders and load models for a while.
constexpr double longest_silence = 60.0, noticed_silence = 3.0;  // s
constexpr double forever = std::numeric_limits<double>::infinity();

enum class MessageKind : std::uint8_t {
    hello,    // the fingerprint of a process that is ready
    frame,    // a ClusterFrame
    bulk,     // ClusterFrame::bulk of the next frame
    ping,     // 4 KiB, which come back
    drawn,    // the sender's delay in the frame before, and the input of its windows
    present,  // the permission
    failed,   // exit code and text of an error
    end,      // the first process ends; the reason
};

enum class SentEventKind : std::uint8_t { key, text, close };

void put_events(MessageWriter& message, std::span<const InputEvent> events) {
    std::uint32_t count = 0;
    MessageWriter kept;
    for (const InputEvent& event : events) {
        if (const auto* key = std::get_if<platform::KeyEvent>(&event)) {
            kept.put(SentEventKind::key);
            kept.put(key->key);
            for (const bool state : {key->down, key->repeated, key->modifiers.shift, key->modifiers.control,
                                     key->modifiers.alt, key->modifiers.super})
                kept.put(state);
        } else if (const auto* text = std::get_if<platform::TextEvent>(&event)) {
            kept.put(SentEventKind::text);
            kept.put(text->character);
        } else if (std::holds_alternative<platform::CloseEvent>(event)) {
            kept.put(SentEventKind::close);
        } else {
            continue;
        }
        ++count;
    }
    message.put(count);
    message.put_all(std::span<const std::byte>(kept.message()));
}

std::vector<InputEvent> get_events(MessageReader& message) {
    const auto count = message.get<std::uint32_t>();
    const Message bytes = message.get_all<std::byte>();
    MessageReader kept(bytes);
    std::vector<InputEvent> events;
    for (std::uint32_t i = 0; i < count && kept.ok(); ++i) {
        switch (kept.get<SentEventKind>()) {
            case SentEventKind::key: {
                platform::KeyEvent key;
                key.key = kept.get<platform::Key>();
                if (static_cast<std::size_t>(key.key) >= platform::key_count) kept.mark_damaged();
                for (bool* state : {&key.down, &key.repeated, &key.modifiers.shift, &key.modifiers.control,
                                    &key.modifiers.alt, &key.modifiers.super})
                    *state = kept.get<bool>();
                events.emplace_back(key);
                break;
            }
            case SentEventKind::text:
                events.emplace_back(platform::TextEvent{kept.get<char32_t>()});
                break;
            case SentEventKind::close:
                events.emplace_back(platform::CloseEvent{});
                break;
            default:
                kept.mark_damaged();
        }
    }
    if (!kept.ok()) events.clear();
    return events;
}

Error lost_process(Cluster& cluster, int process) {
    cluster.abandon();
    Error error;
    error.what = fmt::format("{} has not answered for {:.0f} s", cluster.describe(process), longest_silence);
    error.expected = "all processes of the walls; restart them with mpirun";
    return error;
}

Error strange_message(const Cluster& cluster, int process) {
    return {ErrorCode::failed, fmt::format("{} sent an unexpected message", cluster.describe(process)),
            "the same program in all processes"};
}

ErrorCode get_code(MessageReader& message) {
    const auto code = message.get<std::uint8_t>();
    return code >= 1 && code <= 4 ? static_cast<ErrorCode>(code) : ErrorCode::failed;
}

// The error with which the first process has ended; none: it has ended without one.
std::optional<Error> reason_of_end(const Cluster& cluster, MessageReader& message) {
    Error error;
    error.code = get_code(message);
    const std::string reason = message.get_text();
    if (reason.empty()) return std::nullopt;
    error.what = fmt::format("{} has ended: {}", cluster.describe(0), reason);
    return error;
}

// The error that another process has reported, with the name of that process before it.
Error reported_error(const Cluster& cluster, int process, MessageReader& message) {
    Error error;
    error.code = get_code(message);
    error.what = fmt::format("{}: {}", cluster.describe(process), message.get_text());
    error.expected = message.get_text();
    return error;
}

double median(std::vector<float> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return static_cast<double>(*middle);
}

}  // namespace

// The next message of a process; none if the program was asked to end.
Result<std::optional<Message>> WallLeader::answer_of(int process) {
    BOLT_TRY_ASSIGN(auto soon, cluster_->receive(process, noticed_silence, stop_));
    if (soon || stop_()) return soon;  // mpirun asks to end when a process has died
    if (log_) log_(fmt::format("walls: {} does not answer; waiting", cluster_->describe(process)));
    BOLT_TRY_ASSIGN(auto late, cluster_->receive(process, longest_silence - noticed_silence, stop_));
    if (late || stop_()) return late;
    return fail(lost_process(*cluster_, process));
}

Result<WallLeader> WallLeader::begin(Cluster& cluster, std::uint64_t fingerprint, StopWaiting stop,
                                     std::function<void(const std::string&)> log) {
    WallLeader leader(cluster, std::move(stop), std::move(log));
    for (int process = 1; process < cluster.size(); ++process) {
        BOLT_TRY_ASSIGN(const auto answer, leader.answer_of(process));
        if (!answer) continue;  // the program ends
        MessageReader message(*answer);
        const auto kind = message.get<MessageKind>();
        Error error;
        if (kind == MessageKind::failed)
            error = reported_error(cluster, process, message);
        else if (kind != MessageKind::hello)
            error = strange_message(cluster, process);
        else if (message.get<std::uint64_t>() != fingerprint)
            error = {ErrorCode::bad_content,
                     fmt::format("{} has another display file or another version of the program",
                                 cluster.describe(process)),
                     "the same on all computers"};
        else
            continue;
        return fail(error);
    }
    return leader;
}

// Sends messages of 4 KiB to each process and back. Call it when all processes wait for a frame.
Status WallLeader::measure_transport() {
    constexpr int rounds = 15;
    MessageWriter message;
    message.put(MessageKind::ping);
    message.put_all(std::span<const std::byte>(Message(4096 - message.size() - sizeof(std::uint32_t))));
    for (int process = 1; process < cluster_->size(); ++process)
        for (int round = 0; round < rounds; ++round) {
            const double begin = steady_seconds();
            BOLT_TRY(cluster_->send(process, message.message()));
            BOLT_TRY_ASSIGN(const auto answer, answer_of(process));
            if (!answer) return {};
            MessageReader reader(*answer);
            const auto kind = reader.get<MessageKind>();
            if (kind == MessageKind::failed) return fail(reported_error(*cluster_, process, reader));
            if (kind != MessageKind::ping) return fail(strange_message(*cluster_, process));
            transports_.push_back(static_cast<float>(0.5 * (steady_seconds() - begin)));
        }
    return {};
}

Status WallLeader::send(const ClusterFrame& frame) {
    // All have drawn the first frame, so they do nothing else now.
    if (sizes_.size() == 1) BOLT_TRY(measure_transport());
    if (!frame.bulk.empty()) {
        MessageWriter bulk;
        bulk.put(MessageKind::bulk);
        bulk.put_all(std::span<const std::byte>(frame.bulk));
        largest_bulk_ = std::max(largest_bulk_, static_cast<std::uint32_t>(bulk.size()));
        for (int process = 1; process < cluster_->size(); ++process)
            BOLT_TRY(cluster_->send(process, bulk.message()));
    }
    MessageWriter message;
    message.put(MessageKind::frame);
    message.put(frame.number);
    message.put_pose(frame.head);
    message.put(frame.tracked);
    message.put_all(std::span<const std::byte>(frame.content));
    sizes_.push_back(static_cast<std::uint32_t>(message.size()));
    for (int process = 1; process < cluster_->size(); ++process)
        BOLT_TRY(cluster_->send(process, message.message()));
    return {};
}

Result<std::vector<InputEvent>> WallLeader::wait_until_drawn() {
    std::vector<InputEvent> events;
    double first = own_delay_, last = own_delay_;
    for (int process = 1; process < cluster_->size(); ++process) {
        BOLT_TRY_ASSIGN(const auto answer, answer_of(process));
        if (!answer) return events;
        MessageReader message(*answer);
        const auto kind = message.get<MessageKind>();
        if (kind == MessageKind::failed) return fail(reported_error(*cluster_, process, message));
        if (kind != MessageKind::drawn) return fail(strange_message(*cluster_, process));
        const auto delay = message.get<double>();
        first = std::min(first, delay);
        last = std::max(last, delay);
        for (InputEvent& event : get_events(message)) events.push_back(event);
        if (!message.ok()) return fail(strange_message(*cluster_, process));
    }
    if (permitted_ > 0.0) skews_.push_back(static_cast<float>(last - first));
    return events;
}

Status WallLeader::permit() {
    MessageWriter message;
    message.put(MessageKind::present);
    permitted_ = steady_seconds();
    for (int process = 1; process < cluster_->size(); ++process)
        BOLT_TRY(cluster_->send(process, message.message()));
    return {};
}

void WallLeader::presented() { own_delay_ = steady_seconds() - permitted_; }

void WallLeader::end(const std::optional<Error>& error) {
    if (!std::exchange(ended_, true)) end_others(*cluster_, error);
}

void WallLeader::end_others(Cluster& cluster, const std::optional<Error>& error) {
    MessageWriter message;
    message.put(MessageKind::end);
    message.put(static_cast<std::uint8_t>(error ? error->code : ErrorCode::failed));
    message.put_text(error ? error->message() : "");
    // A failure is ignored: a process that has already ended needs no message.
    for (int process = 1; process < cluster.size(); ++process) (void)cluster.send(process, message.message());
}

std::string WallLeader::summary() const {
    const std::vector<float> sizes(sizes_.begin(), sizes_.end());
    const auto largest = [](const std::vector<float>& values) {
        return values.empty() ? 0.0 : static_cast<double>(*std::max_element(values.begin(), values.end()));
    };
    return fmt::format(
        "walls: {} frames in {} processes; a frame has {:.0f} bytes (median; largest {:.0f}), and up to {} "
        "bytes of new lessons and of the panel; a message of 4 KiB takes {:.3f} ms (median; longest {:.3f} "
        "ms); the processes presented {:.2f} ms apart (median; largest {:.2f} ms)",
        sizes_.size(), cluster_->size(), median(sizes), largest(sizes), largest_bulk_,
        1e3 * median(transports_), 1e3 * largest(transports_), 1e3 * median(skews_), 1e3 * largest(skews_));
}

Result<WallFollower> WallFollower::begin(Cluster& cluster, std::uint64_t fingerprint, StopWaiting stop) {
    MessageWriter message;
    message.put(MessageKind::hello);
    message.put(fingerprint);
    BOLT_TRY(cluster.send(0, message.message()));
    return WallFollower(cluster, std::move(stop));
}

Result<std::optional<ClusterFrame>> WallFollower::next_frame() {
    ClusterFrame frame;
    // The first process may be in a menu for hours; if it dies, mpirun ends this one.
    for (;;) {
        BOLT_TRY_ASSIGN(const auto received, cluster_->receive(0, forever, stop_));
        if (!received) return std::optional<ClusterFrame>();
        MessageReader message(*received);
        switch (message.get<MessageKind>()) {
            case MessageKind::end:
                if (auto error = reason_of_end(*cluster_, message)) return fail(std::move(*error));
                return std::optional<ClusterFrame>();
            case MessageKind::ping:
                BOLT_TRY(cluster_->send(0, *received));
                break;
            case MessageKind::bulk:
                frame.bulk = message.get_all<std::byte>();
                if (!message.ok()) return fail(strange_message(*cluster_, 0));
                break;
            case MessageKind::frame:
                BOLT_TRY(read_frame(message, frame));
                return std::optional(std::move(frame));
            default:
                return fail(strange_message(*cluster_, 0));
        }
    }
}

Status WallFollower::read_frame(MessageReader& message, ClusterFrame& frame) {
    frame.number = message.get<std::uint64_t>();
    frame.head = message.get_pose();
    frame.tracked = message.get<bool>();
    frame.content = message.get_all<std::byte>();
    return message.ok() ? Status{} : fail(strange_message(*cluster_, 0));
}

Result<bool> WallFollower::wait_for_permission(std::span<const InputEvent> events) {
    MessageWriter message;
    message.put(MessageKind::drawn);
    message.put(delay_);
    put_events(message, events);
    BOLT_TRY(cluster_->send(0, message.message()));
    BOLT_TRY_ASSIGN(const auto received, cluster_->receive(0, forever, stop_));
    if (!received) return false;
    MessageReader answer(*received);
    const auto kind = answer.get<MessageKind>();
    if (kind == MessageKind::end) {
        if (auto error = reason_of_end(*cluster_, answer)) return fail(std::move(*error));
        return false;
    }
    if (kind != MessageKind::present) return fail(strange_message(*cluster_, 0));
    permitted_ = steady_seconds();
    return true;
}

void WallFollower::presented() { delay_ = steady_seconds() - permitted_; }

void WallFollower::report(Cluster& cluster, const Error& error) {
    MessageWriter message;
    message.put(MessageKind::failed);
    message.put(static_cast<std::uint8_t>(error.code));
    Error without = error;
    without.expected.clear();
    message.put_text(without.message());
    message.put_text(error.expected);
    (void)cluster.send(0, message.message());
}

}  // namespace bolt::view
