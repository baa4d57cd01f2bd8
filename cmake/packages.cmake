# Every outside library, found once for the whole house. Where each comes from: packages.txt.
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(tl-expected REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(zstd REQUIRED)

# ./run needs neither; ./test installs both and fails if there is no test to run.
find_package(doctest QUIET)
find_package(benchmark QUIET)

# The engine. volk loads Vulkan at run time; its header comes with Debian's libvulkan-volk-dev.
find_program(GLSLANG glslangValidator REQUIRED)
foreach(part core util glsl hlsl msl cpp reflect c)
    find_package(spirv_cross_${part} REQUIRED)
endforeach()
