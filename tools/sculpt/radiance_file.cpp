#include "tools/sculpt/radiance_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace bolt::sculpt {
namespace {

std::array<std::uint8_t, 4> shared_exponent(const glm::vec3& colour) {
    const float top = std::max({colour.x, colour.y, colour.z});
    if (!(top > 1e-32F)) return {};
    int exponent = 0;
    (void)std::frexp(top, &exponent);
    std::array<std::uint8_t, 4> out{};
    for (int i = 0; i < 3; ++i) {
        const float scaled = std::ldexp(std::max(colour[i], 0.0F), 8 - exponent);
        out[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::min(scaled, 255.0F));
    }
    out[3] = static_cast<std::uint8_t>(exponent + 128);
    return out;
}

// Runs of four and more are counted; what lies between is copied.
void pack(const std::vector<std::uint8_t>& row, std::string& out) {
    std::size_t i = 0;
    while (i < row.size()) {
        std::size_t start = i;  // of the next run
        std::size_t run = 0;
        while (start < row.size()) {
            run = 1;
            while (start + run < row.size() && run < 127 && row[start + run] == row[start]) ++run;
            if (run >= 4) break;
            start += run;
        }
        while (i < start) {
            const std::size_t count = std::min<std::size_t>(128, start - i);
            out.push_back(static_cast<char>(count));
            out.append(reinterpret_cast<const char*>(&row[i]), count);
            i += count;
        }
        if (i < row.size()) {
            out.push_back(static_cast<char>(128 + run));
            out.push_back(static_cast<char>(row[i]));
            i += run;
        }
    }
}

tl::unexpected<Error> broken(const std::string& what) {
    return fail(ErrorCode::bad_content, "Radiance picture: " + what, "32-bit_rle_rgbe with -Y and +X");
}

}  // namespace

std::string encode_radiance(const Panorama& picture) {
    std::string out =
        fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", picture.height, picture.width);
    const auto width = static_cast<std::size_t>(picture.width);
    std::vector<std::uint8_t> plane(width);
    for (std::size_t row = 0; row < static_cast<std::size_t>(picture.height); ++row) {
        out.push_back(2);
        out.push_back(2);
        out.push_back(static_cast<char>(width >> 8U));
        out.push_back(static_cast<char>(width & 0xFFU));
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (std::size_t x = 0; x < width; ++x) {
                plane[x] = shared_exponent(picture.pixels[row * width + x])[channel];
            }
            pack(plane, out);
        }
    }
    return out;
}

Result<Panorama> decode_radiance(const std::string& bytes) {
    const std::size_t head = bytes.find("\n\n");
    if (bytes.rfind("#?", 0) != 0 || head == std::string::npos) return broken("no header");
    const std::size_t line_end = bytes.find('\n', head + 2);
    if (line_end == std::string::npos) return broken("no size");
    Panorama out;
    const std::string size = bytes.substr(head + 2, line_end - head - 2);
    if (std::sscanf(size.c_str(), "-Y %d +X %d", &out.height, &out.width) != 2) return broken("no size");
    if (out.width < 8 || out.width > 32767 || out.height < 1 || out.height > 32767) return broken("its size");
    const auto width = static_cast<std::size_t>(out.width);
    std::size_t at = line_end + 1;
    std::vector<std::uint8_t> row(4 * width);
    for (int y = 0; y < out.height; ++y) {
        if (at + 4 > bytes.size() || bytes[at] != 2 || bytes[at + 1] != 2)
            return broken("a row without run lengths");
        at += 4;
        for (std::size_t filled = 0; filled < row.size();) {
            if (at + 2 > bytes.size()) return broken("it ends early");
            const auto count = static_cast<std::uint8_t>(bytes[at++]);
            const std::size_t length = count > 128 ? count - 128U : count;
            const bool run = count > 128;
            if (length == 0 || filled % width + length > width) return broken("a run beyond its row");
            if (!run && at + length > bytes.size()) return broken("it ends early");
            for (std::size_t i = 0; i < length; ++i) {
                row[filled + i] = static_cast<std::uint8_t>(bytes[run ? at : at + i]);
            }
            at += run ? 1 : length;
            filled += length;
        }
        for (std::size_t x = 0; x < width; ++x) {
            const int exponent = static_cast<int>(row[3 * width + x]) - 136;
            const auto value = [&](std::size_t channel) {
                const auto mantissa = static_cast<float>(row[channel * width + x]) + 0.5F;
                return exponent == -136 ? 0.0F : std::ldexp(mantissa, exponent);
            };
            out.pixels.emplace_back(value(0), value(1), value(2));
        }
    }
    return out;
}

}  // namespace bolt::sculpt
