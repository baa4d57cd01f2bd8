// JSON output: keys in insertion order, floats as the shortest text that reads back as the same float.
#pragma once

#include <charconv>
#include <cstdlib>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <nlohmann/json.hpp>

namespace bolt::assets {

using Json = nlohmann::ordered_json;

// Returns the double whose shortest text is that of the float: 0.1F becomes 0.1, not 0.10000000149.
inline double number(float value) {
    char text[32];
    const auto [end, status] = std::to_chars(text, text + sizeof text - 1, value);
    if (status != std::errc{}) return static_cast<double>(value);
    *end = '\0';
    return std::strtod(text, nullptr);
}

inline Json array(const glm::vec2& v) { return {number(v.x), number(v.y)}; }
inline Json array(const glm::vec3& v) { return {number(v.x), number(v.y), number(v.z)}; }
inline Json array(const glm::vec4& v) { return {number(v.x), number(v.y), number(v.z), number(v.w)}; }
inline Json array(const glm::quat& q) { return {number(q.x), number(q.y), number(q.z), number(q.w)}; }

}  // namespace bolt::assets
