# How every target of the house is built: one place for warnings, sanitizers and reproducible floating point.

find_program(BOLT_CCACHE ccache)
if(BOLT_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${BOLT_CCACHE})
endif()

add_library(house_options INTERFACE)
target_compile_options(house_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
    -Woverloaded-virtual -Wcast-align -Wnull-dereference -Wdouble-promotion -Wformat=2 -Werror
    # Same inputs, same bits: no contraction to FMA, so debug, release and both compilers agree.
    -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc 12 sees null dereferences and overreads in inlined libstdc++ code that are not there.
    target_compile_options(house_options INTERFACE -Wno-null-dereference -Wno-restrict)
endif()
target_include_directories(house_options INTERFACE ${CMAKE_SOURCE_DIR})
if(BOLT_SANITIZE)
    target_compile_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE} -fno-sanitize-recover=all
        -fno-omit-frame-pointer)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # Instrumented code hides from gcc what is initialised where (libstdc++'s regex, std::function).
        target_compile_options(house_options INTERFACE -Wno-maybe-uninitialized)
    endif()
    string(REPLACE "fuzzer-no-link," "" BOLT_SANITIZE_LINK "${BOLT_SANITIZE}")
    target_link_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE_LINK})
endif()

# house_library(NAME SOURCES a.cpp ... [LINK public...] [PRIVATE private...])
function(house_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE" ${ARGN})
    if(ARG_SOURCES)
        add_library(${name} STATIC ${ARG_SOURCES})
        target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE house_options ${ARG_PRIVATE})
        target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
    else()
        add_library(${name} INTERFACE)
        target_link_libraries(${name} INTERFACE ${ARG_LINK})
        target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
    endif()
endfunction()

# house_program(NAME SOURCES a.cpp ... LINK targets...)
function(house_program name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE house_options ${ARG_LINK})
endfunction()
