# Finds all external libraries. packages.txt lists their sources.
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(tl-expected REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost 1.74 CONFIG REQUIRED)  # Beast and Asio, which are headers only
# Each io_context has one thread and needs no fences, which ThreadSanitizer does not know.
set_property(TARGET Boost::headers APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS BOOST_ASIO_DISABLE_FENCED_BLOCK)
find_package(CLI11 REQUIRED)
find_package(pugixml REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(zstd REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
    find_package(embree 3 REQUIRED)
endif()
set_property(TARGET embree APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS BOLT_EMBREE=${embree_VERSION_MAJOR})
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(hidapi REQUIRED IMPORTED_TARGET hidapi-hidraw)
pkg_check_modules(openal REQUIRED IMPORTED_TARGET openal)

# Programs for authors that read and create STEP files; everything else builds without it. The sanitizer presets disable it to
# shorten ./test; -DBOLT_OPENCASCADE=ON enables it.
option(BOLT_OPENCASCADE "Build import-step and the programs that make models" ON)
if(BOLT_OPENCASCADE)
    find_package(OpenCASCADE QUIET)
    # The libraries that read and write STEP: version 7.8 (Debian 13) has other ones than 7.6 (Debian 12).
    set(BOLT_STEP TKXDESTEP TKSTEP TKSTEPBase TKSTEPAttr TKXSBase)
    if(OpenCASCADE_VERSION VERSION_GREATER_EQUAL 7.8)
        set(BOLT_STEP TKDESTEP TKDE TKXSBase)
    endif()
endif()

# ./run needs neither; ./test installs both and fails if no test is found.
find_package(doctest QUIET)
find_package(benchmark QUIET)

# Projection walls on several computers; everything else works without it. Packages are built without it, because few users need it.
option(BOLT_WITH_MPI "Walls of several processes, if there is an MPI library" ON)
if(BOLT_WITH_MPI)
    enable_language(C)  # FindMPI uses the C compiler
    find_package(MPI COMPONENTS C QUIET)
endif()

find_package(glfw3 REQUIRED)
find_package(OpenXR REQUIRED)

# The engine. volk loads Vulkan at run time; its header is in Debian's libvulkan-volk-dev.
find_program(GLSLANG glslangValidator REQUIRED)
foreach(part core util glsl hlsl msl cpp reflect c)
    find_package(spirv_cross_${part} REQUIRED)
endforeach()
