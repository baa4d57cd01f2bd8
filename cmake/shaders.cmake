# Also used for shaders that are compiled at run time (engine/render/hot_shaders.hpp).
set(BOLT_GLSL_FLAGS -V --quiet --target-env vulkan1.3)

# house_shaders(TARGET files.vert files.frag ...): compiles GLSL with glslang into a library with one function, which returns
# the SPIR-V by file name: std::span<const std::uint32_t> TARGET(std::string_view). Included files are dependencies.
function(house_shaders target)
    set(includes "")
    set(rows "")
    set(generated "")
    foreach(source ${ARGN})
        get_filename_component(file ${source} NAME)
        string(MAKE_C_IDENTIFIER ${file} symbol)
        set(output ${CMAKE_CURRENT_BINARY_DIR}/${target}/${file}.inc)
        add_custom_command(
            OUTPUT ${output}
            COMMAND ${GLSLANG} ${BOLT_GLSL_FLAGS} -I${CMAKE_SOURCE_DIR} --vn ${symbol}
                    --depfile ${output}.d -o ${output} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
            DEPENDS ${source}
            DEPFILE ${output}.d
            COMMENT "GLSL ${file}"
            VERBATIM)
        list(APPEND generated ${output})
        string(APPEND includes "#include \"${output}\"\n")
        string(APPEND rows "    if (name == \"${file}\") return ${symbol};\n")
    endforeach()
    set(table ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
    file(CONFIGURE OUTPUT ${table} @ONLY CONTENT
"// Made by cmake/shaders.cmake.
#include <cstdint>
#include <span>
#include <string_view>

namespace {
@includes@}

std::span<const std::uint32_t> ${target}(std::string_view name) {
@rows@    return {};
}
")
    add_library(${target} STATIC ${table} ${generated})
    set_source_files_properties(${table} PROPERTIES OBJECT_DEPENDS "${generated}")
endfunction()
