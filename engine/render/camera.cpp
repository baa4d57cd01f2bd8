#include "engine/render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace bolt::render {

namespace {

// Returns the projection of the frustum through [left, right] × [bottom, top] at distance 1.
glm::mat4 frustum(float left, float right, float bottom, float top, float znear, float zfar) {
    glm::mat4 m(0.0F);
    m[0][0] = 2.0F / (right - left);
    m[1][1] = -2.0F / (top - bottom);
    m[2][0] = (right + left) / (right - left);
    m[2][1] = -(top + bottom) / (top - bottom);
    m[2][2] = znear / (zfar - znear);
    m[2][3] = -1.0F;
    m[3][2] = znear * zfar / (zfar - znear);
    return m;
}

}  // namespace

glm::mat4 perspective(const Perspective& p) {
    const float half = std::tan(0.5F * p.fov);
    return frustum(-half * p.aspect, half * p.aspect, -half, half, p.znear, p.zfar);
}

glm::mat4 look_at(const glm::vec3& eye, const glm::vec3& target) {
    const glm::vec3 direction = target - eye;
    const bool vertical = std::abs(direction.x) + std::abs(direction.z) < 1e-4F * std::abs(direction.y);
    return glm::lookAtRH(eye, target,
                         vertical ? glm::vec3(0, 0, direction.y < 0.0F ? -1 : 1) : glm::vec3(0, 1, 0));
}

Eye make_eye(const glm::vec3& eye, const glm::vec3& target, const Perspective& p) {
    return {eye, perspective(p) * look_at(eye, target)};
}

Eye make_eye(const Pose& pose, const FieldOfView& fov, float znear, float zfar) {
    const auto slope = [](double angle) { return static_cast<float>(std::tan(angle)); };
    const Pose view = inverse(pose);
    const glm::mat4 eye_from_world = glm::translate(glm::mat4(1.0F), glm::vec3(view.position)) *
                                     glm::mat4_cast(glm::quat(view.orientation));
    return {glm::vec3(pose.position),
            frustum(slope(fov.left), slope(fov.right), slope(fov.down), slope(fov.up), znear, zfar) *
                eye_from_world};
}

Eye seen_from(const Eye& eye, const Pose& pose) {
    const glm::mat4 old_from_new = glm::translate(glm::mat4(1.0F), glm::vec3(pose.position)) *
                                   glm::mat4_cast(glm::quat(pose.orientation));
    return {glm::vec3(inverse(pose) * Vec3(eye.position)), eye.clip_from_world * old_from_new, eye.hidden};
}

Eye make_wall_eye(const glm::vec3& eye, const glm::vec3& lower_left, const glm::vec3& lower_right,
                  const glm::vec3& upper_left, float znear, float zfar) {
    const glm::vec3 right = glm::normalize(lower_right - lower_left);
    const glm::vec3 up = glm::normalize(upper_left - lower_left);
    const glm::vec3 normal = glm::cross(right, up);
    const glm::vec3 a = lower_left - eye;
    const float distance = -glm::dot(a, normal);
    const float left = glm::dot(a, right) / distance, bottom = glm::dot(a, up) / distance;
    const float width = glm::length(lower_right - lower_left) / distance,
                height = glm::length(upper_left - lower_left) / distance;
    const glm::mat4 rotation = glm::transpose(
        glm::mat4(glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(normal, 0), glm::vec4(0, 0, 0, 1)));
    return {eye, frustum(left, left + width, bottom, bottom + height, znear, zfar) * rotation *
                     glm::translate(glm::mat4(1.0F), -eye)};
}

glm::vec3 framing_eye(const BoundingBox& box, const glm::vec3& side, const Perspective& p) {
    const glm::vec3 middle = 0.5F * (box.low + box.high), back = glm::normalize(side);
    const glm::mat4 view = look_at(middle + back, middle);
    const float tan_y = std::tan(0.5F * p.fov), tan_x = tan_y * p.aspect;
    float distance = 0.0F;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 in_view =
            glm::vec3(view * glm::vec4(box.corner(i), 1.0F)) + glm::vec3(0, 0, 1);  // relative to the middle
        distance = std::max(
            {distance, std::abs(in_view.x) / tan_x + in_view.z, std::abs(in_view.y) / tan_y + in_view.z});
    }
    return middle + back * (1.04F * distance);
}

bool may_be_visible(const BoundingBox& box, const glm::mat4& clip_from_world, float margin) {
    const float edge = 1.0F + margin;
    glm::vec4 corners[8];
    for (int i = 0; i < 8; ++i) corners[i] = clip_from_world * glm::vec4(box.corner(i), 1.0F);
    const auto all = [&](auto outside) {
        return std::all_of(std::begin(corners), std::end(corners), outside);
    };
    return !(all([&](const glm::vec4& c) { return c.x < -edge * c.w; }) ||
             all([&](const glm::vec4& c) { return c.x > edge * c.w; }) ||
             all([&](const glm::vec4& c) { return c.y < -edge * c.w; }) ||
             all([&](const glm::vec4& c) { return c.y > edge * c.w; }) ||
             all([](const glm::vec4& c) { return c.z > c.w; }) ||
             all([](const glm::vec4& c) { return c.z < 0.0F; }));
}

glm::mat4 shadow_view(const BoundingBox& box, const glm::vec3& direction) {
    const glm::mat4 rotation = look_at(glm::vec3(0.0F), glm::normalize(direction));
    const BoundingBox extent = transformed(box, rotation);  // the view looks along -Z
    const glm::vec3 size = glm::max(extent.high - extent.low, glm::vec3(1e-6F));
    const glm::vec3 margin(0.01F);
    glm::mat4 fit(1.0F);
    fit[0][0] = 2.0F / (size.x * (1.0F + 2.0F * margin.x));
    fit[1][1] = -2.0F / (size.y * (1.0F + 2.0F * margin.y));
    fit[2][2] = -1.0F / (size.z * (1.0F + 2.0F * margin.z));
    const glm::vec3 middle = 0.5F * (extent.low + extent.high);
    fit[3] = glm::vec4(-fit[0][0] * middle.x, -fit[1][1] * middle.y, 0.5F - fit[2][2] * middle.z, 1.0F);
    return fit * rotation;
}

}  // namespace bolt::render
