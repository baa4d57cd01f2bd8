#include "engine/assets/radiance_file.hpp"

#include <cmath>
#include <memory>

#include "engine/assets/stb.hpp"
#include "engine/base/file.hpp"

namespace bolt::assets {

namespace {

struct Free {
    void operator()(float* pixels) const { stbi_image_free(pixels); }
};

tl::unexpected<Error> hdr_error(const std::filesystem::path& path, const char* what) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = path.string();
    error.what = what;
    return fail(std::move(error));
}

void append(void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
}

}  // namespace

Result<RadianceImage> read_hdr(const std::filesystem::path& path) {
    const auto file = read_file(path, std::size_t{1} << 28U, ErrorCode::bad_content);
    if (!file) return fail(file.error());
    const auto* bytes = reinterpret_cast<const stbi_uc*>(file->data());
    const int size = static_cast<int>(file->size());
    RadianceImage image;
    int channels = 0;
    if (stbi_is_hdr_from_memory(bytes, size) == 0) return hdr_error(path, "is no Radiance .hdr file");
    const std::unique_ptr<float, Free> pixels(
        stbi_loadf_from_memory(bytes, size, &image.width, &image.height, &channels, 3));
    if (!pixels) return hdr_error(path, "cannot be decoded");
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (std::size_t i = 0; i < count; ++i) {
        const float* p = pixels.get() + 3 * i;
        if (!std::isfinite(p[0] + p[1] + p[2])) return hdr_error(path, "has a pixel that is not finite");
        image.pixels.emplace_back(p[0], p[1], p[2]);
    }
    return image;
}

Status write_hdr(const std::filesystem::path& path, const RadianceImage& image) {
    std::string bytes;
    if (stbi_write_hdr_to_func(append, &bytes, image.width, image.height, 3,
                               reinterpret_cast<const float*>(image.pixels.data())) == 0)
        return hdr_error(path, "cannot be encoded");
    return write_file(path, bytes);
}

}  // namespace bolt::assets
