#include "tools/verify/pathtrace/render.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/parallel.hpp"

#include "tools/verify/pathtrace/sampler.hpp"

namespace bolt::pathtrace {

namespace {

constexpr int min_bounces = 3;            // before Russian roulette may end a path
constexpr int max_transparent_hits = 64;  // transparent surfaces that a ray passes

float power_heuristic(float a, float b) { return a * a / (a * a + b * b); }

struct Tracer {
    const TracedScene& scene;
    const Environment& environment;
    const PathTraceSettings& settings;

    glm::vec3 trace_path(glm::vec3 origin, glm::vec3 direction, SobolSampler sampler) const;
    glm::vec3 direct_light(const SurfaceHit& hit, const Bsdf& bsdf, const glm::vec3& out,
                           SobolSampler& sampler) const;
    float transmittance(glm::vec3 origin, const glm::vec3& direction, float distance) const;
    glm::vec3 environment_light(const glm::vec3& direction, int bounce, float density) const;
};

// Returns the fraction of light that passes along the segment: 0 or 1 unless there are transparent materials.
float Tracer::transmittance(glm::vec3 origin, const glm::vec3& direction, float distance) const {
    if (!scene.transparent()) return scene.blocked(origin, direction, distance) ? 0.0F : 1.0F;
    float part = 1.0F;
    for (int i = 0; i < max_transparent_hits; ++i) {
        const auto hit = scene.cast(origin, direction);
        if (!hit || hit->distance >= distance) return part;
        part *= 1.0F - scene.shading_point(*hit, -direction).opacity;
        if (part <= 0.0F) return 0.0F;
        distance -= hit->distance;
        origin = scene.ray_origin(*hit, direction);
    }
    return 0.0F;
}

struct IncidentLight {
    glm::vec3 direction{0.0F};
    glm::vec3 radiance{0.0F};  // of a point or spot light: intensity over the square of the distance
};

// Returns the light that arrives at a point from a light of KHR_lights_punctual, and its distance (m).
IncidentLight light_at(const PunctualLight& source, const glm::vec3& point, float& distance) {
    const assets::Light& light = source.light;
    IncidentLight sample;
    sample.radiance = light.color * light.intensity;
    if (light.type == assets::LightType::directional) {
        distance = FLT_MAX;
        sample.direction = -source.direction;
        return sample;
    }
    const glm::vec3 away = source.position - point;
    distance = std::max(glm::length(away), 1e-4F);
    sample.direction = away / distance;
    sample.radiance /= distance * distance;
    if (light.range > 0.0F) {
        const float ratio = distance / light.range;
        sample.radiance *= std::clamp(1.0F - ratio * ratio * ratio * ratio, 0.0F, 1.0F);
    }
    if (light.type == assets::LightType::spot) {
        const float inner = std::cos(light.inner_cone);
        const float outer = std::cos(light.outer_cone);
        const float within =
            (glm::dot(source.direction, -sample.direction) - outer) / std::max(0.001F, inner - outer);
        const float attenuation = std::clamp(within, 0.0F, 1.0F);
        sample.radiance *= attenuation * attenuation;
    }
    return sample;
}

glm::vec3 Tracer::direct_light(const SurfaceHit& hit, const Bsdf& bsdf, const glm::vec3& out,
                               SobolSampler& sampler) const {
    glm::vec3 sum(0.0F);
    const glm::vec2 u = sampler.pair();
    if (!environment.dark()) {
        const DirectionSample light = environment.sample(u);
        const BsdfValue scattered = bsdf.evaluate(light.direction);
        if (largest(scattered.value) > 0.0F && light.density > 0.0F) {
            const float part =
                transmittance(scene.ray_origin(hit, light.direction), light.direction, FLT_MAX);
            const float weight = power_heuristic(light.density, scattered.density) * part / light.density;
            if (part > 0.0F) sum += scattered.value * environment.radiance(light.direction) * weight;
        }
    }
    for (const PunctualLight& source : scene.lights()) {
        const glm::vec3 point = scene.ray_origin(hit, out);
        float distance = 0.0F;
        const IncidentLight light = light_at(source, point, distance);
        const glm::vec3 scattered = bsdf.evaluate(light.direction).value * light.radiance;
        if (largest(scattered) > 0.0F)
            sum +=
                scattered * transmittance(scene.ray_origin(hit, light.direction), light.direction, distance);
    }
    return sum;
}

glm::vec3 Tracer::environment_light(const glm::vec3& direction, int bounce, float bsdf_density) const {
    if (bounce == 0) return settings.background.value_or(environment.radiance(direction));
    if (environment.dark()) return glm::vec3(0.0F);
    return environment.radiance(direction) * power_heuristic(bsdf_density, environment.density(direction));
}

glm::vec3 Tracer::trace_path(glm::vec3 origin, glm::vec3 direction, SobolSampler sampler) const {
    glm::vec3 sum(0.0F);
    glm::vec3 throughput(1.0F);
    float last_density = 0.0F;
    int passed = 0;
    const auto add = [&](const glm::vec3& light, int bounce) {
        const glm::vec3 value = throughput * light;
        const float peak = largest(value);
        const bool cut = settings.clamp > 0.0F && bounce > 0 && peak > settings.clamp;
        sum += cut ? value * (settings.clamp / peak) : value;
    };
    for (int bounce = 0; bounce <= settings.bounces;) {
        const auto hit = scene.cast(origin, direction);
        if (!hit) {
            add(environment_light(direction, bounce, last_density), bounce);
            break;
        }
        const ShadingPoint surface = scene.shading_point(*hit, -direction);
        if (surface.opacity < 1.0F && sampler.single() >= surface.opacity) {
            origin = scene.ray_origin(*hit, direction);
            if (++passed > max_transparent_hits) break;
            continue;
        }
        add(surface.emission, bounce);
        const Bsdf bsdf(surface, -direction);
        add(direct_light(*hit, bsdf, -direction, sampler), bounce);
        const float pick = sampler.single();
        const BsdfSample next = bsdf.sample(pick, sampler.pair());
        // Discard directions below the triangle even if they are above the smooth normal's plane.
        const float side = glm::dot(scene.normal(*hit), -direction) < 0.0F ? -1.0F : 1.0F;
        if (next.density <= 0.0F || side * glm::dot(scene.normal(*hit), next.in) <= 0.0F) break;
        throughput *= next.weight;
        last_density = next.density;
        if (++bounce > min_bounces) {
            const float survival = std::min(0.95F, largest(throughput));
            if (sampler.single() >= survival) break;
            throughput /= survival;
        }
        origin = scene.ray_origin(*hit, next.in);
        direction = next.in;
    }
    return sum;
}

}  // namespace

std::vector<glm::vec3> render(const TracedScene& scene, const Environment& environment,
                              const PinholeCamera& camera, const PathTraceSettings& settings) {
    const Tracer tracer{scene, environment, settings};
    std::vector<glm::vec3> image(static_cast<std::size_t>(camera.width) *
                                 static_cast<std::size_t>(camera.height));
    const auto trace_row = [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < camera.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                                      static_cast<std::size_t>(x);
            glm::dvec3 sum(0.0);
            for (int i = 0; i < settings.samples; ++i) {
                SobolSampler sampler(static_cast<std::uint32_t>(pixel), settings.seed,
                                     static_cast<std::uint32_t>(i));
                const glm::vec2 position = glm::vec2(x, y) + sampler.pair();
                sum += glm::dvec3(tracer.trace_path(camera.eye, ray_direction(camera, position), sampler));
            }
            image[pixel] = glm::vec3(sum / static_cast<double>(settings.samples));
        }
    };
    for_each_in_parallel(static_cast<std::size_t>(camera.height), trace_row, settings.threads);
    return image;
}

std::vector<float> depth(const TracedScene& scene, const PinholeCamera& camera) {
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    std::vector<float> image;
    image.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
    for (int y = 0; y < camera.height; ++y) {
        for (int x = 0; x < camera.width; ++x) {
            const glm::vec3 ray = ray_direction(camera, glm::vec2(x, y) + 0.5F);
            const auto hit = scene.cast(camera.eye, ray);
            image.push_back(hit ? hit->distance * glm::dot(ray, forward) : 0.0F);
        }
    }
    return image;
}

}  // namespace bolt::pathtrace
