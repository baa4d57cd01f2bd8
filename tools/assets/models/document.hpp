// A CAD document that is written as STEP: named, coloured parts, placed any number of times in a tree of
// named groups. Millimetres, Z up. Equal documents give equal bytes.
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <gp_Trsf.hxx>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace bolt::models {

// The appearance of a surface. Its sRGB colour selects the material in content/materials.json.
struct Finish {
    std::uint32_t srgb = 0;
};

namespace finish {
inline constexpr Finish painted_cast_iron{0x2F5D62};
inline constexpr Finish machined_cast_iron{0xA8A9A6};
inline constexpr Finish machined_steel{0xC4C6C8};
inline constexpr Finish gear_steel{0x8F9499};
inline constexpr Finish bearing_steel{0xB4B8BC};
inline constexpr Finish zinc_plated{0xD5D9DC};
inline constexpr Finish black_oxide{0x2B2B2D};
inline constexpr Finish stainless_steel{0xCFCFCB};
inline constexpr Finish brass{0xC8A24A};
inline constexpr Finish rubber{0x1A1A1A};
inline constexpr Finish gasket{0x4A3B2A};
inline constexpr Finish oil_film{0xB8860B};
inline constexpr Finish sight_glass{0xDDEEFF};
inline constexpr Finish chrome_vanadium{0xB9BCC2};
inline constexpr Finish signal_red{0xB01E28};
inline constexpr Finish galvanised_sheet{0xBFC4C6};
}  // namespace finish

struct FaceFinish {
    TopoDS_Face face;  // a face of the part's shape
    Finish finish;
};

// A shape in the document, which add_instance places. Valid as long as its document.
struct CadPart {
    int id = -1;
};

// A node of the tree. It holds instances and further groups.
struct CadGroup {
    int id = -1;
};

class CadDocument {
  public:
    explicit CadDocument(std::string_view name);  // `name` becomes the name of the root group
    ~CadDocument();
    CadDocument(CadDocument&&) noexcept;
    CadDocument& operator=(CadDocument&&) noexcept;

    [[nodiscard]] CadGroup root() const { return {0}; }

    // `faces` lists the faces whose finish differs from that of the rest of the part.
    CadPart add_part(std::string_view name, const TopoDS_Shape& shape, Finish finish,
                     std::span<const FaceFinish> faces = {});
    // Names of groups and instances must be unique in the document: they become the node names of the glTF
    // file.
    CadGroup add_group(CadGroup parent, std::string_view name, const gp_Trsf& placement = {});
    void add_instance(CadGroup parent, std::string_view name, CadPart part, const gp_Trsf& placement = {});

    // Writes STEP AP214 with a fixed header. Fails if a name is used twice or the file cannot be written.
    Status write_step(const std::string& path);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace bolt::models
