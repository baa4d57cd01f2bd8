#include "tests/golden/reference_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "tools/verify/imagediff/flip.hpp"

namespace bolt::test {

namespace {

namespace fs = std::filesystem;

imagediff::RgbImage without_alpha(const render::Picture& picture) {
    imagediff::RgbImage rgb{static_cast<int>(picture.width), static_cast<int>(picture.height), {}};
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        rgb.rgb.insert(rgb.rgb.end(), &picture.rgba[i], &picture.rgba[i] + 3);
    return rgb;
}

Status write_png(const fs::path& path, const imagediff::RgbImage& picture) {
    const Result<std::string> png = assets::encode_png(picture.width, picture.height, 3, picture.rgb);
    if (!png) return fail(png.error());
    std::error_code ignored;  // write_file reports the reason
    fs::create_directories(path.parent_path(), ignored);
    return write_file(path, *png);
}

imagediff::RgbImage stretched_difference(const imagediff::RgbImage& a, const imagediff::RgbImage& b) {
    imagediff::RgbImage difference{a.width, a.height, {}};
    int largest = 1;
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        largest = std::max(largest, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
    for (std::size_t i = 0; i < a.rgb.size(); ++i)
        difference.rgb.push_back(
            static_cast<std::uint8_t>(std::abs(int{a.rgb[i]} - int{b.rgb[i]}) * 255 / largest));
    return difference;
}

// Returns the fraction of pixels with a channel that differs by more than `channel`.
double share_off(const imagediff::RgbImage& a, const imagediff::RgbImage& b, int channel) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
        int largest = 0;
        for (std::size_t c = i; c < i + 3; ++c)
            largest = std::max(largest, std::abs(int{a.rgb[c]} - int{b.rgb[c]}));
        off += largest > channel ? 1U : 0U;
    }
    return static_cast<double>(off) / static_cast<double>(std::max<std::size_t>(a.rgb.size() / 3, 1));
}

std::string first_line(const fs::path& path) {
    const Result<std::string> text = read_file(path, 4096, ErrorCode::failed);
    return text ? text->substr(0, text->find('\n')) : "";
}

PictureComparison renew(const ReferencePictures& pictures, const std::string& name,
                        const imagediff::RgbImage& picture) {
    Status kept = write_png(pictures.references / (name + ".png"), picture);
    if (kept) kept = write_file(pictures.references / "driver.txt", pictures.driver + "\n");
    return {kept.has_value(), kept ? "" : kept.error().message()};
}

PictureComparison failed(const ReferencePictures& pictures, const std::string& name, const std::string& why,
                         const imagediff::RgbImage& picture, const imagediff::RgbImage* reference) {
    Status kept = write_png(pictures.failures / (name + ".actual.png"), picture);
    if (kept && reference != nullptr)
        kept = write_png(pictures.failures / (name + ".difference.png"),
                         stretched_difference(*reference, picture));
    return {false, fmt::format("{}: {}; {}", name, why,
                               kept ? "see " + (pictures.failures / (name + ".*.png")).string()
                                    : kept.error().message())};
}

}  // namespace

namespace {

// Returns the vendor, family and model of the first processor. Software drivers approximate reciprocals and
// roots, and each processor family has its own approximations.
std::string processor() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    const std::array<std::string, 3> wanted{"vendor_id", "cpu family", "model"};
    std::string named;
    for (std::string line; std::getline(cpuinfo, line) && !line.empty();) {
        const std::string key = line.substr(0, line.find_last_not_of("\t ", line.find(':') - 1) + 1);
        if (std::find(wanted.begin(), wanted.end(), key) != wanted.end())
            named += line.substr(line.find(':') + 1);
    }
    return named;
}

}  // namespace

std::string driver_of(const gpu::Device& device) {
    return device.name() + ", " + device.driver() + "," + processor();
}

fs::path references_for(const fs::path& pictures, const std::string& driver, bool update) {
    std::string folder;
    for (const char c : driver) {
        const bool kept =
            (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.';
        if (kept)
            folder += c;
        else if (!folder.empty() && folder.back() != '-')
            folder += '-';
    }
    if (!folder.empty() && folder.back() == '-') folder.pop_back();
    if (update || fs::exists(pictures / folder)) return pictures / folder;
    std::vector<fs::path> others;
    std::error_code ignored;  // no folder: the checker reports the missing reference
    for (const fs::directory_entry& entry : fs::directory_iterator(pictures, ignored))
        if (entry.is_directory()) others.push_back(entry.path());
    return others.empty() ? pictures / folder : *std::min_element(others.begin(), others.end());
}

ReferencePictures reference_pictures(const gpu::Device& device) {
    const bool update = std::getenv("BOLT_GOLDEN_UPDATE") != nullptr;
    ReferencePictures here{references_for(fs::path(BOLT_GOLDEN) / "pictures", device.driver(), update),
                           BOLT_GOLDEN_FAILURES, driver_of(device), "", update};
    here.pinned_driver = first_line(here.references / "driver.txt");
    if (const char* failures = std::getenv("BOLT_GOLDEN_FAILURES")) here.failures = failures;
    return here;
}

PictureComparison compare_with_reference(const ReferencePictures& pictures, const std::string& name,
                                         const render::Picture& picture, const Tolerance& tolerance) {
    const imagediff::RgbImage actual = without_alpha(picture);
    if (pictures.update) return renew(pictures, name, actual);
    const fs::path file = pictures.references / (name + ".png");
    const Result<imagediff::RgbImage> reference = imagediff::read_png(file);
    if (!reference)
        return failed(pictures, name, "no reference: " + reference.error().message(), actual, nullptr);
    const Result<imagediff::Difference> difference = imagediff::compare(*reference, actual);
    if (!difference) return failed(pictures, name, difference.error().message(), actual, nullptr);
    const double off = share_off(*reference, actual, tolerance.channel);
    const bool exact = pictures.driver == pictures.pinned_driver;
    const bool passes = exact ? difference->largest == 0
                              : difference->mean_flip <= tolerance.mean_flip && off <= tolerance.share;
    const std::string numbers = fmt::format(
        "mean FLIP {:.4f}, largest difference {} of 255, {:.3f} % of the pixels differ, {:.3f} % by more "
        "than {}",
        difference->mean_flip, difference->largest, 100.0 * difference->changed, 100.0 * off,
        tolerance.channel);
    if (passes) return {true, numbers};
    const std::string wanted =
        exact ? "every pixel as it is, for " + pictures.driver + " drew it"
              : fmt::format("mean FLIP {} and {} % at most, for {} is not {}", tolerance.mean_flip,
                            100.0 * tolerance.share, pictures.driver, pictures.pinned_driver);
    return failed(pictures, name, numbers + ", expected " + wanted, actual, &*reference);
}

render::Picture joined(const std::vector<render::Picture>& pictures) {
    render::Picture all{0, pictures.front().height, {}};
    for (const render::Picture& picture : pictures) all.width += picture.width;
    for (std::uint32_t y = 0; y < all.height; ++y)
        for (const render::Picture& picture : pictures) {
            const std::uint8_t* row = picture.rgba.data() + std::size_t{4} * picture.width * y;
            all.rgba.insert(all.rgba.end(), row, row + std::size_t{4} * picture.width);
        }
    return all;
}

}  // namespace bolt::test
