// Messages between the processes of a cluster: a writer and a reader of plain values. All processes run the
// same build on processors of one byte order, so values are copied as they are in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::cluster {

using Message = std::vector<std::byte>;

// Numbers, enumerations, and the vectors, matrices and quaternions of GLM.
template <class T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
    (std::is_trivially_copyable_v<T>&& requires { T::length(); });

class MessageWriter {
  public:
    template <PlainValue T>
    void put(const T& value) {
        add(std::as_bytes(std::span(&value, 1)));
    }
    template <PlainValue T>
    void put_all(std::span<const T> values) {
        put(static_cast<std::uint32_t>(values.size()));
        add(std::as_bytes(values));
    }
    void put_pose(const Pose& pose) {
        put(pose.position);
        put(pose.orientation);
    }
    void put_text(std::string_view text) { put_all(std::span<const char>(text)); }

    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] const Message& message() const { return bytes_; }

  private:
    void add(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
    Message bytes_;
};

// Reads what a MessageWriter wrote, in the same order. After a read past the end of the message, ok() is
// false, and this and all further values are zero or empty.
class MessageReader {
  public:
    explicit MessageReader(std::span<const std::byte> message) : rest_(message) {}

    template <PlainValue T>
    T get() {
        T value{};
        if (rest_.size() < sizeof(T)) {
            mark_damaged();
        } else if constexpr (std::is_same_v<T, bool>) {
            value = rest_.front() != std::byte{0};
            rest_ = rest_.subspan(1);
        } else {
            std::memcpy(&value, rest_.data(), sizeof(T));
            rest_ = rest_.subspan(sizeof(T));
        }
        return value;
    }
    template <PlainValue T>
    std::vector<T> get_all() {
        const std::size_t count = get<std::uint32_t>();
        if (count > rest_.size() / sizeof(T)) {
            mark_damaged();
            return {};
        }
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), rest_.data(), count * sizeof(T));
        rest_ = rest_.subspan(count * sizeof(T));
        return values;
    }
    Pose get_pose() {
        Pose pose;
        pose.position = get<Vec3>();
        pose.orientation = get<Quat>();
        return pose;
    }
    std::string get_text() {
        const std::vector<char> text = get_all<char>();
        return {text.begin(), text.end()};
    }

    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] std::size_t size() const { return rest_.size(); }  // bytes that are left
    // Has the effect of a read past the end. Call it if a value is out of its range.
    void mark_damaged() {
        ok_ = false;
        rest_ = {};
    }

  private:
    std::span<const std::byte> rest_;
    bool ok_ = true;
};

}  // namespace bolt::cluster
